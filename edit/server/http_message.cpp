#include "edit/server/http_message.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

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

}  // namespace uw
