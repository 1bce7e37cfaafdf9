#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace uw::test {

/// A connection to a server on 127.0.0.1 that sends whatever bytes it is given.
class HttpProbe {
  public:
    explicit HttpProbe(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            close(socket_);
            throw std::runtime_error("no connection");
        }
    }
    ~HttpProbe() {
        if (socket_ >= 0) close(socket_);
    }
    HttpProbe(const HttpProbe&) = delete;
    HttpProbe& operator=(const HttpProbe&) = delete;
    HttpProbe(HttpProbe&& other) noexcept : socket_(other.socket_) { other.socket_ = -1; }
    HttpProbe& operator=(HttpProbe&&) = delete;

    /// Whether all was taken.
    bool send(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }

    /// What comes until it contains `end`, unless that is empty, or the server closes the
    /// connection, for at most `seconds`.
    std::string receive(double seconds, std::string_view end = {}) {
        std::string all;
        const auto last = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        while (end.empty() || all.find(end) == std::string::npos) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(
                last - std::chrono::steady_clock::now());
            pollfd polled{socket_, POLLIN, 0};
            if (left.count() <= 0 || poll(&polled, 1, static_cast<int>(left.count())) <= 0)
                return all;
            char buffer[4096];
            const ssize_t count = recv(socket_, buffer, sizeof buffer, 0);
            if (count <= 0) {
                is_closed_ = true;
                return all;
            }
            all.append(buffer, static_cast<std::size_t>(count));
        }
        return all;
    }
    /// Whether the last receive() ended because the server closed the connection.
    bool is_closed() const { return is_closed_; }

  private:
    int socket_;
    bool is_closed_ = false;
};

/// The status of an answer; 0 if it is none.
inline int status_of(std::string_view answer) {
    if (!answer.starts_with("HTTP/1.1 ") || answer.size() < 12) return 0;
    return std::stoi(std::string(answer.substr(9, 3)));
}

}  // namespace uw::test
