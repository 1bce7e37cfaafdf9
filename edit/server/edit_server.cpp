#include "edit/server/edit_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <map>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "edit/server/page_files.h"
#include "edit/session/session_measures.h"

namespace uw {

namespace {

using httplib::Request;
using httplib::Response;

// Each window that follows the events keeps a thread; the others answer.
constexpr std::size_t k_threads = 32, k_max_windows = 16;
constexpr std::size_t k_max_body_bytes = 256 * 1024, k_longest_target = 2000;
constexpr int k_read_seconds = 2, k_write_seconds = 5;  // without a byte
constexpr int k_silent_seconds = 60;  // that the kernel keeps a connection before its first byte
constexpr double k_heartbeat_seconds = 15;
constexpr int k_max_json_depth = 16;
constexpr std::int64_t k_max_pixels = 1 << 20;  // along a side

// A parameter of an address, "?min=3"; `otherwise` where there is none.
std::int64_t integer_parameter(const Request& request, const char* name, std::int64_t otherwise) {
    const std::string text = request.get_param_value(name);
    if (text.empty()) return otherwise;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(fmt::format("{}: expected a whole number", name));
    return value;
}

double number_parameter(const Request& request, const char* name, double otherwise) {
    const std::string text = request.get_param_value(name);
    double value = otherwise;
    if (!text.empty() && parse_number(text, value) != NumberText::number)
        throw UsageError(fmt::format("{}: expected a number", name));
    return value;
}

NumbersRequest numbers_request(const Request& request) {
    NumbersRequest wanted;
    wanted.ratio = number_parameter(request, "ratio", wanted.ratio);
    wanted.with_curves = integer_parameter(request, "curves", 0) != 0;
    if (request.get_param_value("x0").empty()) return wanted;
    const auto pixel = [&](const char* name) {
        const std::int64_t value = integer_parameter(request, name, -1);
        if (value < 0 || value > k_max_pixels)
            throw UsageError(fmt::format("{}: expected a pixel of the image", name));
        return static_cast<int>(value);
    };
    wanted.part = PixelWindow{pixel("x0"), pixel("y0"), pixel("x1"), pixel("y1")};
    return wanted;
}

// Refuses what is nested so deeply that reading it would need much of the stack.
Json read_json(const std::string& body) {
    const Json::parser_callback_t is_shallow = [](int depth, Json::parse_event_t /*event*/,
                                                  Json& /*value*/) {
        if (depth > k_max_json_depth) throw UsageError("the request is nested too deeply");
        return true;
    };
    try {
        Json json = Json::parse(body.empty() ? "{}" : body, is_shallow);
        if (!json.is_object()) throw UsageError("expected a JSON object");
        return json;
    } catch (const Json::exception& error) {
        throw UsageError(error.what());
    }
}

// A body is sent as it is: set_content() would compress it, which takes longer than the way to
// this machine.
void send_body(Response& response, std::string body, const std::string& type) {
    const std::size_t size = body.size();
    if (size == 0) return;
    response.set_content_provider(
        size, type,
        [body = std::move(body)](std::size_t at, std::size_t count, httplib::DataSink& sink) {
            sink.write(body.data() + at, std::min(count, body.size() - at));
            return true;
        });
}

void send_json(Response& response, const Json& json) {
    send_body(response, json.dump(-1, ' ', false, Json::error_handler_t::replace),
              "application/json");
}

void refuse(Response& response, int status, std::string_view message) {
    response.status = status;
    send_json(response, {{"error", printable(message, 2000)}});
}

// Sends what a browser saves as a file of this name.
void send_file(Response& response, std::string body, const std::string& type,
               const std::string& name) {
    response.set_header("Content-Disposition", "attachment; filename=\"" + name + "\"");
    send_body(response, std::move(body), type);
}

void send_page_file(Response& response, std::string_view name) {
    const PageFile* file = find_page_file(name);
    if (!file) return refuse(response, 404, "there is no such file");
    send_body(response, std::string(file->text), std::string(content_type(file->name)));
}

std::string event_text(const Event& event) {
    return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", event.number, event.name, event.data);
}

std::string random_token() {
    std::array<std::uint8_t, 16> bytes{};
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t count = getrandom(bytes.data() + at, bytes.size() - at, 0);
        if (count < 0 && errno != EINTR) throw IoError("no random numbers for the address");
        if (count > 0) at += static_cast<std::size_t>(count);
    }
    std::string token;
    for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

// Compares in a time that does not depend on where they differ.
bool is_equal(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

// The path below "/TOKEN", with its slash; empty for any other.
std::string_view path_within(std::string_view path, std::string_view token) {
    if (path.size() < token.size() + 2 || path[0] != '/' || path[token.size() + 1] != '/')
        return "";
    return is_equal(path.substr(1, token.size()), token) ? path.substr(token.size() + 1) : "";
}

// Answers a request that failed.
void refuse_for(Response& response, const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const UsageError& error) {
        refuse(response, 400, error.what());
    } catch (const InputError& error) {
        refuse(response, 422, error.what());
    } catch (const ConflictError& error) {
        refuse(response, 409, error.what());
    } catch (const IoError& error) {
        refuse(response, 422, error.what());
    } catch (const std::exception& error) {
        refuse(response, 500, line_of(error));
    }
}

// Threads that answer. A request that needs more memory than there is ends alone.
class Workers final : public httplib::TaskQueue {
  public:
    // Its result depends on the library's version.
    auto enqueue(std::function<void()> serve) -> decltype(TaskQueue::enqueue({})) override {
        return pool_.enqueue([serve = std::move(serve)] {
            try {
                serve();
            } catch (const std::bad_alloc&) {
            }
        });
    }
    void shutdown() override { pool_.shutdown(); }

  private:
    httplib::ThreadPool pool_{k_threads};
};

// Binds the server to an address; returns the port.
//
// A connection keeps a thread from when it is accepted until it ends, so the kernel is told to
// accept none before its first byte has come, and each is closed after one answer: those that say
// nothing wait in the kernel's queue. The library would make that queue 5 long, and would let
// other programs share the port.
int bind_to(httplib::Server& server, EditAddress where, int port) {
    int listening = -1;
    server.set_socket_options([&](socket_t socket) {
        listening = socket;
        const int on = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        setsockopt(socket, IPPROTO_TCP, TCP_DEFER_ACCEPT, &k_silent_seconds,
                   sizeof k_silent_seconds);
    });
    const char* const host = where == EditAddress::everywhere ? "0.0.0.0" : "127.0.0.1";
    const int bound = port == 0                         ? server.bind_to_any_port(host)
                      : server.bind_to_port(host, port) ? port
                                                        : -1;
    if (bound < 0 || listen(listening, SOMAXCONN) != 0)
        throw IoError(
            fmt::format("port {} of {}: {}; choose another with --port, or leave it out for a free "
                        "one",
                        port, host, std::strerror(errno)));
    return bound;
}

}  // namespace

class EditServer::Page {
  public:
    Page(EditSession& session, int port, EditAddress where);
    ~Page();
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;
    Page(Page&&) = delete;
    Page& operator=(Page&&) = delete;

    int port() const { return port_; }
    const std::string& token() const { return token_; }

  private:
    bool is_from_here(const Request& request) const;
    bool is_refused(const Request& request, Response& response) const;
    void answer(const Request& request, Response& response);
    void send_events(Response& response);
    void send_image(const Request& request, Response& response) const;

    EditSession& session_;
    SessionMeasures measures_;
    std::string token_ = random_token();
    std::atomic<std::size_t> windows_ = 0;  // that follow the events
    httplib::Server server_;
    int port_ = 0;
    std::thread thread_;
};

EditServer::Page::Page(EditSession& session, int port, EditAddress where)
    : session_(session), measures_(session) {
    server_.new_task_queue = [] { return new Workers; };
    server_.set_keep_alive_max_count(1);
    server_.set_keep_alive_timeout(0);  // the first byte is there
    server_.set_read_timeout(k_read_seconds);
    server_.set_write_timeout(k_write_seconds);
    server_.set_payload_max_length(k_max_body_bytes);
    server_.set_tcp_nodelay(true);
    server_.set_default_headers({
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
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
        // All is sent whole: the library would cut ranges out of bodies that do not have them.
        const_cast<Request&>(request).ranges.clear();
        return is_refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                             : httplib::Server::HandlerResponse::Unhandled;
    });
    const auto answer_it = [this](const Request& request, Response& response) {
        answer(request, response);
    };
    server_.Get(".*", answer_it);
    server_.Post(".*", answer_it);
    server_.set_exception_handler(
        [](const Request&, Response& response, const std::exception_ptr& failure) {
            refuse_for(response, failure);
        });
    // Errors of the library itself have no body yet.
    server_.set_error_handler([](const Request&, Response& response) {
        if (!response.has_header("Content-Type"))
            refuse(response, response.status, "this is not a request that the editor understands");
    });
    port_ = bind_to(server_, where, port);
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // A server that does not run yet cannot be stopped.
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

EditServer::Page::~Page() {
    session_.events().close();
    server_.stop();
    thread_.join();
}

// A name that another page has made point here has another Host; a request that another page makes
// has another Origin.
bool EditServer::Page::is_from_here(const Request& request) const {
    const std::array hosts{fmt::format("127.0.0.1:{}", port_), fmt::format("localhost:{}", port_)};
    const std::string host = request.get_header_value("Host"),
                      origin = request.get_header_value("Origin"),
                      site = request.get_header_value("Sec-Fetch-Site");
    const bool is_other_site = !site.empty() && site != "same-origin" && site != "none";
    if ((host != hosts[0] && host != hosts[1]) || is_other_site) return false;
    return origin.empty() || origin == "http://" + host;
}

// Answers what is refused before its body is read.
bool EditServer::Page::is_refused(const Request& request, Response& response) const {
    const bool has_length = request.has_header("Content-Length");
    if (request.target.size() > k_longest_target)
        refuse(response, 414, "the address is too long");
    else if (!is_from_here(request))
        refuse(response, 403, "this address is not for other pages");
    else if (path_within(request.path, token_).empty())
        refuse(response, 403, "open the address that uwvdb edit has printed");
    else if (request.method != "GET" && request.method != "POST")
        refuse(response, 405, "this address is not for that method");
    else if (request.has_header("Transfer-Encoding") || (request.method == "POST" && !has_length))
        refuse(response, 411, "the length of the request is missing");
    else
        return false;
    return true;
}

void EditServer::Page::answer(const Request& request, Response& response) {
    using Get = std::function<void()>;
    using Post = std::function<Json(const Json& body)>;
    const std::map<std::string_view, Get> gets{
        {"/", [&] { send_page_file(response, "index.html"); }},
        {"/api/state", [&] { send_json(response, session_.state()); }},
        {"/api/outlines", [&] { send_json(response, session_.outlines()); }},
        {"/api/events", [&] { send_events(response); }},
        {"/api/image", [&] { send_image(request, response); }},
        {"/api/numbers", [&] { send_json(response, measures_.numbers(numbers_request(request))); }},
        {"/api/view",
         [&] { send_body(response, measures_.view_table(), "application/octet-stream"); }},
        {"/api/export/numbers.csv",
         [&] {
             send_file(response, measures_.numbers_csv(numbers_request(request)),
                       "text/csv; charset=utf-8", "numbers.csv");
         }},
        {"/api/export/picture.png",
         [&] {
             std::optional<double> exposure;
             if (!request.get_param_value("exposure").empty())
                 exposure = number_parameter(request, "exposure", 1);
             send_file(response, measures_.picture_png(exposure), "image/png", "picture.png");
         }},
    };
    const auto then_state = [&](auto&& change) {
        change();
        return session_.state();
    };
    const std::map<std::string_view, Post> posts{
        {"/api/edit", [&](const Json& body) { return then_state([&] { session_.edit(body); }); }},
        {"/api/undo", [&](const Json&) { return then_state([&] { session_.undo(); }); }},
        {"/api/redo", [&](const Json&) { return then_state([&] { session_.redo(); }); }},
        {"/api/show", [&](const Json& body) { return then_state([&] { session_.show(body); }); }},
        {"/api/reload", [&](const Json&) { return then_state([&] { session_.reload(); }); }},
        {"/api/save", [&](const Json& body) { return then_state([&] { session_.save(body); }); }},
        {"/api/save_as",
         [&](const Json& body) { return then_state([&] { session_.save_as(body); }); }},
        {"/api/suggest", [&](const Json& body) { return measures_.suggest(body); }},
        {"/api/suggest/cancel",
         [&](const Json&) {
             measures_.cancel_suggest();
             return Json::object();
         }},
    };
    const std::string_view path = path_within(request.path, token_);
    const auto get = gets.find(path);
    const auto post = posts.find(path);
    const bool is_file = path.starts_with("/page/");
    if (get == gets.end() && post == posts.end() && !is_file)
        return refuse(response, 404, "there is nothing at this address");
    if ((request.method == "POST") != (post != posts.end()))
        return refuse(response, 405, "this address is not for that method");
    if (is_file) return send_page_file(response, path.substr(6));
    if (get != gets.end()) return get->second();
    // Other pages can send forms without being asked, but not this type.
    if (!request.get_header_value("Content-Type").starts_with("application/json"))
        return refuse(response, 415, "expected application/json");
    send_json(response, post->second(read_json(request.body)));
}

void EditServer::Page::send_events(Response& response) {
    if (++windows_ > k_max_windows) {
        --windows_;
        return refuse(response, 503, "too many windows; close one");
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this](std::size_t /*at*/, httplib::DataSink& sink) {
            const auto send_text = [&](const std::string& text) {
                sink.write(text.data(), text.size());
                return sink.is_writable();
            };
            EventLog& log = session_.events();
            std::uint64_t last = log.last();
            bool is_open = send_text("retry: 1000\nevent: hello\ndata: {}\n\n");
            while (is_open && !log.is_closed()) {
                const std::vector<Event> events = log.wait(last, k_heartbeat_seconds);
                if (events.empty()) is_open = send_text(": still here\n\n");
                for (const Event& event : events) {
                    is_open = is_open && send_text(event_text(event));
                    last = event.number;
                }
            }
            return false;
        },
        [this](bool /*success*/) { --windows_; });
}

void EditServer::Page::send_image(const Request& request, Response& response) const {
    const std::string type = request.get_param_value("type");
    if (!type.empty() && type != "f16" && type != "f32")
        throw UsageError("type: expected f16 or f32");
    const std::int64_t least = integer_parameter(request, "min", 0);
    const std::shared_ptr<const Picture> picture = session_.picture();
    if (!picture || picture->number < least) {
        response.status = 204;
        return;
    }
    send_body(response, picture_bytes(*picture, type == "f16" ? SampleType::f16 : SampleType::f32),
              "application/octet-stream");
}

EditServer::EditServer(EditSession& session, int port, EditAddress where)
    : page_(std::make_unique<Page>(session, port, where)) {}

EditServer::~EditServer() = default;

int EditServer::port() const {
    return page_->port();
}

const std::string& EditServer::token() const {
    return page_->token();
}

std::string EditServer::address() const {
    return fmt::format("http://127.0.0.1:{}/{}/", port(), token());
}

}  // namespace uw
