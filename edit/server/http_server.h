#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace uw {

/// A request that was received in full. Names of headers are in lower case.
struct HttpRequest {
    std::string method;  // "GET"
    std::string path;    // decoded, without the query
    std::map<std::string, std::string> headers;
    std::map<std::string, std::string> query;  // the first of each name
    std::string body;

    /// "" where there is none.
    std::string header(const std::string& name) const;
    std::string parameter(const std::string& name) const;
};

/// Sends a part of an endless answer; false if the client is gone.
using HttpSend = std::function<bool(std::string_view part)>;

/// An answer: a body, or a stream of parts.
struct HttpResponse {
    int status = 200;
    std::string type = "application/json";
    std::string body;
    std::string file_name;  // what a browser saves it as; empty: it shows it
    /// Instead of the body: sends parts until the client is gone or the server stops, then returns.
    std::function<void(const HttpSend& send)> stream;
};

/// Answers requests, on any thread.
using HttpHandler = std::function<HttpResponse(const HttpRequest& request)>;

/// What was sent of a request's head when it is complete, without its interpretation: enough to
/// know how many bytes follow.
struct HttpHead {
    std::size_t bytes = 0;  // of the head, with the empty line that ends it
    std::string method, target;
    std::size_t body_bytes = 0;
};

/// Why a head is refused before anything else is looked at; 0: it is not.
struct HttpHeadResult {
    bool is_complete = false;
    int refusal = 0;  // the status of the answer
    HttpHead head;
};

/// Looks at the beginning of what a client sent. Refused are: a first line that is none (400), a
/// target of more than 2000 bytes (414), an unclear length (400) and a body of unknown length
/// (411).
HttpHeadResult read_http_head(std::string_view received);

/// "Not Found".
std::string_view http_reason(int status);

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
