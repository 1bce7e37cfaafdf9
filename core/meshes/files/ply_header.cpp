#include "core/meshes/files/ply_header.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <sstream>

#include "core/base/error.h"

namespace uw {
namespace {

constexpr std::size_t k_max_line = 4096;
constexpr int k_max_lines = 10000;

std::string next_line(std::istream& in, const std::string& name) {
    std::string line;
    for (int c = in.get(); c != '\n'; c = in.get()) {
        if (c == std::istream::traits_type::eof() || line.size() > k_max_line) {
            throw InputError(name +
                             ": the PLY header is truncated or garbled; export the mesh again");
        }
        line.push_back(static_cast<char>(c));
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
}

PlyType type_named(const std::string& word, const std::string& name) {
    static const std::map<std::string, PlyType> types = {
        {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
        {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
        {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
        {"float64", PlyType::float64}};
    const auto found = types.find(word);
    if (found == types.end()) {
        throw InputError(fmt::format("{}: PLY header: unknown type '{}'", name, word));
    }
    return found->second;
}

PlyEncoding encoding_named(const std::string& word, const std::string& name) {
    if (word == "ascii") return PlyEncoding::ascii;
    if (word == "binary_little_endian") return PlyEncoding::little_endian;
    if (word == "binary_big_endian") return PlyEncoding::big_endian;
    throw InputError(fmt::format("{}: PLY header: unknown format '{}'", name, word));
}

PlyElement element_of(std::istringstream& words, const std::string& name) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const char* end = count.data() + count.size();
    const auto [stop, error] = std::from_chars(count.data(), end, element.count);
    if (count.empty() || error != std::errc{} || stop != end) {
        throw InputError(
            fmt::format("{}: PLY header: element '{}' has no valid count", name, element.name));
    }
    return element;
}

PlyProperty property_of(std::istringstream& words, const std::string& name) {
    PlyProperty property;
    std::string word;
    words >> word;
    if (word == "list") {
        property.is_list = true;
        words >> word;
        property.count_type = type_named(word, name);
        words >> word;
    }
    property.type = type_named(word, name);
    words >> property.name;
    return property;
}

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            return 8;
    }
    return 8;
}

PlyHeader read_ply_header(std::istream& in, const std::string& name) {
    if (in.get() != 'p' || in.get() != 'l' || in.get() != 'y' ||
        (in.peek() != '\n' && in.peek() != '\r')) {
        throw InputError(name + ": not a PLY file (it does not start with 'ply')");
    }
    next_line(in, name);
    PlyHeader header;
    bool has_format = false;
    for (int line = 0; line < k_max_lines; ++line) {
        std::istringstream words(next_line(in, name));
        std::string keyword, word;
        words >> keyword;
        if (keyword == "format") {
            words >> word;
            header.encoding = encoding_named(word, name);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(element_of(words, name));
        } else if (keyword == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(property_of(words, name));
        } else if (keyword == "end_header" && has_format) {
            return header;
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            throw InputError(fmt::format("{}: PLY header: misplaced or unknown line '{}'", name,
                                         keyword.substr(0, 40)));
        }
    }
    throw InputError(name + ": the PLY header does not end; export the mesh again");
}

}  // namespace uw
