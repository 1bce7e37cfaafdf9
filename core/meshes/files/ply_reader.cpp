#include "core/meshes/files/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/files/input_files.h"
#include "core/meshes/files/ply_header.h"
#include "core/meshes/files/ply_source.h"
#include "core/meshes/polygon.h"

namespace uw {
namespace {

constexpr std::uint32_t k_no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Minimum size in bytes of one entry of `element` in the file.
std::uint64_t least_size(const PlyElement& element, PlyEncoding encoding) {
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
        const std::uint64_t size = least_size(element, header.encoding);
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

/// What one step of a colour is worth; 0 for types that hold none.
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
    remember_input(file);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw IoError(name + ": cannot open the mesh; check the name and its permissions");
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
