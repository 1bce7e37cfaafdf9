#include "core/scene/config_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

/// Directions shorter than this cannot be distinguished from zero.
constexpr double k_shortest_direction = 1e-12;
/// No key has meaningful values beyond this, and squares and products would overflow later.
constexpr double k_max_number = 1e12;

/// Text such as "2m" or "1.5 ppm": starts as a number and ends as a word.
bool looks_like_number_with_unit(std::string_view text) {
    const std::size_t word = text.find_first_not_of("+-0123456789. ");
    return word != std::string_view::npos && word > 0 && is_digit(text[text[0] == '-' ? 1 : 0]);
}

bool looks_like_decimal_comma(std::string_view text) {
    const std::size_t comma = text.find(',');
    return comma != std::string_view::npos && comma > 0 && comma + 1 < text.size() &&
           text.find_first_not_of("+-0123456789,") == std::string_view::npos;
}

}  // namespace

std::string ConfigValue::location() const {
    const std::string position = node_->position.text();
    return path_.empty() ? position : fmt::format("{}: {}", position, path_);
}

void ConfigValue::fail(std::string_view what) const {
    throw InputError(fmt::format("{}: {}", location(), what));
}

void ConfigValue::fail_expected(std::string_view expected, std::string_view hint) const {
    if (node_->kind == ConfigNode::Kind::null) {
        fail(fmt::format("has no value; {}, or remove the key", hint));
    }
    fail(fmt::format("expected {}, found {}; {}", expected, node_->description(), hint));
}

void ConfigValue::fail_number(NumberText outcome, std::string_view hint) const {
    const std::string found = printable(node_->scalar);
    if (outcome == NumberText::not_finite) {
        fail(fmt::format("{} is not a finite number; {}", found, hint));
    }
    if (outcome == NumberText::out_of_range) {
        fail(fmt::format("{} is too large or too small for a number; {}", found, hint));
    }
    if (looks_like_decimal_comma(node_->scalar)) {
        fail(fmt::format("expected a number, found '{}'; write the decimal point as '.'", found));
    }
    if (looks_like_number_with_unit(node_->scalar)) {
        fail(
            fmt::format("expected a number, found '{}'; write the number alone, without a unit "
                        "({})",
                        found, hint));
    }
    fail_expected("a number", hint);
}

double ConfigValue::number(std::string_view hint) const {
    if (node_->kind != ConfigNode::Kind::scalar || node_->quoted) fail_expected("a number", hint);
    double value = 0;
    const NumberText outcome = parse_number(node_->scalar, value);
    if (outcome != NumberText::number) fail_number(outcome, hint);
    if (std::abs(value) > k_max_number) {
        fail(fmt::format("{} is larger than anything in a scene; {}", value, hint));
    }
    return value;
}

double ConfigValue::positive(std::string_view hint) const {
    const double value = number(hint);
    if (value <= 0) fail(fmt::format("must be greater than 0, found {}; {}", value, hint));
    return value;
}

double ConfigValue::non_negative(std::string_view hint) const {
    const double value = number(hint);
    if (value < 0) fail(fmt::format("must not be negative, found {}; {}", value, hint));
    return value;
}

double ConfigValue::within(double low, double high, std::string_view hint) const {
    const double value = number(hint);
    if (value < low || value > high) {
        fail(fmt::format("must be from {} to {}, found {}; {}", low, high, value, hint));
    }
    return value;
}

double ConfigValue::between(double low, double high, std::string_view hint) const {
    const double value = number(hint);
    if (value <= low || value >= high) {
        fail(fmt::format("must lie between {} and {}, found {}; {}", low, high, value, hint));
    }
    return value;
}

int ConfigValue::integer(int low, int high, std::string_view hint) const {
    const double value = number(hint);
    if (value != std::floor(value)) {
        fail(fmt::format("expected a whole number, found {}; {}", value, hint));
    }
    if (value < low || value > high) {
        fail(fmt::format("must be from {} to {}, found {}; {}", low, high, value, hint));
    }
    return static_cast<int>(value);
}

std::string ConfigValue::text(std::string_view hint) const {
    if (node_->kind != ConfigNode::Kind::scalar) fail_expected("text", hint);
    if (node_->scalar.empty()) fail(fmt::format("is empty; {}", hint));
    return node_->scalar;
}

std::vector<ConfigValue> ConfigValue::list(std::string_view hint) const {
    if (node_->kind != ConfigNode::Kind::sequence) fail_expected("a list", hint);
    std::vector<ConfigValue> values;
    values.reserve(node_->items.size());
    for (std::size_t i = 0; i < node_->items.size(); ++i) {
        values.emplace_back(node_->items[i], fmt::format("{}[{}]", path_, i));
    }
    return values;
}

std::vector<ConfigValue> ConfigValue::list_of(std::size_t count, std::string_view hint) const {
    if (node_->kind != ConfigNode::Kind::sequence || node_->items.size() != count) {
        fail_expected(fmt::format("a list of {}", count), hint);
    }
    return list(hint);
}

std::vector<ConfigValue> ConfigValue::per_band(std::size_t band_count,
                                               std::string_view hint) const {
    if (node_->kind == ConfigNode::Kind::scalar) return std::vector(band_count, *this);
    std::vector<ConfigValue> values = list(hint);
    if (values.size() != band_count) {
        fail(fmt::format("has {} value{}, but water.bands has {}; {}", values.size(),
                         values.size() == 1 ? "" : "s", band_count,
                         "give one value per band, or a single number for all of them"));
    }
    return values;
}

std::vector<double> ConfigValue::non_negative_per_band(std::size_t band_count,
                                                       std::string_view hint) const {
    std::vector<double> values;
    values.reserve(band_count);
    for (const ConfigValue& value : per_band(band_count, hint)) {
        values.push_back(value.non_negative(hint));
    }
    return values;
}

Vector3 ConfigValue::vector(std::string_view hint) const {
    const std::vector<ConfigValue> values = list_of(3, hint);
    return {values[0].number(hint), values[1].number(hint), values[2].number(hint)};
}

Vector3 ConfigValue::direction(std::string_view hint) const {
    const Vector3 v = vector(hint);
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > k_shortest_direction) || !std::isfinite(length)) {
        fail(fmt::format("[{}, {}, {}] has no direction; {}", v.x, v.y, v.z, hint));
    }
    return v / length;
}

std::size_t ConfigValue::word_index(std::span<const std::string_view> words) const {
    const std::string found = text(suggestion("", words));
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == found) return i;
    }
    fail(fmt::format("unknown value '{}'; {}", printable(found), suggestion(found, words)));
}

ConfigMap::ConfigMap(ConfigValue value, std::vector<std::string_view> allowed,
                     std::string_view hint)
    : value_(std::move(value)), allowed_(std::move(allowed)) {
    const ConfigNode& node = value_.node();
    if (node.kind == ConfigNode::Kind::null) {
        value_.fail(fmt::format("has no value; {}, or remove the key", hint));
    }
    if (node.kind != ConfigNode::Kind::map) {
        value_.fail(fmt::format("expected a map, found {}; {}", node.description(), hint));
    }
    read_.resize(node.entries.size(), false);
    for (const ConfigNode::Entry& entry : node.entries) {
        if (std::find(allowed_.begin(), allowed_.end(), entry.key) != allowed_.end()) continue;
        throw InputError(fmt::format("{}: {}: unknown key; {}", entry.position.text(),
                                     path_of(printable(entry.key)),
                                     suggestion(entry.key, allowed_)));
    }
}

std::string ConfigMap::path_of(std::string_view key) const {
    return value_.path().empty() ? std::string(key) : fmt::format("{}.{}", value_.path(), key);
}

std::optional<ConfigValue> ConfigMap::find(std::string_view key) {
    if (std::find(allowed_.begin(), allowed_.end(), key) == allowed_.end()) {
        throw std::logic_error("scene key read but not allowed: " + path_of(key));
    }
    const ConfigNode& node = value_.node();
    for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (node.entries[i].key != key) continue;
        read_[i] = true;
        return ConfigValue(node.entries[i].value, path_of(key));
    }
    return std::nullopt;
}

ConfigValue ConfigMap::require(std::string_view key, std::string_view hint) {
    if (std::optional<ConfigValue> found = find(key)) return *std::move(found);
    value_.fail(fmt::format("'{}' is missing; {}", key, hint));
}

void ConfigMap::finish(std::string_view by) const {
    const ConfigNode& node = value_.node();
    for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (read_[i]) continue;
        throw InputError(fmt::format("{}: {}: is not used by {}; remove it",
                                     node.entries[i].position.text(), path_of(node.entries[i].key),
                                     by));
    }
}

}  // namespace uw
