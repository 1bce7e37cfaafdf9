#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "edit/server/http_message.h"

namespace uw {

/// HTTP/1.1 as cpp-httplib speaks it, over sockets that are accepted and read elsewhere. Thread
/// safe.
class HttpProtocol {
  public:
    /// `is_stopping` ends streams and answers.
    HttpProtocol(HttpHandler handler, const std::atomic<bool>& is_stopping);
    ~HttpProtocol();
    HttpProtocol(const HttpProtocol&) = delete;
    HttpProtocol& operator=(const HttpProtocol&) = delete;
    HttpProtocol(HttpProtocol&&) = delete;
    HttpProtocol& operator=(HttpProtocol&&) = delete;

    /// Answers `request`, the bytes of one whole request, on the socket, a non-blocking one.
    /// Whether the connection is to be kept for another.
    bool answer(int socket, std::string request);

  private:
    class Server;
    std::unique_ptr<Server> server_;
};

}  // namespace uw
