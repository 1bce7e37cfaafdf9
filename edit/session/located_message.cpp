#include "edit/session/located_message.h"

#include <charconv>
#include <system_error>

namespace uw {

Json located_message(const std::string& message, const std::string& file_name) {
    Json located = {{"message", message}, {"line", nullptr}, {"column", nullptr}};
    const std::string begin = file_name + ":";
    const std::size_t at = message.find(begin);
    if (at == std::string::npos) return located;
    const char* const end = message.data() + message.size();
    const char* next = message.data() + at + begin.size();
    for (const char* key : {"line", "column"}) {
        int number = 0;
        const auto [rest, error] = std::from_chars(next, end, number);
        if (error != std::errc() || rest == end || *rest != ':') break;
        located[key] = number;
        next = rest + 1;
    }
    return located;
}

}  // namespace uw
