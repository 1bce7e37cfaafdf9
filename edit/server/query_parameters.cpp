#include "edit/server/query_parameters.h"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

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

}  // namespace uw
