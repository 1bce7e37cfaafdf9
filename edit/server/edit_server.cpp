#include "edit/server/edit_server.h"

#include <sys/random.h>

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <exception>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "edit/server/page_files.h"
#include "edit/session/edit_session.h"

namespace uw {

namespace {

constexpr std::int64_t k_most_pixels = 1 << 20;  // along a side

}  // namespace

std::int64_t integer_parameter(const HttpRequest& request, const std::string& name,
                               std::int64_t otherwise) {
    const std::string text = request.parameter(name);
    if (text.empty()) return otherwise;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw UsageError(fmt::format("{}: expected a whole number", name));
    return value;
}

double number_parameter(const HttpRequest& request, const std::string& name, double otherwise) {
    const std::string text = request.parameter(name);
    double value = otherwise;
    if (!text.empty() && parse_number(text, value) != NumberText::number)
        throw UsageError(fmt::format("{}: expected a number", name));
    return value;
}

NumbersRequest numbers_request(const HttpRequest& request) {
    NumbersRequest wanted;
    wanted.ratio = number_parameter(request, "ratio", wanted.ratio);
    wanted.with_curves = integer_parameter(request, "curves", 0) != 0;
    if (request.parameter("x0").empty()) return wanted;
    const auto pixel = [&](const char* name) {
        const std::int64_t value = integer_parameter(request, name, -1);
        if (value < 0 || value > k_most_pixels)
            throw UsageError(fmt::format("{}: expected a pixel of the image", name));
        return static_cast<int>(value);
    };
    wanted.part = PixelWindow{pixel("x0"), pixel("y0"), pixel("x1"), pixel("y1")};
    return wanted;
}

namespace {

constexpr std::size_t k_most_body_bytes = 256 * 1024, k_most_windows = 16;
constexpr int k_most_json_depth = 16;
constexpr double k_heartbeat_seconds = 15;

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

// In a time that does not depend on where they differ.
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

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

HttpResponse json_response(const Json& json) {
    HttpResponse response;
    response.body = dump(json);
    return response;
}

HttpResponse error_response(int status, std::string_view message) {
    HttpResponse response = json_response({{"error", printable(message, 2000)}});
    response.status = status;
    return response;
}

// Refuses what is nested so deeply that reading it would need much of the stack.
Json read_json(const std::string& body) {
    const Json::parser_callback_t is_shallow = [](int depth, Json::parse_event_t /*event*/,
                                                  Json& /*value*/) {
        if (depth > k_most_json_depth) throw UsageError("the request is nested too deeply");
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

HttpResponse page_file(std::string_view name) {
    const PageFile* file = find_page_file(name);
    if (!file) return error_response(404, "there is no such file");
    HttpResponse response;
    response.type = content_type(file->name);
    response.body = file->text;
    return response;
}

std::string event_text(const Event& event) {
    return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", event.number, event.name, event.data);
}

}  // namespace

EditServer::EditServer(EditSession& session, int port, HttpLimits limits)
    : session_(session),
      measures_(session),
      token_(random_token()),
      listener_(port, limits),
      protocol_([this](const HttpRequest& request) { return answer(request); },
                listener_.is_stopping()) {
    listener_.start(
        [this](const HttpHead& head) {
            // Whoever is to be refused sends no body.
            return path_within(head.target, token_).empty() ? 0 : k_most_body_bytes;
        },
        [this](int socket, std::string request) {
            return protocol_.answer(socket, std::move(request));
        });
}

EditServer::~EditServer() {
    session_.events().close();
    listener_.stop();
}

std::string EditServer::address() const {
    return fmt::format("http://127.0.0.1:{}/{}/", port(), token_);
}

// A name that another page has made point here has another Host; a request that another page makes
// has another Origin.
bool EditServer::is_from_here(const HttpRequest& request) const {
    const std::array hosts{fmt::format("127.0.0.1:{}", port()),
                           fmt::format("localhost:{}", port())};
    const std::string host = request.header("host"), origin = request.header("origin");
    const std::string site = request.header("sec-fetch-site");
    const bool is_other_site = !site.empty() && site != "same-origin" && site != "none";
    if ((host != hosts[0] && host != hosts[1]) || is_other_site) return false;
    return origin.empty() || origin == "http://" + host;
}

HttpResponse EditServer::answer(const HttpRequest& request) {
    try {
        if (!is_from_here(request))
            return error_response(403, "this address is not for other pages");
        const std::string path(path_within(request.path, token_));
        if (path.empty())
            return error_response(403, "open the address that uwvdb edit has printed");
        return answer_within(request, path);
    } catch (const UsageError& error) {
        return error_response(400, error.what());
    } catch (const InputError& error) {
        return error_response(422, error.what());
    } catch (const ConflictError& error) {
        return error_response(409, error.what());
    } catch (const IoError& error) {
        return error_response(422, error.what());
    } catch (const std::exception& error) {
        return error_response(500, line_of(error));
    }
}

HttpResponse EditServer::answer_within(const HttpRequest& request, const std::string& path) {
    using Get = std::function<HttpResponse()>;
    using Post = std::function<Json(const Json& body)>;
    const std::map<std::string_view, Get> gets{
        {"/", [] { return page_file("index.html"); }},
        {"/api/state", [&] { return json_response(session_.state()); }},
        {"/api/outlines", [&] { return json_response(session_.outlines()); }},
        {"/api/events", [&] { return events(); }},
        {"/api/image", [&] { return image(request); }},
        {"/api/numbers",
         [&] { return json_response(measures_.numbers(numbers_request(request))); }},
        {"/api/export/numbers.csv", [&] { return numbers_csv(request); }},
        {"/api/export/picture.png", [&] { return picture_png(request); }},
    };
    const auto then_state = [&](auto&& change) {
        change();
        return session_.state();
    };
    const std::map<std::string_view, Post> posts{
        {"/api/edit", [&](const Json& body) { return then_state([&] { session_.edit(body); }); }},
        {"/api/undo", [&](const Json&) { return then_state([&] { session_.undo(); }); }},
        {"/api/redo", [&](const Json&) { return then_state([&] { session_.redo(); }); }},
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
    const auto get = gets.find(path);
    const auto post = posts.find(path);
    const bool is_file = path.starts_with("/page/");
    if (get == gets.end() && post == posts.end() && !is_file)
        return error_response(404, "there is nothing at this address");
    if (request.method == "POST" && post != posts.end()) {
        // A form, which other pages can send without being asked, is none.
        if (!request.header("content-type").starts_with("application/json"))
            return error_response(415, "expected application/json");
        return json_response(post->second(read_json(request.body)));
    }
    if (request.method != "GET" || post != posts.end())
        return error_response(405, "this address is not for that method");
    return is_file ? page_file(std::string_view(path).substr(6)) : get->second();
}

HttpResponse EditServer::events() {
    if (++windows_ > k_most_windows) {
        --windows_;
        return error_response(503, "too many windows; close one");
    }
    HttpResponse response;
    response.type = "text/event-stream";
    response.stream = [this](const HttpSend& send) {
        EventLog& log = session_.events();
        std::uint64_t last = log.last();
        bool is_open = send("retry: 1000\nevent: hello\ndata: {}\n\n");
        while (is_open && !log.is_closed()) {
            const std::vector<Event> events = log.wait(last, k_heartbeat_seconds);
            if (events.empty()) is_open = send(": still here\n\n");
            for (const Event& event : events) {
                is_open = is_open && send(event_text(event));
                last = event.number;
            }
        }
        --windows_;
    };
    return response;
}

HttpResponse EditServer::image(const HttpRequest& request) const {
    const std::string type = request.parameter("type");
    if (!type.empty() && type != "f16" && type != "f32")
        throw UsageError("type: expected f16 or f32");
    const std::int64_t least = integer_parameter(request, "min", 0);
    const std::shared_ptr<const Picture> picture = session_.picture();
    HttpResponse response;
    if (!picture || picture->number < least) {
        response.status = 204;
        return response;
    }
    response.type = "application/octet-stream";
    response.body = picture_bytes(*picture, type == "f16" ? SampleType::f16 : SampleType::f32);
    return response;
}

HttpResponse EditServer::numbers_csv(const HttpRequest& request) {
    HttpResponse response;
    response.type = "text/csv; charset=utf-8";
    response.file_name = "numbers.csv";
    response.body = measures_.numbers_csv(numbers_request(request));
    return response;
}

HttpResponse EditServer::picture_png(const HttpRequest& request) {
    std::optional<double> exposure;
    if (!request.parameter("exposure").empty()) exposure = number_parameter(request, "exposure", 1);
    HttpResponse response;
    response.type = "image/png";
    response.file_name = "picture.png";
    response.body = measures_.picture_png(exposure);
    return response;
}

}  // namespace uw
