#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "edit/server/http_server.h"
#include "edit/session/edit_session.h"
#include "edit/session/session_measures.h"

namespace uw {

/// @name Parameters of an address, "?min=3"
/// Each is `otherwise` where there is none, and throws UsageError where it is of another kind.
/// @{
std::int64_t integer_parameter(const HttpRequest& request, const std::string& name,
                               std::int64_t otherwise);
double number_parameter(const HttpRequest& request, const std::string& name, double otherwise);
/// x0, y0, x1, y1, ratio and curves.
NumbersRequest numbers_request(const HttpRequest& request);
/// @}

/// Serves the page of the lamp editor, and the session behind it as docs/edit-api.md says, on
/// 127.0.0.1. Whoever does not know the address's token, and any page of another origin, is
/// refused.
class EditServer {
  public:
    /// Listens from now on; `session` outlives it. Throws IoError if the port is taken.
    EditServer(EditSession& session, int port, HttpLimits limits = {});
    ~EditServer();
    EditServer(const EditServer&) = delete;
    EditServer& operator=(const EditServer&) = delete;
    EditServer(EditServer&&) = delete;
    EditServer& operator=(EditServer&&) = delete;

    int port() const { return listener_.port(); }
    /// 128 random bits as 32 hex digits.
    const std::string& token() const { return token_; }
    /// "http://127.0.0.1:41873/0123.../"
    std::string address() const;

  private:
    HttpResponse answer(const HttpRequest& request);
    HttpResponse answer_within(const HttpRequest& request, const std::string& path);
    bool is_from_here(const HttpRequest& request) const;
    HttpResponse events();
    HttpResponse image(const HttpRequest& request) const;
    HttpResponse numbers_csv(const HttpRequest& request);
    HttpResponse picture_png(const HttpRequest& request);

    EditSession& session_;
    SessionMeasures measures_;
    std::string token_;
    std::atomic<std::size_t> windows_ = 0;  // that follow the events
    HttpListener listener_;
    HttpProtocol protocol_;
};

}  // namespace uw
