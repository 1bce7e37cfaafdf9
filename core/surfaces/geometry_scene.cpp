#include "core/surfaces/geometry_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/meshes/files/mesh_reader.h"
#include "core/meshes/mesh_cleanup.h"
#include "core/scene/scene_limits.h"
#include "core/surfaces/embree_surfaces.h"
#include "core/surfaces/scene_objects.h"

namespace uw {
namespace {

constexpr double k_default_reflectance = 0.5;
constexpr std::size_t k_max_objects = (std::size_t{1} << 24) - 1;  // whole numbers of a float

/// The reflectance given in the scene, if any.
std::optional<Spectrum> given_reflectance(const GeometryDesc& desc, int band_count) {
    if (!desc.reflectance) return std::nullopt;
    if (desc.reflectance->size() != static_cast<std::size_t>(band_count)) {
        throw InputError(fmt::format("{}: reflectance has {} values; give {}, one per band",
                                     desc.where, desc.reflectance->size(), band_count));
    }
    Spectrum spectrum{};
    std::copy(desc.reflectance->begin(), desc.reflectance->end(), spectrum.begin());
    return spectrum;
}

Spectrum reflectance_or_default(const GeometryDesc& desc, int band_count) {
    if (const auto given = given_reflectance(desc, band_count)) return *given;
    Spectrum spectrum{};
    std::fill_n(spectrum.begin(), band_count, k_default_reflectance);
    return spectrum;
}

bool is_identity(const Affine& map) {
    return map.linear() == Matrix3(1.0) && map.offset() == Vector3(0.0);
}

/// Transforms a mesh to world space, in place: it may have tens of millions of vertices.
void transform(TriangleMesh& mesh, const Affine& world_from_object) {
    for (std::size_t at = 0; at + 2 < mesh.positions.size(); at += 3) {
        float* p = &mesh.positions[at];
        const Point3 world = world_from_object * Point3{p[0], p[1], p[2]};
        for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(world[axis]);
    }
    const Matrix3 normal_map = glm::transpose(world_from_object.inverse().linear());
    for (std::size_t at = 0; at + 2 < mesh.normals.size(); at += 3) {
        float* n = &mesh.normals[at];
        const Vector3 world = normal_map * Vector3(n[0], n[1], n[2]);
        const double length = glm::length(world);
        if (!(length > 0)) continue;  // zero means "flat"
        for (int axis = 0; axis < 3; ++axis) n[axis] = static_cast<float>(world[axis] / length);
    }
    if (mesh.tangents.empty()) return;
    // A mirroring transform reverses the corner order and cross products.
    const bool is_mirror = world_from_object.determinant() < 0;
    const float side = is_mirror ? -1.0F : 1.0F;
    for (std::size_t at = 0; is_mirror && at + 2 < mesh.triangles.size(); at += 3) {
        std::swap(mesh.triangles[at + 1], mesh.triangles[at + 2]);
    }
    for (std::size_t at = 0; at + 3 < mesh.tangents.size(); at += 4) {
        float* t = &mesh.tangents[at];
        const Vector3 world = world_from_object.apply_to_vector({t[0], t[1], t[2]});
        const double length = glm::length(world);
        for (int axis = 0; axis < 3; ++axis) {
            t[axis] = length > 0 ? static_cast<float>(world[axis] / length) : 0.0F;
        }
        t[3] *= side;
    }
}

/// Bounds of the referenced vertices; a file may have invalid vertices that no triangle uses.
Bounds bounds_of(const TriangleMesh& mesh) {
    Bounds bounds;
    for (const std::uint32_t vertex : mesh.triangles) {
        const float* p = &mesh.positions[3 * std::size_t{vertex}];
        bounds.extend(Point3{p[0], p[1], p[2]});
    }
    return bounds;
}

/// A box around the transformed box; empty for an empty one.
Bounds transformed(const Bounds& bounds, const Affine& map) {
    Bounds result;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const bool high = (corner >> static_cast<unsigned>(axis) & 1U) != 0;
            p[axis] = high ? bounds.max[axis] : bounds.min[axis];
        }
        result.extend(map * p);
    }
    return result;
}

/// Whether a material has more than the colour that a given reflectance replaces.
bool has_more_than_color(const MeshMaterial& material) {
    return material.alpha_cutoff > 0 || material.normal_map || material.emission != Rgb{0, 0, 0};
}

TriangleMesh box_mesh(const GeometryDesc& desc) {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        for (int axis = 0; axis < 3; ++axis) {
            const bool high = ((corner >> axis) & 1) != 0;
            mesh.positions.push_back(static_cast<float>(high ? desc.max[axis] : desc.min[axis]));
        }
    }
    mesh.triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                      2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return mesh;
}

class Builder {
  public:
    explicit Builder(const std::vector<double>& wavelengths_nm)
        : objects_{{}, {}, {}, {}, {}, {}, ReflectanceBands(wavelengths_nm), {}} {}

    /// The next entry of `geometry`.
    void add(const GeometryDesc& desc, std::vector<std::string>& warnings) {
        const double determinant = desc.world_from_object.determinant();
        if (determinant == 0 || !std::isfinite(determinant)) {
            throw InputError(
                fmt::format("{}: the transform flattens the object; give a scale "
                            "other than 0",
                            desc.where));
        }
        switch (desc.type) {
            case GeometryDesc::Type::file:
                add_file(desc, mesh_file(desc, warnings));
                break;
            case GeometryDesc::Type::box:
                add_mesh(desc, box_mesh(desc), name_object(desc, "box"), reflectance(desc));
                break;
            case GeometryDesc::Type::sphere:
                add_sphere(desc, name_object(desc, "sphere"));
                break;
            case GeometryDesc::Type::plane:
                add_plane(desc, name_object(desc, "plane"));
                break;
        }
        ++entry_;
    }

    SceneObjects take() { return std::move(objects_); }

  private:
    Spectrum reflectance(const GeometryDesc& desc) const {
        return reflectance_or_default(desc, objects_.bands.count());
    }

    static MeshFile mesh_file(const GeometryDesc& desc, std::vector<std::string>& warnings) {
        if (desc.mesh) return {*desc.mesh, {}, {desc.mesh_name}, {}};
        return read_mesh(desc.file, warnings,
                         {desc.import.camera || desc.import.any_lamps(), desc.is_pbr,
                          desc.is_material_given, desc.time});
    }

    /// Returns the object's id.
    std::uint32_t name_object(const GeometryDesc& desc, std::string name) {
        auto& objects = objects_.names.objects;
        if (objects.size() == k_max_objects) {
            throw InputError(fmt::format(
                "{}: more than 16 million objects, which the layer id cannot tell apart; join "
                "some into one mesh",
                desc.where));
        }
        objects.push_back({std::move(name), entry_});
        return static_cast<std::uint32_t>(objects.size());
    }

    void add_file(const GeometryDesc& desc, MeshFile file) {
        const auto objects_end = static_cast<std::uint32_t>(objects_.names.objects.size());
        const auto materials_end = static_cast<std::uint32_t>(objects_.names.materials.size());
        for (std::string& name : file.objects) name_object(desc, std::move(name));
        for (std::string& name : file.materials)
            objects_.names.materials.push_back({std::move(name), entry_});
        const auto reflectance = given_reflectance(desc, objects_.bands.count());
        if (!file.mesh.triangles.empty()) {
            add_mesh(desc, std::move(file.mesh), objects_end + 1, reflectance).materials_end =
                materials_end;
        }
        for (SharedMesh& shared : file.shared) {
            const Bounds bounds = bounds_of(shared.mesh);
            auto object = make_mesh_object(desc, std::move(shared.mesh), reflectance);
            object->materials_end = materials_end;
            for (const SharedMesh::Placement& placement : shared.placements) {
                const Affine map = desc.world_from_object * placement.file_from_mesh;
                extend_bounds(desc, transformed(bounds, map));
                objects_.instances.push_back(
                    {object.get(), MeshTransform(map), objects_end + 1 + placement.object});
            }
            objects_.shared_meshes.push_back(std::move(object));
        }
    }

    void extend_bounds(const GeometryDesc& desc, const Bounds& bounds) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(bounds.min[axis] >= -k_largest_coordinate &&
                  bounds.max[axis] <= k_largest_coordinate)) {
                throw InputError(fmt::format("{}: extends beyond {:g} m; check its transform",
                                             desc.where, k_largest_coordinate));
            }
        }
        objects_.bounds.extend(bounds);
    }

    static std::unique_ptr<MeshObject> make_mesh_object(
        const GeometryDesc& desc, TriangleMesh mesh, const std::optional<Spectrum>& reflectance) {
        auto object = std::make_unique<MeshObject>();
        object->mesh = std::move(mesh);
        object->reflectance = reflectance;
        object->is_pbr = desc.is_pbr;
        object->vertex_count = object->mesh.vertex_count();
        auto& materials = object->mesh.materials;
        object->has_holes = std::ranges::any_of(
            materials, [](const MeshMaterial& material) { return material.alpha_cutoff > 0; });
        if (reflectance && !desc.is_pbr && std::ranges::none_of(materials, has_more_than_color)) {
            object->mesh.uvs = {};
            object->mesh.colors = {};
            for (MeshMaterial& material : materials) material.base_map = {};
        }
        object->mesh.positions.resize(object->mesh.positions.size() + 4);  // Embree's padding
        return object;
    }

    MeshObject& add_mesh(const GeometryDesc& desc, TriangleMesh mesh, std::uint32_t object_id,
                         const std::optional<Spectrum>& reflectance) {
        if (!is_identity(desc.world_from_object)) transform(mesh, desc.world_from_object);
        extend_bounds(desc, bounds_of(mesh));
        objects_.meshes.push_back(make_mesh_object(desc, std::move(mesh), reflectance));
        objects_.meshes.back()->object_id = object_id;
        return *objects_.meshes.back();
    }

    void add_sphere(const GeometryDesc& desc, std::uint32_t object_id) {
        const SphereObject sphere{desc.world_from_object,
                                  desc.world_from_object.inverse(),
                                  desc.center,
                                  desc.radius,
                                  object_id,
                                  reflectance(desc)};
        extend_bounds(desc, sphere.world_bounds());
        objects_.spheres.push_back(sphere);
    }

    void add_plane(const GeometryDesc& desc, std::uint32_t object_id) {
        objects_.planes.push_back({desc.world_from_object * desc.point,
                                   desc.world_from_object.apply_to_normal(desc.normal), object_id,
                                   reflectance(desc)});
    }

    SceneObjects objects_;
    std::size_t entry_ = 0;  // of `geometry`
};

}  // namespace

std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings) {
    Builder builder(wavelengths_nm);
    for (const GeometryDesc& desc : geometry) builder.add(desc, warnings);
    return make_embree_surfaces(builder.take());
}

}  // namespace uw
