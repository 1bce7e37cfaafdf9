#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "edit/server/http_message.h"

namespace uw {

/// What clients may claim of the server.
struct HttpLimits {
    std::size_t connections = 256;  // at once; a further one replaces the one idle for longest
    std::size_t head_bytes = 16384;
    double request_seconds = 5;  // from its first byte to its last
    double idle_seconds = 60;    // without a request
    std::size_t workers = 32;    // answers at once
};

/// Accepts connections on 127.0.0.1 and reads whole requests from them, all in one thread, so that
/// clients that say nothing, or say it slowly, cost no thread; threads of their own answer. Nothing
/// runs while nobody asks for anything.
class HttpListener {
  public:
    /// How many bytes of a body are taken from a request with this head.
    using BodyLimit = std::function<std::size_t(const HttpHead& head)>;
    /// Answers on the socket; whether the connection is to be kept.
    using Answer = std::function<bool(int socket, std::string request)>;

    /// Binds to `port`, 0 for any. Throws IoError if that is impossible.
    explicit HttpListener(int port, HttpLimits limits = {});
    /// As stop().
    ~HttpListener();
    HttpListener(const HttpListener&) = delete;
    HttpListener& operator=(const HttpListener&) = delete;
    HttpListener(HttpListener&&) = delete;
    HttpListener& operator=(HttpListener&&) = delete;

    int port() const { return port_; }
    void start(BodyLimit body_limit, Answer answer);
    /// Ends after the answers under way, which find `is_stopping` set.
    void stop();
    const std::atomic<bool>& is_stopping() const { return is_stopping_; }

  private:
    struct Connection {
        int socket = -1;
        std::string received;
        double since = 0;         // the first byte of a request, or the last answer [s]
        bool is_closing = false;  // refused: what it still sends is thrown away
    };
    using Connections = std::list<Connection>;

    void run();
    void wait();
    void accept_all(double now);
    bool make_room();
    bool read(Connection& connection, double now);
    void look_at(Connections::iterator connection, double now);
    static void refuse(Connection& connection, int status, double now);
    void take_back(double now);
    void drop_late(double now);
    double deadline(const Connection& connection) const;
    void work();
    void wake() const;

    HttpLimits limits_;
    int port_ = 0;
    int listening_ = -1, wake_ = -1;
    BodyLimit body_limit_;
    Answer answer_;
    std::atomic<bool> is_stopping_ = false;

    Connections parked_;  // of the listening thread alone; the longest idle first
    std::vector<bool> ready_;
    bool is_new_ = false;

    struct Task {
        int socket;
        std::string request, rest;  // what was sent beyond the request
    };
    std::mutex mutex_;
    std::condition_variable has_task_;
    std::deque<Task> tasks_;
    std::vector<Connection> answered_;
    std::size_t busy_ = 0;  // tasks and answers under way

    std::thread thread_;
    std::vector<std::thread> workers_;
};

}  // namespace uw
