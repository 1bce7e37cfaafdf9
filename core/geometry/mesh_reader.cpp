#include "core/geometry/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <span>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh.h"
#include "core/geometry/obj_reader.h"
#include "core/geometry/ply_reader.h"
#include "core/geometry/stl_reader.h"

namespace uw {

namespace {

Vector3 position(const TriangleMesh& mesh, std::uint32_t vertex) {
    const float* p = &mesh.positions[3 * std::size_t{vertex}];
    return {p[0], p[1], p[2]};
}

bool usable(const Vector3& p) {
    // NaN fails every comparison.
    return std::abs(p.x) <= k_max_mesh_coordinate && std::abs(p.y) <= k_max_mesh_coordinate &&
           std::abs(p.z) <= k_max_mesh_coordinate;
}

/// The counter for a triangle's defect, or null if it has none.
std::uint64_t* fault_of(const TriangleMesh& mesh, std::size_t triangle, DroppedTriangles& dropped) {
    const std::uint32_t* corner = &mesh.triangles[3 * triangle];
    const std::size_t vertices = mesh.vertex_count();
    if (corner[0] >= vertices || corner[1] >= vertices || corner[2] >= vertices) {
        return &dropped.missing_corner;
    }
    const Vector3 a = position(mesh, corner[0]);
    const Vector3 b = position(mesh, corner[1]);
    const Vector3 c = position(mesh, corner[2]);
    if (!usable(a) || !usable(b) || !usable(c)) return &dropped.not_finite;
    return glm::cross(b - a, c - a) == Vector3(0.0) ? &dropped.no_area : nullptr;
}

void flatten_broken_normals(TriangleMesh& mesh) {
    for (std::size_t at = 0; at + 2 < mesh.normals.size(); at += 3) {
        float* n = &mesh.normals[at];
        const double length = glm::length(Vector3(n[0], n[1], n[2]));
        if (length > 1e-6 && length < 1e6) continue;
        n[0] = n[1] = n[2] = 0;
    }
}

}  // namespace

void drop_bad_triangles(TriangleMesh& mesh, DroppedTriangles& dropped) {
    const bool has_materials = !mesh.triangle_materials.empty();
    const bool has_objects = !mesh.triangle_objects.empty();
    std::size_t kept = 0;
    const std::size_t count = mesh.triangle_count();
    for (std::size_t triangle = 0; triangle < count; ++triangle) {
        throw_if_stopped();
        if (std::uint64_t* fault = fault_of(mesh, triangle, dropped)) {
            ++*fault;
            continue;
        }
        if (kept != triangle) {
            for (std::size_t k = 0; k < 3; ++k) {
                mesh.triangles[3 * kept + k] = mesh.triangles[3 * triangle + k];
            }
            if (has_materials) mesh.triangle_materials[kept] = mesh.triangle_materials[triangle];
            if (has_objects) mesh.triangle_objects[kept] = mesh.triangle_objects[triangle];
        }
        ++kept;
    }
    mesh.triangles.resize(3 * kept);
    if (has_materials) mesh.triangle_materials.resize(kept);
    if (has_objects) mesh.triangle_objects.resize(kept);
    flatten_broken_normals(mesh);
}

void DroppedTriangles::report(const std::string& name, std::vector<std::string>& warnings) const {
    const auto line = [&](std::uint64_t count, const char* what) {
        if (count > 0) warnings.push_back(fmt::format("{}: {} {}; dropped", name, count, what));
    };
    line(missing_corner, "triangles refer to vertices that do not exist");
    line(not_finite, "triangles have corners that are NaN, infinite or beyond 1e10");
    line(no_area, "triangles have no area");
}

namespace {

/// `value` within [low, high]; `low` if it is NaN. Notes in `odd` if that is another value.
template <class T>
void bring_within(T& value, double low, double high, bool& odd) {
    const auto was = static_cast<double>(value);
    if (was >= low && was <= high) return;
    value = static_cast<T>(was > low ? high : low);
    odd = true;
}

/// Calls `fix(values, odd)` for the `width` values of each vertex; returns how many vertices were
/// odd.
template <class Fix>
std::uint64_t count_odd(std::vector<float>& values, std::size_t width, const Fix& fix) {
    std::uint64_t count = 0;
    for (std::size_t at = 0; at + width <= values.size(); at += width) {
        bool odd = false;
        fix(std::span(values).subspan(at, width), odd);
        count += odd ? 1 : 0;
    }
    return count;
}

void bring_into_unit(std::span<float> values, bool& odd) {
    constexpr float k_rounding = 1e-4F;  // which needs no warning
    for (float& value : values) {
        if (value > 1 && value <= 1 + k_rounding) value = 1;
        bring_within(value, 0, 1, odd);
    }
}

bool is_beyond(double value, double limit) {
    return !(std::abs(value) <= limit);  // also NaN
}

void clamp_map(TextureUse& use, bool& odd) {
    const auto beyond = [](double value) { return is_beyond(value, k_max_uv); };
    if (std::ranges::none_of(use.transform, beyond)) return;
    use.transform = TextureUse().transform;
    odd = true;
}

void clamp_material(MeshMaterial& material, bool& odd) {
    for (double& part : material.emission) bring_within(part, 0, k_max_emission, odd);
    bring_within(material.normal_scale, -k_max_normal_scale, k_max_normal_scale, odd);
    for (TextureUse* use : {&material.base_map, &material.emission_map, &material.normal_map,
                            &material.metallic_roughness_map})
        clamp_map(*use, odd);
}

}  // namespace

void clamp_values(TriangleMesh& mesh, ClampedValues& clamped) {
    for (std::vector<float>& uvs : mesh.uvs)
        clamped.uvs += count_odd(uvs, 2, [](std::span<float> uv, bool& odd) {
            for (const float value : uv) odd |= is_beyond(static_cast<double>(value), k_max_uv);
            if (odd) std::ranges::fill(uv, 0.0F);
        });
    clamped.colors += count_odd(mesh.colors, 3, bring_into_unit);
    clamped.colors += count_odd(mesh.alphas, 1, bring_into_unit);
    count_odd(mesh.tangents, 4, [](std::span<float> tangent, bool&) {
        if (!std::ranges::all_of(tangent, [](float value) { return std::isfinite(value); }))
            std::ranges::fill(tangent, 0.0F);
    });
    for (MeshMaterial& material : mesh.materials) {
        bool odd = false;
        clamp_material(material, odd);
        clamped.materials += odd ? 1 : 0;
    }
}

void ClampedValues::report(const std::string& name, std::vector<std::string>& warnings) const {
    if (uvs > 0)
        warnings.push_back(
            fmt::format("{}: {} texture coordinates are not finite or beyond {:g}; taken as 0",
                        name, uvs, k_max_uv));
    if (colors > 0)
        warnings.push_back(
            fmt::format("{}: {} vertex colours are outside 0..1; clamped", name, colors));
    if (materials > 0)
        warnings.push_back(
            fmt::format("{}: {} materials have an emission beyond {:g}, a scale of a normal map "
                        "beyond {:g} or a transform of a texture beyond {:g}; clamped",
                        name, materials, k_max_emission, k_max_normal_scale, k_max_uv));
}

namespace {

void check_file(const std::filesystem::path& file) {
    const std::string extension = lower_case(file.extension().string());
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

// Every ray would test the triangles of all of them: 3000 nodes that show the same 3000 triangles
// in the same place make nine million.
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
        std::set<std::array<double, 12>> known;
        std::erase_if(shared.placements, [&](const SharedMesh::Placement& placement) {
            return !known.insert(key(placement)).second;
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

MeshFile MeshSource::read_any(const std::optional<double>& time,
                              std::vector<std::string>& warnings) {
    const std::string extension = lower_case(file_.extension().string());
    const std::string name = file_.stem().string();
    if (extension == ".ply") return {read_ply(file_, warnings), {}, {name}, {}};
    if (extension == ".obj") return read_obj(file_, use_.pbr, warnings);
    if (extension == ".stl") return {read_stl(file_), {}, {name}, {}};
    if (!gltf_) gltf_ = std::make_shared<GltfSource>(file_, use_);
    return gltf_->read(time, warnings);
}

MeshFile MeshSource::read(const std::optional<double>& time, std::vector<std::string>& warnings) {
    check_file(file_);
    MeshFile content = read_any(time, warnings);
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
    drop_coincident_placements(content, file_.string(), warnings);
    dropped.report(file_.string(), warnings);
    clamped.report(file_.string(), warnings);
    if (!content.has_triangles() && !use_.camera_or_lamps) {
        throw InputError(file_.string() +
                         ": the mesh has no triangles; check what was exported, or take the camera "
                         "or lamps of a glTF file (camera: true, lamps: all)");
    }
    return content;
}

MeshFile read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                   const GltfUse& use) {
    return MeshSource(file, use).read(warnings);
}

std::vector<std::filesystem::path> files_named_by_mesh(const std::filesystem::path& file) {
    const std::string extension = lower_case(file.extension().string());
    if (extension == ".gltf" || extension == ".glb") return files_named_by_gltf(file);
    if (extension == ".obj") return files_named_by_obj(file);
    return {};  // STL and PLY refer to no other files
}

}  // namespace uw
