#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

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

}  // namespace uw
