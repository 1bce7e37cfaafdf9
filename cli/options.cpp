#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/input_files.h"

namespace uw {

namespace {

/// All of `text` as a number of type T; empty if it is not one.
template <class T>
std::optional<T> number_in(const std::string& text) {
    T value{};
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || next != end) return std::nullopt;
    return value;
}

int integer_within(const std::string& name, const std::string& text, int low, int high) {
    const std::optional<int> value = number_in<int>(text);
    if (value && *value >= low && *value <= high) return *value;
    throw UsageError(
        fmt::format("{}: expected {} to {}, found '{}'", name, low, high, printable(text)));
}

double number_within(const std::string& name, const std::string& text, double low, double high) {
    const std::optional<double> value = number_in<double>(text);
    if (value && *value > low && *value <= high) return *value;
    throw UsageError(fmt::format("{}: expected a number above {}, at most {}; found '{}'", name,
                                 low, high, printable(text)));
}

/// N whole numbers; `form` is what a message says they look like.
template <std::size_t N>
std::array<int, N> integers_in(const std::string& text, char separator, const std::string& option,
                               const char* form) {
    std::array<int, N> values{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < N; ++i) {
        const auto [next, error] = std::from_chars(at, end, values[i]);
        const bool last = i + 1 == N;
        if (error != std::errc() || (last ? next != end : next == end || *next != separator))
            throw UsageError(
                fmt::format("{}: expected {}, found '{}'", option, form, printable(text)));
        at = next + 1;
    }
    return values;
}

constexpr int k_longest_side = 32768;  // of an image [pixels]

}  // namespace

std::string Option::name() const {
    const std::size_t comma = names.rfind(',');
    return comma == std::string::npos ? names : names.substr(comma + 1);
}

Option& Options::flag(std::string names, bool& variable, std::string help) {
    Option& option = all_.emplace_back();
    option.names = std::move(names);
    option.help = std::move(help);
    option.take = [&variable](const std::string&) { variable = true; };
    return option;
}

Option& Options::parsed(std::string names, std::string value_name,
                        std::function<void(const std::string&)> take, std::string help) {
    Option& option = all_.emplace_back();
    option.names = std::move(names);
    option.value_name = std::move(value_name);
    option.help = std::move(help);
    option.value = Option::Value::text;
    option.take = std::move(take);
    return option;
}

Option& Options::text(std::string names, std::string value_name, std::string& variable,
                      std::string help) {
    return parsed(
        std::move(names), std::move(value_name),
        [&variable](const std::string& text) { variable = text; }, std::move(help));
}

Option& Options::path(std::string names, std::string value_name, std::filesystem::path& variable,
                      std::string help) {
    Option& option = parsed(
        std::move(names), std::move(value_name),
        [&variable](const std::string& text) { variable = text; }, std::move(help));
    option.value = Option::Value::path;
    return option;
}

Option& Options::integer(std::string names, std::string value_name, std::optional<int>& variable,
                         int low, int high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = integer_within(name, text, low, high);
    };
    return option;
}

Option& Options::integer(std::string names, std::string value_name, int& variable, int low,
                         int high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = integer_within(name, text, low, high);
    };
    return option;
}

Option& Options::number(std::string names, std::string value_name, std::optional<double>& variable,
                        double low, double high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = number_within(name, text, low, high);
    };
    return option;
}

Option& Options::number(std::string names, std::string value_name, double& variable, double low,
                        double high, std::string help) {
    Option& option = parsed(std::move(names), std::move(value_name), {}, std::move(help));
    option.take = [name = option.name(), &variable, low, high](const std::string& text) {
        variable = number_within(name, text, low, high);
    };
    return option;
}

void Options::set(std::vector<std::string>& overrides) {
    Option& option = parsed(
        "--set", "KEY.PATH=VALUE",
        [&overrides](const std::string& text) { overrides.push_back(text); },
        "replace a value of the scene file; may be repeated");
    option.repeatable = true;
}

void Options::size(std::optional<std::array<int, 2>>& variable, std::string help) {
    const auto take = [&variable](const std::string& text) {
        const auto size = integers_in<2>(text, 'x', "--size", "WxH such as 640x360");
        if (std::ranges::any_of(size, [](int side) { return side < 1 || side > k_longest_side; }))
            throw UsageError(
                fmt::format("--size: each side must be 1 to {} pixels", k_longest_side));
        variable = size;
    };
    parsed("--size", "WxH", take, std::move(help));
}

void Options::window(std::string names, std::optional<std::array<int, 4>>& variable,
                     std::string help) {
    Option& option = parsed(std::move(names), "x0,y0,x1,y1", {}, std::move(help));
    option.take = [name = option.name(), &variable](const std::string& text) {
        variable = integers_in<4>(text, ',', name, "x0,y0,x1,y1");
    };
}

void Options::threads(int& variable) {
    integer("--threads", "N", variable, 0, 1024, "threads to use; 0, the default: all");
}

void Options::confine() {
    Option& option = all_.emplace_back();
    option.names = "--confine";
    option.help = "refuse scenes that read files outside their own folder";
    option.take = [](const std::string&) { confine_inputs(); };
}

}  // namespace uw
