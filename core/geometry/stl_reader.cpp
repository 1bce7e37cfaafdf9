#include "core/geometry/stl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/geometry/mesh_text.h"

namespace uw {
namespace {

static_assert(std::endian::native == std::endian::little, "files are read as they lie");

constexpr std::uint64_t k_header_bytes = 84;  // any text, and the number of triangles
// A triangle has a normal, three vertices, and two bytes that some programs use for a colour.
constexpr std::uint64_t k_triangle_bytes = 50;
constexpr std::size_t k_normal_bytes = 12, k_vertices_bytes = 36;
constexpr std::uint64_t k_triangles_per_read = 4096;
constexpr std::size_t k_padding = 4;  // Embree reads 16 bytes at the last vertex
// What fits a large machine; places of vertices have 32 bits.
constexpr std::uint64_t k_max_triangles = 500'000'000;

[[noreturn]] void refuse_size(const std::string& name) {
    throw InputError(fmt::format("{}: more than {} million triangles; split or thin out the mesh",
                                 name, k_max_triangles / 1'000'000));
}

/// The first bytes of the file: its header if it is binary.
struct Beginning {
    std::array<char, k_header_bytes> bytes{};
    std::uint64_t file_size = 0;

    bool is_header() const { return file_size >= k_header_bytes; }
    std::uint64_t promised_triangles() const {
        std::uint32_t count = 0;
        std::memcpy(&count, bytes.data() + k_header_bytes - sizeof count, sizeof count);
        return count;
    }
    std::uint64_t promised_size() const {
        return k_header_bytes + k_triangle_bytes * promised_triangles();
    }
    /// Whether the file is text. Binary files may begin with "solid" as well: they are recognised
    /// by their size, or by a zero byte.
    bool is_text() const {
        if (is_header() && promised_size() == file_size) return false;
        const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(
                                             std::min(file_size, std::uint64_t{k_header_bytes}));
        return std::find(bytes.begin(), end, '\0') == end &&
               same_ignoring_case(TextLine({bytes.begin(), end}).next(), "solid");
    }
};

/// The next three vertices.
void append_triangle(TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2});
}

TriangleMesh read_binary(std::istream& in, const Beginning& beginning, const std::string& name) {
    const std::uint64_t count = beginning.promised_triangles();
    // Nothing is allocated for a forged count. What follows the triangles is not read.
    if (beginning.promised_size() > beginning.file_size)
        throw InputError(
            fmt::format("{}: is no STL text, and does not hold the {} triangles that it promises "
                        "if it is binary; export the mesh again",
                        name, count));
    if (count > k_max_triangles) refuse_size(name);
    TriangleMesh mesh;
    mesh.positions.reserve(9 * count + k_padding);
    mesh.triangles.reserve(3 * count);
    std::vector<char> bytes(k_triangle_bytes * std::min(count, k_triangles_per_read));
    for (std::uint64_t first = 0; first < count; first += k_triangles_per_read) {
        throw_if_stopped();
        const std::uint64_t triangles = std::min(count - first, k_triangles_per_read);
        if (!in.read(bytes.data(), static_cast<std::streamsize>(k_triangle_bytes * triangles)))
            throw IoError(name + ": cannot be read");
        mesh.positions.resize(9 * (first + triangles));
        for (std::uint64_t t = 0; t < triangles; ++t) {
            std::memcpy(&mesh.positions[9 * (first + t)],
                        &bytes[k_triangle_bytes * t + k_normal_bytes], k_vertices_bytes);
            append_triangle(mesh);
        }
    }
    return mesh;
}

class StlText {
  public:
    explicit StlText(std::string name) : name_(std::move(name)) {}

    TriangleMesh read(std::istream& in) {
        for (std::string text; std::getline(in, text);) {
            ++line_;
            read(TextLine(text));
        }
        if (in.bad()) throw IoError(name_ + ": cannot be read");
        if (corners_ > 0)
            throw InputError(name_ + ": the STL text ends within a facet; the file is truncated");
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(std::string_view found, const char* what) const {
        throw InputError(fmt::format("{}:{}: '{}' is not {}; export the mesh again", name_, line_,
                                     printable(found), what));
    }

    /// Its words, wherever lines are broken.
    void read(TextLine line) {
        while (!line.is_at_end()) {
            throw_if_stopped();
            const std::string_view word = line.word();
            const auto is = [&](std::string_view keyword) {
                return same_ignoring_case(word, keyword);
            };
            if (is("vertex")) {
                read_vertex(line);
            } else if (is("endloop")) {
                end_facet();
            } else if (is("normal")) {
                for (int axis = 0; axis < 3; ++axis) line.word();
            } else if (is("solid") || is("endsolid")) {
                return;  // and a name
            } else if (!is("facet") && !is("outer") && !is("loop") && !is("endfacet")) {
                fail(word, "a word of STL");
            }
        }
    }

    void read_vertex(TextLine& line) {
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = line.word();
            const std::optional<float> value = mesh_number(word);
            if (!value) fail(word, "a number");
            mesh_.positions.push_back(*value);
        }
        ++corners_;
    }

    void end_facet() {
        if (corners_ != 3)
            throw InputError(
                fmt::format("{}:{}: a facet of {} vertices instead of three; export "
                            "the mesh again",
                            name_, line_, corners_));
        corners_ = 0;
        append_triangle(mesh_);
        if (mesh_.positions.size() > 9 * k_max_triangles) refuse_size(name_);
    }

    std::string name_;
    std::uint64_t line_ = 0;
    std::uint64_t corners_ = 0;  // of the facet so far
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::ifstream in = open_input(file, name, "mesh");
    Beginning beginning{.file_size = std::filesystem::file_size(file)};
    in.read(beginning.bytes.data(), static_cast<std::streamsize>(beginning.bytes.size()));
    TriangleMesh mesh;
    if (beginning.is_text()) {
        in.clear();
        in.seekg(0);
        mesh = StlText(name).read(in);
    } else if (beginning.is_header()) {
        mesh = read_binary(in, beginning, name);
    } else {
        throw InputError(name + ": is neither a text nor a binary STL file; export the mesh again");
    }
    mesh.positions.reserve(mesh.positions.size() + k_padding);
    return mesh;
}

}  // namespace uw
