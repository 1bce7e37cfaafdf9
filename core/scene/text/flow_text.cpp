#include "core/scene/text/flow_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "core/base/text.h"

namespace uw {
namespace {

/// In the order of docs/scene-file.md.
constexpr auto k_key_order = std::to_array<std::string_view>(
    {"uwvdb",      "camera",     "cameras",     "rig",        "water",      "volumes",
     "geometry",   "lamps",      "render",      "name",       "type",       "model",
     "file",       "resolution", "calibration", "intrinsics", "distortion", "port",
     "pose",       "lens",       "bands",       "preset",     "salinity",   "temperature",
     "absorption", "cdom",       "chlorophyll", "particles",  "small",      "large",
     "scattering", "b",          "phase",       "position",   "direction",  "width",
     "height",     "radius",     "samples",     "look_at",    "up",         "profile",
     "beam",       "edge",       "falloff",     "fwhm",       "rotate",     "tilt",
     "spectrum",   "intensity",  "power",       "lumens",     "frame"});

bool is_word_of_yaml(std::string_view text) {
    constexpr auto k_words = std::to_array<std::string_view>(
        {"null", "~", "true", "false", "yes", "no", "on", "off", "y", "n"});
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return std::ranges::find(k_words, lower) != k_words.end();
}

bool is_plain_character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
           (c >= 'A' && c <= 'Z') || std::string_view("_-./+ ()%$#").find(c) != std::string::npos;
}

/// Whether `text` may stand without quotes, in and outside brackets.
bool is_plain(std::string_view text) {
    if (text.empty() || text.back() == ' ' || text.front() == ' ' || text.front() == '#' ||
        text.front() == '-' || text.front() == '%' || text.find(" #") != std::string_view::npos ||
        text == "..." || is_word_of_yaml(text))
        return false;
    double number = 0;
    return std::ranges::all_of(text, is_plain_character) &&
           parse_number(text, number) == NumberText::no_number;
}

std::string in_double_quotes(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (c == '\n')
            result += "\\n";
        else if (c == '\t')
            result += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        else
            result += c;
    }
    return result + '"';
}

std::string scalar_text(const ConfigNode& node, const FlowStyle& style) {
    if (node.quoted) return quoted_if_needed(node.scalar, style.is_json);
    double number = 0;
    const bool is_number = parse_number(node.scalar, number) == NumberText::number;
    if (is_number || is_word_of_yaml(node.scalar)) return node.scalar;
    return quoted_if_needed(node.scalar, style.is_json);
}

/// By rank.
std::vector<const ConfigNode::Entry*> in_order(const ConfigNode& map) {
    std::vector<const ConfigNode::Entry*> entries;
    entries.reserve(map.entries.size());
    for (const ConfigNode::Entry& entry : map.entries) entries.push_back(&entry);
    std::ranges::stable_sort(entries, {}, [](const auto* entry) { return key_rank(entry->key); });
    return entries;
}

}  // namespace

std::string quoted_if_needed(std::string_view text, bool is_json) {
    if (is_json) return in_double_quotes(text);
    if (is_plain(text)) return std::string(text);
    const bool has_control =
        std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (has_control) return in_double_quotes(text);
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += c;
        result += c;
    }
    return result + "'";
}

std::string flow_text(const ConfigNode& value, const FlowStyle& style) {
    if (value.alias.line > 0 && style.alias_text) return style.alias_text(value);
    switch (value.kind) {
        case ConfigNode::Kind::null:
            return "null";
        case ConfigNode::Kind::scalar:
            return scalar_text(value, style);
        case ConfigNode::Kind::sequence: {
            std::string text = "[";
            for (const ConfigNode& item : value.items)
                text += (text.size() > 1 ? ", " : "") + flow_text(item, style);
            return text + "]";
        }
        case ConfigNode::Kind::map:
            break;
    }
    std::string text = "{";
    for (const ConfigNode::Entry* entry : in_order(value))
        text += (text.size() > 1 ? ", " : "") + quoted_if_needed(entry->key, style.is_json) + ": " +
                flow_text(entry->value, style);
    return text + "}";
}

std::size_t key_rank(std::string_view key) {
    return static_cast<std::size_t>(
        std::distance(k_key_order.begin(), std::ranges::find(k_key_order, key)));
}

}  // namespace uw
