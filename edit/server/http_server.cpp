#include "edit/server/http_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr std::size_t k_longest_target = 2000;

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

bool is_name(std::string_view name, std::string_view lower) {
    return std::ranges::equal(name, lower, [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == b;
    });
}

std::optional<std::size_t> read_length(std::string_view text) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Reads "GET /path HTTP/1.1"; 0, or the status of the refusal.
int read_first_line(std::string_view line, HttpHead& head) {
    const std::size_t first = line.find(' '), last = line.rfind(' ');
    if (first == std::string_view::npos || first == last) return 400;
    const std::string_view version = line.substr(last + 1);
    if (version != "HTTP/1.1" && version != "HTTP/1.0") return 400;
    head.method = line.substr(0, first);
    head.target = line.substr(first + 1, last - first - 1);
    if (head.target.size() > k_longest_target) return 414;
    const auto is_plain = [](char c) { return c > ' ' && c < '\x7f'; };
    if (head.target.empty() || head.target.front() != '/' ||
        !std::ranges::all_of(head.target, is_plain))
        return 400;
    return 0;
}

// Takes from one header what concerns the body; 0, or the status of the refusal.
int read_header(std::string_view line, HttpHead& head, bool& has_length) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || colon == 0) return 400;
    const std::string_view name = line.substr(0, colon);
    if (is_name(name, "transfer-encoding")) return 411;
    if (!is_name(name, "content-length")) return 0;
    const auto length = read_length(trimmed(line.substr(colon + 1)));
    if (!length || has_length) return 400;
    has_length = true;
    head.body_bytes = *length;
    return 0;
}

}  // namespace

std::string HttpRequest::header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
}

std::string HttpRequest::parameter(const std::string& name) const {
    const auto found = query.find(name);
    return found == query.end() ? "" : found->second;
}

HttpHeadResult read_http_head(std::string_view received) {
    HttpHeadResult result;
    const std::size_t end = received.find("\r\n\r\n");
    if (end == std::string_view::npos) return result;
    result.is_complete = true;
    result.head.bytes = end + 4;
    std::string_view rest = received.substr(0, end + 2);
    bool is_first = true, has_length = false;
    while (!rest.empty() && result.refusal == 0) {
        const std::size_t line_end = rest.find("\r\n");
        const std::string_view line = rest.substr(0, line_end);
        result.refusal = is_first ? read_first_line(line, result.head)
                                  : read_header(line, result.head, has_length);
        is_first = false;
        rest.remove_prefix(line_end + 2);
    }
    return result;
}

std::string_view http_reason(int status) {
    switch (status) {
        case 200:
            return "OK";
        case 400:
            return "Bad Request";
        case 403:
            return "Forbidden";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        case 408:
            return "Request Timeout";
        case 409:
            return "Conflict";
        case 411:
            return "Length Required";
        case 413:
            return "Payload Too Large";
        case 414:
            return "URI Too Long";
        case 415:
            return "Unsupported Media Type";
        case 422:
            return "Unprocessable Entity";
        case 431:
            return "Request Header Fields Too Large";
        case 503:
            return "Service Unavailable";
        default:
            return "Internal Server Error";
    }
}

namespace {

// A refused client has so long to read why [s].
constexpr double k_closing_seconds = 1;
constexpr int k_backlog = 512;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

int bound_socket(int port) {
    const int listening = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (listening < 0) throw IoError(fmt::format("no socket: {}", std::strerror(errno)));
    const int on = 1;
    setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        listen(listening, k_backlog) != 0) {
        const int reason = errno;
        close(listening);
        throw IoError(
            fmt::format("port {} of 127.0.0.1: {}; choose another with --port, or leave "
                        "it out for a free one",
                        port, std::strerror(reason)));
    }
    return listening;
}

int port_of(int listening) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
}

}  // namespace

HttpListener::HttpListener(int port, HttpLimits limits)
    : limits_(limits),
      listening_(bound_socket(port)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    port_ = port_of(listening_);
}

HttpListener::~HttpListener() {
    stop();
    close(listening_);
    close(wake_);
}

void HttpListener::start(BodyLimit body_limit, Answer answer) {
    body_limit_ = std::move(body_limit);
    answer_ = std::move(answer);
    for (std::size_t i = 0; i < limits_.workers; ++i) workers_.emplace_back([this] { work(); });
    thread_ = std::thread([this] { run(); });
}

void HttpListener::stop() {
    is_stopping_ = true;
    wake();
    {
        const std::lock_guard lock(mutex_);
        has_task_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
    for (std::thread& worker : workers_) worker.join();
    workers_.clear();
    for (const Connection& connection : parked_) close(connection.socket);
    parked_.clear();
    for (const Connection& connection : answered_) close(connection.socket);
    answered_.clear();
    for (const Task& task : tasks_) close(task.socket);
    tasks_.clear();
}

void HttpListener::wake() const {
    const std::uint64_t one = 1;
    // It fails only if the thread has been woken so often already that it is awake.
    [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof one);
}

void HttpListener::run() {
    while (!is_stopping_) {
        wait();
        const double now = seconds_now();
        // A connection may be taken out of the list while it is looked at.
        std::size_t i = 0;
        for (auto at = parked_.begin(); at != parked_.end(); ++i) {
            const auto connection = at++;
            if (!ready_[i]) continue;
            if (!read(*connection, now)) {
                close(connection->socket);
                parked_.erase(connection);
                continue;
            }
            look_at(connection, now);
        }
        take_back(now);
        drop_late(now);
        if (is_new_) accept_all(now);
    }
}

double HttpListener::deadline(const Connection& connection) const {
    if (connection.is_closing) return connection.since + k_closing_seconds;
    return connection.since +
           (connection.received.empty() ? limits_.idle_seconds : limits_.request_seconds);
}

void HttpListener::wait() {
    std::vector<pollfd> polled;
    polled.reserve(parked_.size() + 2);
    double until = INFINITY;
    for (const Connection& connection : parked_) {
        polled.push_back({connection.socket, POLLIN, 0});
        until = std::min(until, deadline(connection));
    }
    polled.push_back({wake_, POLLIN, 0});
    polled.push_back({listening_, POLLIN, 0});
    int timeout = -1;
    if (std::isfinite(until))
        timeout = static_cast<int>(std::ceil(1000 * std::max(0.0, until - seconds_now())));
    const bool any = poll(polled.data(), polled.size(), timeout) > 0;
    ready_.assign(parked_.size(), false);
    for (std::size_t i = 0; any && i < ready_.size(); ++i) ready_[i] = polled[i].revents != 0;
    is_new_ = any && polled.back().revents != 0;
    std::uint64_t ignored = 0;
    while (::read(wake_, &ignored, sizeof ignored) > 0) {
    }
}

void HttpListener::accept_all(double now) {
    for (;;) {
        const int socket = accept4(listening_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0) return;
        const int on = 1;
        setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        if (!make_room())
            close(socket);
        else
            parked_.push_back({socket, "", now, false});
    }
}

bool HttpListener::make_room() {
    std::size_t busy = 0;
    {
        const std::lock_guard lock(mutex_);
        busy = busy_;
    }
    while (!parked_.empty() && parked_.size() + busy >= limits_.connections) {
        const auto longest = std::ranges::min_element(parked_, {}, &Connection::since);
        close(longest->socket);
        parked_.erase(longest);
    }
    return parked_.size() + busy < limits_.connections;
}

bool HttpListener::read(Connection& connection, double now) {
    char buffer[16384];
    const ssize_t count = recv(connection.socket, buffer, sizeof buffer, MSG_DONTWAIT);
    if (count == 0) return false;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (connection.is_closing) return true;
    if (connection.received.empty()) connection.since = now;
    connection.received.append(buffer, static_cast<std::size_t>(count));
    return true;
}

void HttpListener::refuse(Connection& connection, int status, double now) {
    const std::string body = fmt::format("{{\"error\":\"{}\"}}", http_reason(status));
    const std::string answer = fmt::format(
        "HTTP/1.1 {} {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n"
        "Connection: close\r\n\r\n{}",
        status, http_reason(status), body.size(), body);
    // A client with no room for these few bytes will see its connection closed.
    [[maybe_unused]] const ssize_t sent =
        send(connection.socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    shutdown(connection.socket, SHUT_WR);
    connection.received.clear();
    connection.is_closing = true;
    connection.since = now;
}

// Hands a complete request to a worker.
void HttpListener::look_at(Connections::iterator connection, double now) {
    if (connection->is_closing || connection->received.empty()) return;
    const HttpHeadResult result = read_http_head(connection->received);
    const HttpHead& head = result.head;
    if (result.refusal != 0) return refuse(*connection, result.refusal, now);
    const std::size_t head_bytes = result.is_complete ? head.bytes : connection->received.size();
    if (head_bytes > limits_.head_bytes) return refuse(*connection, 431, now);
    if (!result.is_complete) return;
    if (head.body_bytes > body_limit_(head)) return refuse(*connection, 413, now);
    const std::size_t bytes = head.bytes + head.body_bytes;
    if (connection->received.size() < bytes) return;
    Task task{connection->socket, connection->received.substr(0, bytes),
              connection->received.substr(bytes)};
    parked_.erase(connection);
    const std::lock_guard lock(mutex_);
    ++busy_;
    tasks_.push_back(std::move(task));
    has_task_.notify_one();
}

void HttpListener::take_back(double now) {
    std::vector<Connection> answered;
    {
        const std::lock_guard lock(mutex_);
        std::swap(answered, answered_);
    }
    for (Connection& connection : answered) {
        connection.since = now;
        parked_.push_back(std::move(connection));
        look_at(std::prev(parked_.end()), now);
    }
}

void HttpListener::drop_late(double now) {
    for (auto at = parked_.begin(); at != parked_.end();) {
        const auto connection = at++;
        if (now < deadline(*connection)) continue;
        if (!connection->is_closing && !connection->received.empty()) {
            refuse(*connection, 408, now);
            continue;
        }
        close(connection->socket);
        parked_.erase(connection);
    }
}

void HttpListener::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        has_task_.wait(lock, [&] { return is_stopping_ || !tasks_.empty(); });
        if (is_stopping_) return;
        Task task = std::move(tasks_.front());
        tasks_.pop_front();
        lock.unlock();
        const bool is_kept = answer_(task.socket, std::move(task.request));
        if (!is_kept) close(task.socket);
        lock.lock();
        --busy_;
        if (!is_kept) continue;
        answered_.push_back({task.socket, std::move(task.rest), 0, false});
        wake();
    }
}

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
