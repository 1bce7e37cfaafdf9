#include "core/geometry/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/geometry/polygon.h"

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

namespace {

constexpr std::size_t k_buffer_bytes = std::size_t{1} << 20;
constexpr std::size_t k_max_number_length = 100;

template <typename T>
double number_at(const char* bytes, bool swap) {
    char ordered[sizeof(T)];
    std::memcpy(ordered, bytes, sizeof(T));
    if (swap) std::reverse(ordered, ordered + sizeof(T));
    T value{};
    std::memcpy(&value, ordered, sizeof(T));
    return static_cast<double>(value);
}

double number_at(const char* bytes, PlyType type, bool swap) {
    switch (type) {
        case PlyType::int8:
            return number_at<std::int8_t>(bytes, swap);
        case PlyType::uint8:
            return number_at<std::uint8_t>(bytes, swap);
        case PlyType::int16:
            return number_at<std::int16_t>(bytes, swap);
        case PlyType::uint16:
            return number_at<std::uint16_t>(bytes, swap);
        case PlyType::int32:
            return number_at<std::int32_t>(bytes, swap);
        case PlyType::uint32:
            return number_at<std::uint32_t>(bytes, swap);
        case PlyType::float32:
            return number_at<float>(bytes, swap);
        case PlyType::float64:
            return number_at<double>(bytes, swap);
    }
    return 0;
}

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}  // namespace

PlySource::PlySource(std::istream& in, PlyEncoding encoding, std::string name)
    : in_(&in), encoding_(encoding), name_(std::move(name)), buffer_(k_buffer_bytes) {}

/// Keeps the unread bytes and appends to them; false at the end of the file.
bool PlySource::fill() {
    std::memmove(buffer_.data(), buffer_.data() + at_, end_ - at_);
    end_ -= at_;
    at_ = 0;
    in_->read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    const auto got = static_cast<std::size_t>(in_->gcount());
    end_ += got;
    return got > 0;
}

double PlySource::next(PlyType type) {
    if (encoding_ == PlyEncoding::ascii) return next_text();
    const std::size_t size = size_of(type);
    while (end_ - at_ < size) {
        if (!fill()) throw InputError(name_ + ": the PLY file is truncated; export the mesh again");
    }
    const bool file_is_little = encoding_ == PlyEncoding::little_endian;
    const bool swap = file_is_little != (std::endian::native == std::endian::little);
    const double value = number_at(buffer_.data() + at_, type, swap);
    at_ += size;
    return value;
}

double PlySource::next_text() {
    for (;;) {
        while (at_ < end_ && is_space(buffer_[at_])) ++at_;
        if (at_ < end_) break;
        if (!fill()) throw InputError(name_ + ": the PLY file is truncated; export the mesh again");
    }
    if (end_ - at_ < k_max_number_length) fill();
    const char* begin = buffer_.data() + at_;
    const char* end = buffer_.data() + std::min(end_, at_ + k_max_number_length);
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool whole = stop == buffer_.data() + end_ || (stop < end && is_space(*stop));
    if (error != std::errc{} || !whole) {
        const char* word_end = std::find_if(begin, end, is_space);
        throw InputError(name_ + ": not a number in the PLY file: '" +
                         std::string(begin, std::min(word_end, begin + 20)) + "'");
    }
    at_ = static_cast<std::size_t>(stop - buffer_.data());
    return value;
}

namespace {

constexpr std::uint32_t k_no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Minimum size in bytes of one entry of `element` in the file.
std::uint64_t min_size(const PlyElement& element, PlyEncoding encoding) {
    std::uint64_t size = 0;
    for (const PlyProperty& property : element.properties) {
        if (encoding == PlyEncoding::ascii) {
            size += 2;
        } else {
            size += size_of(property.is_list ? property.count_type : property.type);
        }
    }
    return size;
}

/// Ensures that no loop or allocation follows a forged count.
void check_counts(const PlyHeader& header, std::uint64_t file_size, const std::string& name) {
    for (const PlyElement& element : header.elements) {
        const std::uint64_t size = min_size(element, header.encoding);
        // The last number of an ascii file need not be followed by white space.
        if (size > 0 && element.count > (file_size + 1) / size) {
            throw InputError(
                fmt::format("{}: the PLY header promises {} of '{}', more than the file can hold; "
                            "the file is truncated",
                            name, element.count, element.name));
        }
    }
}

std::uint64_t list_length(double count, const std::string& name) {
    if (!(count >= 0) || count > 4294967295.0 || count != std::floor(count)) {
        throw InputError(name + ": a list in the PLY file has an invalid length");
    }
    return static_cast<std::uint64_t>(count);
}

void skip_entry(const PlyElement& element, PlySource& source, const std::string& name) {
    for (const PlyProperty& property : element.properties) {
        const std::uint64_t count =
            property.is_list ? list_length(source.next(property.count_type), name) : 1;
        for (std::uint64_t k = 0; k < count; ++k) source.next(property.type);
    }
}

/// x, y, z, nx, ny, nz, red, green, blue among the properties of a vertex.
struct VertexLayout {
    std::vector<int> slots;  // per property: 0..8, or -1 if skipped
    bool has_normals = false, has_colors = false;
    double color_unit = 1;  // of the file's colours in 0..1
};

/// The value of one step of a colour; 0 for types that cannot contain one.
double color_unit_of(PlyType type) {
    switch (type) {
        case PlyType::uint8:
            return 1.0 / 255;
        case PlyType::uint16:
            return 1.0 / 65535;
        case PlyType::float32:
        case PlyType::float64:
            return 1;
        default:
            return 0;
    }
}

VertexLayout layout_of(const PlyElement& element, const std::string& name) {
    static constexpr std::array<std::string_view, 9> names = {"x",  "y",   "z",     "nx",  "ny",
                                                              "nz", "red", "green", "blue"};
    constexpr std::string_view k_diffuse = "diffuse_";  // before colours, as some programs write
    VertexLayout layout;
    std::array<int, 9> found{};
    for (const PlyProperty& property : element.properties) {
        std::string_view bare = property.name;
        if (bare.starts_with(k_diffuse)) bare.remove_prefix(k_diffuse.size());
        int slot = -1;
        for (int k = 0; k < 9; ++k) {
            if (bare == names[static_cast<std::size_t>(k)] && !property.is_list) slot = k;
        }
        if (slot >= 6)
            layout.color_unit = std::min(layout.color_unit, color_unit_of(property.type));
        if (slot >= 0) ++found[static_cast<std::size_t>(slot)];
        layout.slots.push_back(slot);
    }
    if (found[0] != 1 || found[1] != 1 || found[2] != 1) {
        throw InputError(name + ": the PLY vertices lack x, y or z; export the mesh again");
    }
    layout.has_normals = found[3] == 1 && found[4] == 1 && found[5] == 1;
    layout.has_colors = found[6] == 1 && found[7] == 1 && found[8] == 1 && layout.color_unit > 0;
    return layout;
}

bool has_colors(const PlyElement& element) {
    return std::ranges::any_of(element.properties, [](const PlyProperty& property) {
        return property.name == "red" || property.name == "diffuse_red";
    });
}

/// sRGB-encoded colours as linear ones.
void append_color(const VertexLayout& layout, const float* color, TriangleMesh& mesh) {
    for (int k = 0; k < 3; ++k) {
        const double code = layout.color_unit * color[k];
        mesh.colors.push_back(static_cast<float>(linear_from_srgb(code)));
    }
}

void read_vertices(const PlyElement& element, PlySource& source, const std::string& name,
                   TriangleMesh& mesh) {
    if (element.count >= k_no_vertex) {
        throw InputError(name + ": more than 2^32 vertices; split the mesh");
    }
    const VertexLayout layout = layout_of(element, name);
    mesh.positions.reserve(3 * element.count + 4);  // Embree reads 16 bytes at the last vertex
    if (layout.has_normals) mesh.normals.reserve(3 * element.count);
    if (layout.has_colors) mesh.materials[0].base_color = {1, 1, 1};  // the colours alone
    for (std::uint64_t vertex = 0; vertex < element.count; ++vertex) {
        throw_if_stopped();
        std::array<float, 9> values{};
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (property.is_list) {
                const std::uint64_t length = list_length(source.next(property.count_type), name);
                for (std::uint64_t i = 0; i < length; ++i) source.next(property.type);
                continue;
            }
            const double value = source.next(property.type);
            const int slot = layout.slots[k];
            if (slot >= 0) values[static_cast<std::size_t>(slot)] = static_cast<float>(value);
        }
        mesh.positions.insert(mesh.positions.end(), values.begin(), values.begin() + 3);
        if (layout.has_normals) {
            mesh.normals.insert(mesh.normals.end(), values.begin() + 3, values.begin() + 6);
        }
        if (layout.has_colors) append_color(layout, &values[6], mesh);
    }
}

void append_polygon(const std::vector<std::uint32_t>& corners, const std::string& name,
                    TriangleMesh& mesh) {
    bool all_there = true;
    for (const std::uint32_t corner : corners) all_there &= corner < mesh.vertex_count();
    if (all_there) {
        triangulate_polygon(corners, mesh.positions, name, mesh.triangles);
    } else if (corners.size() >= 3) {
        mesh.triangles.insert(mesh.triangles.end(), {k_no_vertex, k_no_vertex, k_no_vertex});
    }
}

void read_faces(const PlyElement& element, PlySource& source, const std::string& name,
                TriangleMesh& mesh) {
    mesh.triangles.reserve(3 * element.count);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t face = 0; face < element.count; ++face) {
        throw_if_stopped();
        for (const PlyProperty& property : element.properties) {
            const bool wanted = property.is_list && (property.name == "vertex_indices" ||
                                                     property.name == "vertex_index");
            const std::uint64_t count =
                property.is_list ? list_length(source.next(property.count_type), name) : 1;
            if (wanted) corners.clear();
            for (std::uint64_t k = 0; k < count; ++k) {
                const double index = source.next(property.type);
                if (!wanted) continue;
                const bool valid = index >= 0 && index < static_cast<double>(mesh.vertex_count());
                corners.push_back(valid ? static_cast<std::uint32_t>(index) : k_no_vertex);
            }
            if (wanted) append_polygon(corners, name, mesh);
        }
    }
}

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    const std::string name = file.string();
    std::ifstream in = open_input(file, name, "mesh");
    const PlyHeader header = read_ply_header(in, name);
    check_counts(header, std::filesystem::file_size(file), name);
    PlySource source(in, header.encoding, name);
    TriangleMesh mesh;
    for (const PlyElement& element : header.elements) {
        if (element.properties.empty()) continue;  // occupies no bytes in the file
        if (element.name == "vertex") {
            read_vertices(element, source, name, mesh);
            if (has_colors(element) && mesh.colors.empty()) {
                warnings.push_back(name +
                                   ": ignored: vertex colours that are not red, green and "
                                   "blue of 8 or 16 bits or floats");
            }
        } else if (element.name == "face") {
            if (has_colors(element)) warnings.push_back(name + ": ignored: colours of faces");
            read_faces(element, source, name, mesh);
        } else {
            for (std::uint64_t k = 0; k < element.count; ++k) {
                throw_if_stopped();
                skip_entry(element, source, name);
            }
        }
    }
    return mesh;
}

}  // namespace uw
