#include "edit/server/http_listener.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace uw {

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

}  // namespace uw
