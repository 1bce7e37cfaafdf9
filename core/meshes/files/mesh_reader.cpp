#include "core/meshes/files/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <set>

#include "core/base/error.h"
#include "core/meshes/files/obj_materials.h"
#include "core/meshes/files/obj_reader.h"
#include "core/meshes/files/ply_reader.h"
#include "core/meshes/files/stl_reader.h"
#include "core/meshes/gltf/gltf_files.h"
#include "core/meshes/gltf/gltf_reader.h"
#include "core/meshes/mesh_cleanup.h"
#include "core/meshes/mesh_tangents.h"
#include "core/meshes/mesh_values.h"

namespace uw {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

MeshFile read_any(const std::filesystem::path& file, std::vector<std::string>& warnings,
                  const GltfUse& use) {
    const std::string extension = lower_extension(file);
    const std::string name = file.stem().string();
    if (extension == ".ply") return {read_ply(file, warnings), {}, {name}, {}};
    if (extension == ".obj") return read_obj(file, use.pbr, warnings);
    if (extension == ".stl") return {read_stl(file), {}, {name}, {}};
    return read_gltf(file, use, warnings);
}

void check_file(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    const bool known = extension == ".gltf" || extension == ".glb" || extension == ".obj" ||
                       extension == ".ply" || extension == ".stl";
    if (!known) {
        throw InputError(
            fmt::format("{}: unknown mesh format '{}'; use .gltf, .glb, .obj, .ply or .stl",
                        file.string(), extension));
    }
    std::error_code status;
    // A pipe or device under a mesh's name would block the reader.
    if (!std::filesystem::is_regular_file(file, status)) {
        throw IoError(file.string() + ": no such mesh file; check the name");
    }
    if (std::filesystem::file_size(file) == 0) {
        throw InputError(file.string() + ": the mesh file is empty; export it again");
    }
}

// Every ray would meet the triangles of all of them: 3000 nodes that show the same 3000 triangles
// in the same place are nine million in its way.
void drop_coincident_placements(MeshFile& content, const std::string& name,
                                std::vector<std::string>& warnings) {
    std::size_t before = 0, after = 0;
    for (SharedMesh& shared : content.shared) {
        const auto key = [](const SharedMesh::Placement& placement) {
            const Affine& map = placement.file_from_mesh;
            std::array<double, 12> values{};
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 3; ++row)
                    values[static_cast<std::size_t>(3 * column + row)] =
                        column < 3 ? map.linear()[column][row] : map.offset()[row];
            return values;
        };
        before += shared.placements.size();
        std::set<std::array<double, 12>> seen;
        std::erase_if(shared.placements, [&](const SharedMesh::Placement& placement) {
            return !seen.insert(key(placement)).second;
        });
        after += shared.placements.size();
    }
    if (after < before)
        warnings.push_back(
            fmt::format("{}: {} of {} objects that share meshes are in the place of another that "
                        "shows the same mesh; only the first is kept",
                        name, before - after, before));
}

}  // namespace

MeshFile read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                   const GltfUse& use) {
    check_file(file);
    MeshFile content = read_any(file, warnings, use);
    DroppedTriangles dropped;
    ClampedValues clamped;
    const auto make_sane = [&](TriangleMesh& mesh) {
        drop_bad_triangles(mesh, dropped);
        clamp_values(mesh, clamped);
        compute_tangents(mesh);
    };
    make_sane(content.mesh);
    for (SharedMesh& shared : content.shared) make_sane(shared.mesh);
    std::erase_if(content.shared, [](const SharedMesh& shared) {
        return shared.mesh.triangles.empty() || shared.placements.empty();
    });
    drop_coincident_placements(content, file.string(), warnings);
    dropped.report(file.string(), warnings);
    clamped.report(file.string(), warnings);
    if (!content.has_triangles() && !use.camera_or_lamps) {
        throw InputError(file.string() +
                         ": the mesh has no triangles; check what was exported, or take the camera "
                         "or lamps of a glTF file (camera: true, lamps: all)");
    }
    return content;
}

std::vector<std::filesystem::path> files_named_by_mesh(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".gltf" || extension == ".glb") return files_named_by_gltf(file);
    if (extension == ".obj") return files_named_by_obj(file);
    return {};  // STL and PLY refer to no other files
}

}  // namespace uw
