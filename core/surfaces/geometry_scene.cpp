#include "core/surfaces/geometry_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/scene/scene_limits.h"
#include "core/surfaces/embree_surfaces.h"
#include "core/surfaces/mesh_objects.h"
#include "core/surfaces/scene_objects.h"
#include "core/surfaces/triangle_overlap.h"

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

void refuse_overlap(const SceneObjects& objects, const std::vector<GeometryDesc>& geometry) {
    const std::optional<TriangleOverlap> overlap = find_overlap(objects);
    if (!overlap) return;
    const SurfaceName& object = objects.names.objects[overlap->object_id - 1];
    const Point3& at = overlap->where;
    throw InputError(fmt::format(
        "{}: near ({:.4g}, {:.4g}, {:.4g}) m, at the object '{}', some {:.2g} triangles lie over "
        "one another, and every ray there would meet all of them; remove what is in the same place",
        geometry[object.entry].where, at.x, at.y, at.z, object.name, overlap->triangles));
}

class Builder {
  public:
    Builder(const std::vector<double>& wavelengths_nm, MeshStore& meshes)
        : objects_{{}, {}, {}, {}, {}, {}, ReflectanceBands(wavelengths_nm), {}}, meshes_(meshes) {}

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
                add_file(desc, warnings);
                break;
            case GeometryDesc::Type::box:
                add_box(desc, name_object(desc, "box"));
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

    void add_file(const GeometryDesc& desc, std::vector<std::string>& warnings) {
        const auto counted = [](const auto& names) {
            return static_cast<std::uint32_t>(names.size());
        };
        const IdsBefore before{counted(objects_.names.objects), counted(objects_.names.materials)};
        const auto file =
            meshes_.load(desc, before, given_reflectance(desc, objects_.bands.count()), warnings);
        for (const std::string& name : file->objects) name_object(desc, name);
        for (const std::string& name : file->materials)
            objects_.names.materials.push_back({name, entry_});
        if (file->mesh) {
            extend_bounds(desc, file->bounds);
            objects_.meshes.push_back(file->mesh);
        }
        for (const FileSurfaces::Shared& shared : file->shared) {
            for (const SharedMesh::Placement& placement : shared.placements) {
                const Affine map = desc.world_from_object * placement.file_from_mesh;
                extend_bounds(desc, transformed(shared.bounds, map));
                objects_.instances.push_back({shared.object.get(), MeshTransform(map),
                                              before.objects + 1 + placement.object});
            }
            objects_.shared_meshes.push_back(shared.object);
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

    void add_box(const GeometryDesc& desc, std::uint32_t object_id) {
        TriangleMesh mesh = box_mesh(desc);
        place_mesh(mesh, desc.world_from_object);
        extend_bounds(desc, bounds_of(mesh));
        const auto object = make_mesh_object(desc, std::move(mesh), reflectance(desc));
        object->object_id = object_id;
        objects_.meshes.push_back(object);
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
    MeshStore& meshes_;
    std::size_t entry_ = 0;  // of `geometry`
};

}  // namespace

std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings, MeshStore& meshes) {
    meshes.keep_only(geometry);
    Builder builder(wavelengths_nm, meshes);
    for (const GeometryDesc& desc : geometry) builder.add(desc, warnings);
    SceneObjects objects = builder.take();
    refuse_overlap(objects, geometry);
    return make_embree_surfaces(std::move(objects));
}

std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings) {
    MeshStore meshes;
    return build_surfaces(geometry, wavelengths_nm, warnings, meshes);
}

}  // namespace uw
