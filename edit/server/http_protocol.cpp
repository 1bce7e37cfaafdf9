#include "edit/server/http_protocol.h"

#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace uw {

namespace {

// A client that takes none of an answer for so long is given up [ms].
constexpr int k_longest_stall = 10000;
constexpr int k_stop_check = 200;

/// A request in memory, and a socket for the answer. What cpp-httplib demands of a stream differs
/// between its versions: these are all of them.
class AnswerStream final : public httplib::Stream {
  public:
    AnswerStream(int socket, std::string request, const std::atomic<bool>& is_stopping)
        : socket_(socket), request_(std::move(request)), is_stopping_(is_stopping) {}

    bool is_readable() const override { return at_ < request_.size(); }
    bool is_writable() const override { return !failed_; }
    ssize_t read(char* to, std::size_t size) override {
        const std::size_t count = std::min(size, request_.size() - at_);
        std::memcpy(to, request_.data() + at_, count);
        at_ += count;
        return static_cast<ssize_t>(count);
    }
    using httplib::Stream::write;
    ssize_t write(const char* from, std::size_t size) override {
        std::size_t sent = 0;
        while (sent < size && !failed_) {
            const ssize_t count =
                send(socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (count > 0)
                sent += static_cast<std::size_t>(count);
            else if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
                failed_ = !wait_for_room();
            else if (count < 0 && errno != EINTR)
                failed_ = true;
        }
        return failed_ ? -1 : static_cast<ssize_t>(sent);
    }
    void get_remote_ip_and_port(std::string& ip, int& port) const override {
        ip = "127.0.0.1";
        port = 0;
    }
    void get_local_ip_and_port(std::string& ip, int& port) const override {
        get_remote_ip_and_port(ip, port);
    }
    socket_t socket() const override { return socket_; }

  private:
    bool wait_for_room() const {
        for (int waited = 0; waited < k_longest_stall && !is_stopping_; waited += k_stop_check) {
            pollfd room{socket_, POLLOUT, 0};
            const int ready = poll(&room, 1, k_stop_check);
            if (ready > 0) return (room.revents & POLLOUT) != 0;
            if (ready < 0 && errno != EINTR) return false;
        }
        return false;
    }

    int socket_;
    std::string request_;
    std::size_t at_ = 0;
    bool failed_ = false;
    const std::atomic<bool>& is_stopping_;
};

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

HttpRequest request_from(const httplib::Request& from) {
    HttpRequest request;
    request.method = from.method;
    request.path = from.path;
    request.body = from.body;
    for (const auto& [name, value] : from.headers) request.headers[lower_case(name)] = value;
    for (const auto& [name, value] : from.params) request.query.emplace(name, value);
    return request;
}

void fill(httplib::Response& to, HttpResponse&& from) {
    to.status = from.status;
    if (!from.file_name.empty())
        to.set_header("Content-Disposition", "attachment; filename=\"" + from.file_name + "\"");
    if (!from.stream) {
        to.set_content(std::move(from.body), from.type.c_str());
        return;
    }
    to.set_chunked_content_provider(
        from.type.c_str(), [stream = std::move(from.stream)](std::size_t, httplib::DataSink& sink) {
            stream([&](std::string_view part) {
                sink.write(part.data(), part.size());
                return sink.is_writable();
            });
            return false;
        });
}

}  // namespace

class HttpProtocol::Server : public httplib::Server {
  public:
    Server(HttpHandler handler, const std::atomic<bool>& is_stopping)
        : handler_(std::move(handler)), is_stopping_(is_stopping) {
        // Its own loop never runs; with a socket that is none, it would give up every answer.
        svr_sock_ = 0;
        set_default_headers({
            {"Content-Security-Policy",
             "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; "
             "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
            {"X-Content-Type-Options", "nosniff"},
            {"X-Frame-Options", "DENY"},
            {"Referrer-Policy", "no-referrer"},
            {"Cross-Origin-Resource-Policy", "same-origin"},
            {"Cross-Origin-Opener-Policy", "same-origin"},
            {"Cache-Control", "no-store"},
        });
        const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
            fill(response, handler_(request_from(request)));
        };
        // Any other method has no route, and its body is not read.
        Get(".*", answer);
        Post(".*", answer);
        set_pre_routing_handler(
            [this](const httplib::Request& request, httplib::Response& response) {
                if (request.method == "GET" || request.method == "POST")
                    return HandlerResponse::Unhandled;
                HttpRequest head = request_from(request);
                fill(response, handler_(head));
                return HandlerResponse::Handled;
            });
    }
    ~Server() override { svr_sock_ = INVALID_SOCKET; }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    Server(Server&&) = delete;
    Server& operator=(Server&&) = delete;

    bool answer(int socket, std::string request) {
        AnswerStream stream(socket, std::move(request), is_stopping_);
        // Parts of answers, and answers compressed for the way to this machine, serve nobody here.
        const std::function<void(httplib::Request&)> simplify = [](httplib::Request& r) {
            r.ranges.clear();
            for (const char* name : {"Range", "Accept-Encoding"}) r.headers.erase(name);
        };
        bool is_closed = false;
        const bool done = process(*this, stream, is_closed, simplify);
        return done && !is_closed && stream.is_writable();
    }

  private:
    // Its arguments differ between versions.
    template <class Self>
    static bool process(Self& self, httplib::Stream& stream, bool& is_closed,
                        const std::function<void(httplib::Request&)>& simplify) {
        const std::string here = "127.0.0.1";
        if constexpr (requires { self.process_request(stream, false, is_closed, simplify); })
            return self.process_request(stream, false, is_closed, simplify);
        else
            return self.process_request(stream, here, 0, here, 0, false, is_closed, simplify);
    }

    HttpHandler handler_;
    const std::atomic<bool>& is_stopping_;
};

HttpProtocol::HttpProtocol(HttpHandler handler, const std::atomic<bool>& is_stopping)
    : server_(std::make_unique<Server>(std::move(handler), is_stopping)) {}

HttpProtocol::~HttpProtocol() = default;

bool HttpProtocol::answer(int socket, std::string request) {
    return server_->answer(socket, std::move(request));
}

}  // namespace uw
