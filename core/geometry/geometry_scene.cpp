#include "core/geometry/geometry_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/embree_surfaces.h"
#include "core/geometry/glass.h"
#include "core/geometry/mesh_reader.h"
#include "core/geometry/scene_objects.h"
#include "core/scene/scene_limits.h"

namespace uw {

namespace {

bool is_identity(const Affine& map) {
    return map.linear() == Matrix3(1.0) && map.offset() == Vector3(0.0);
}

/// Whether a material has more than the colour that a given reflectance replaces.
bool has_more_than_color(const MeshMaterial& material) {
    return material.alpha_cutoff > 0 || material.normal_map || material.emission != Rgb{0, 0, 0};
}

/// Transforms a mesh to world space, in place: it may have tens of millions of vertices.
void place_mesh(TriangleMesh& mesh, const Affine& world_from_object) {
    if (is_identity(world_from_object)) return;
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

/// The traced object of a mesh, as described by `desc`; its ids are set later. `reflectance`: the
/// one given in the scene, if any.
std::shared_ptr<MeshObject> make_mesh_object(const GeometryDesc& desc, TriangleMesh mesh,
                                             const std::optional<Spectrum>& reflectance) {
    auto object = std::make_shared<MeshObject>();
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
    object->has_textures = std::ranges::any_of(materials, [](const MeshMaterial& material) {
        return material.base_map || material.emission_map || material.normal_map ||
               material.metallic_roughness_map;
    });
    object->mesh.positions.resize(object->mesh.positions.size() + 4);  // Embree's padding
    return object;
}

/// `desc` without the parts that change as it moves.
GeometryDesc without_pose(const GeometryDesc& desc) {
    GeometryDesc still = desc;
    if (still.trajectory) still.world_from_object = {};
    if (still.animation) still.time.reset();
    return still;
}

GltfUse use_of(const GeometryDesc& desc) {
    return {desc.import.camera || desc.import.any_lamps(), desc.is_pbr, desc.is_material_given,
            desc.time};
}

/// Moves the triangles whose material is of glass to another mesh, which has copies of all
/// vertices.
TriangleMesh take_glass(TriangleMesh& mesh) {
    const auto is_glass = [&](std::size_t triangle) {
        const std::size_t material =
            mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle];
        return mesh.materials[material].glass.has_value();
    };
    TriangleMesh glass;
    const std::size_t count = mesh.triangle_count();
    const auto is_part_of = [&](bool of_glass, const TriangleMesh& from, TriangleMesh& to) {
        to.triangles.clear();
        to.triangle_materials.clear();
        to.triangle_objects.clear();
        for (std::size_t t = 0; t < count; ++t) {
            if (is_glass(t) != of_glass) continue;
            for (std::size_t k = 0; k < 3; ++k) to.triangles.push_back(from.triangles[3 * t + k]);
            if (!from.triangle_materials.empty())
                to.triangle_materials.push_back(from.triangle_materials[t]);
            if (!from.triangle_objects.empty())
                to.triangle_objects.push_back(from.triangle_objects[t]);
        }
    };
    if (std::ranges::none_of(mesh.materials, [](const MeshMaterial& material) {
            return material.glass.has_value();
        }))
        return glass;
    glass = mesh;
    is_part_of(true, mesh, glass);
    TriangleMesh opaque = mesh;
    is_part_of(false, mesh, opaque);
    mesh = std::move(opaque);
    return glass;
}

/// The glass of a file's materials, by their numbers.
void note_glass(const TriangleMesh& mesh, FileSurfaces& surfaces) {
    for (const MeshMaterial& material : mesh.materials) {
        if (!material.glass || material.number == 0) continue;
        surfaces.glass.resize(std::max(surfaces.glass.size(), std::size_t{material.number}));
        surfaces.glass[material.number - 1] = material.glass;
    }
}

std::shared_ptr<const FileSurfaces> surfaces_of(MeshFile file, const GeometryDesc& desc,
                                                const IdsBefore& before,
                                                const std::optional<Spectrum>& reflectance) {
    auto surfaces = std::make_shared<FileSurfaces>();
    // An entry that is of glass as a whole is not divided.
    const auto glass_of = [&](TriangleMesh& mesh) {
        note_glass(mesh, *surfaces);
        return desc.glass ? TriangleMesh() : take_glass(mesh);
    };
    surfaces->objects = std::move(file.objects);
    surfaces->materials = std::move(file.materials);
    if (!file.mesh.triangles.empty()) {
        place_mesh(file.mesh, desc.world_from_object);
        surfaces->bounds = bounds_of(file.mesh);
        TriangleMesh glass = glass_of(file.mesh);
        const auto make = [&](TriangleMesh mesh) -> std::shared_ptr<const MeshObject> {
            if (mesh.triangles.empty()) return nullptr;
            const auto object = make_mesh_object(desc, std::move(mesh), reflectance);
            object->object_id = before.objects + 1;
            object->materials_end = before.materials;
            return object;
        };
        surfaces->mesh = make(std::move(file.mesh));
        surfaces->of_glass = make(std::move(glass));
    }
    for (SharedMesh& shared : file.shared) {
        const Bounds bounds = bounds_of(shared.mesh);
        TriangleMesh glass = glass_of(shared.mesh);
        const auto make = [&](TriangleMesh mesh) -> std::shared_ptr<const MeshObject> {
            if (mesh.triangles.empty()) return nullptr;
            const auto object = make_mesh_object(desc, std::move(mesh), reflectance);
            object->materials_end = before.materials;
            return object;
        };
        auto opaque = make(std::move(shared.mesh));
        surfaces->shared.push_back(
            {std::move(opaque), make(std::move(glass)), bounds, std::move(shared.placements)});
    }
    return surfaces;
}

FileStamps files_of(const GeometryDesc& desc) {
    if (desc.mesh) return {};
    std::vector<std::filesystem::path> files{desc.file};
    for (const std::filesystem::path& named : files_named_by_mesh(desc.file))
        files.push_back(named);
    return FileStamps(files);
}

}  // namespace

FileStamps MeshStore::files() const {
    FileStamps files;
    for (const Kept& kept : kept_)
        if (kept.is_used) files.add(kept.files);
    return files;
}

void MeshStore::keep_only(const std::vector<GeometryDesc>& geometry) {
    std::erase_if(kept_, [&](const Kept& kept) {
        return !kept.is_used || std::ranges::none_of(geometry, [&](const GeometryDesc& desc) {
            return without_pose(desc) == kept.desc;
        });
    });
    for (Kept& kept : kept_) kept.is_used = false;
}

std::shared_ptr<const FileSurfaces> MeshStore::load(const GeometryDesc& desc,
                                                    const IdsBefore& before,
                                                    const std::optional<Spectrum>& reflectance,
                                                    std::vector<std::string>& warnings) {
    const GeometryDesc still = without_pose(desc);
    const auto known = std::ranges::find_if(kept_, [&](const Kept& kept) {
        return kept.desc == still && (kept.file || kept.source || kept.before == before);
    });
    if (known != kept_.end() && known->files.are_current()) {
        known->is_used = true;
        const bool is_same = known->time == desc.time &&
                             (known->file || (known->surfaces && known->before == before));
        if (!is_same) return read(*known, desc, before, reflectance, warnings);
        warnings.insert(warnings.end(), known->warnings.begin(), known->warnings.end());
        if (known->surfaces) return known->surfaces;
        return surfaces_of(*known->file, desc, before, reflectance);
    }
    if (known != kept_.end()) kept_.erase(known);
    Kept kept{still, files_of(desc), nullptr, desc.time, {}, nullptr, nullptr, before, true};
    if (desc.animation && !desc.mesh)
        kept.source = std::make_shared<MeshSource>(desc.file, use_of(desc));
    std::shared_ptr<const FileSurfaces> surfaces = read(kept, desc, before, reflectance, warnings);
    kept_.push_back(std::move(kept));
    return surfaces;
}

std::shared_ptr<const FileSurfaces> MeshStore::read(Kept& kept, const GeometryDesc& desc,
                                                    const IdsBefore& before,
                                                    const std::optional<Spectrum>& reflectance,
                                                    std::vector<std::string>& warnings) {
    // Freed first, so that the contents of two times are not in memory at once.
    kept.file.reset();
    kept.surfaces.reset();
    kept.warnings.clear();
    kept.time = desc.time;
    kept.before = before;
    MeshFile file;
    if (desc.mesh)
        file = {*desc.mesh, {}, {desc.mesh_name}, {}};
    else if (kept.source)
        file = kept.source->read(desc.time, kept.warnings);
    else
        file = read_mesh(desc.file, kept.warnings, use_of(desc));
    warnings.insert(warnings.end(), kept.warnings.begin(), kept.warnings.end());
    if (desc.trajectory) {
        kept.file = std::make_shared<const MeshFile>(std::move(file));
        return surfaces_of(*kept.file, desc, before, reflectance);
    }
    return kept.surfaces = surfaces_of(std::move(file), desc, before, reflectance);
}

namespace {

constexpr std::uint64_t k_max_probes = 1 << 16;

// How many times triangles may cover a cube's face. A lawn of 10^5 blades of grass to a square
// metre comes to a hundredth of it.
constexpr double k_max_coverage = 4096;

// Fewer sampled triangles than this are not enough to judge a cube.
constexpr std::size_t k_min_samples = 64;

struct Sample {
    std::uint64_t cube = 0;  // hashed
    double coverage = 0;     // of the cube's face
    std::uint32_t mesh = 0;  // SceneObjects::placed
    std::uint32_t triangle = 0;
};

using Corners = std::array<Point3, 3>;

Corners corners_of(const PlacedMesh& mesh, std::uint32_t triangle) {
    return {mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)};
}

/// Its centre, in the cube of up to twice its size.
Sample sample_of(const Corners& corners) {
    Bounds bounds;
    for (const Point3& corner : corners) bounds.extend(corner);
    const Vector3 size = bounds.max - bounds.min;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0)) return {};
    const int level = std::ilogb(longest) + 1;
    const double edge = std::ldexp(1.0, level);
    const Point3 center = bounds.center();
    auto cube = static_cast<std::uint64_t>(level);
    for (int axis = 0; axis < 3; ++axis) {
        constexpr std::uint64_t k_odd = 0x9e3779b97f4a7c15;
        const double place = std::floor(center[axis] / edge) + 0.0;  // not -0
        cube = std::rotl((cube ^ std::bit_cast<std::uint64_t>(place)) * k_odd, 29);
    }
    const double area =
        0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return {cube, area / (edge * edge), 0, 0};
}

/// Samples one of every `stride` triangles, at a varying position, since objects repeat.
std::vector<Sample> samples_of(const SceneObjects& objects, std::uint64_t stride) {
    std::vector<Sample> samples;
    samples.reserve(k_max_probes);
    const auto next = [&] {
        constexpr double k_golden = 0.6180339887498949;
        const double turns = static_cast<double>(samples.size()) * k_golden;
        const auto offset =
            static_cast<std::uint64_t>((turns - std::floor(turns)) * static_cast<double>(stride));
        return samples.size() * stride + offset;
    };
    std::uint64_t begin = 0;  // how many triangles are before those of the mesh
    for (std::size_t number = 0; number < objects.placed_count(); ++number) {
        const PlacedMesh mesh = objects.placed(number);
        const std::uint64_t end = begin + mesh.object.mesh.triangle_count();
        while (next() < end) {
            const auto triangle = static_cast<std::uint32_t>(next() - begin);
            Sample sample = sample_of(corners_of(mesh, triangle));
            sample.mesh = static_cast<std::uint32_t>(number);
            sample.triangle = triangle;
            samples.push_back(sample);
        }
        begin = end;
    }
    return samples;
}

}  // namespace

std::optional<TriangleOverlap> find_overlap(const SceneObjects& objects) {
    std::uint64_t triangles = 0;
    for (std::size_t number = 0; number < objects.placed_count(); ++number)
        triangles += objects.placed(number).object.mesh.triangle_count();
    if (static_cast<double>(triangles) < k_max_coverage) return std::nullopt;
    const std::uint64_t stride = triangles / k_max_probes + 1;
    std::vector<Sample> samples = samples_of(objects, stride);
    std::ranges::sort(samples, {}, &Sample::cube);
    for (auto begin = samples.begin(); begin != samples.end();) {
        double coverage = 0;
        auto end = begin;
        for (; end != samples.end() && end->cube == begin->cube; ++end) coverage += end->coverage;
        const auto count = static_cast<std::size_t>(end - begin);
        if (count >= k_min_samples && coverage * static_cast<double>(stride) > k_max_coverage) {
            const PlacedMesh mesh = objects.placed(begin->mesh);
            return TriangleOverlap{static_cast<double>(count * stride),
                                   mesh.corner(begin->triangle, 0),
                                   mesh.object_id(begin->triangle)};
        }
        begin = end;
    }
    return std::nullopt;
}

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
        geometry[object.entry.value()].where, at.x, at.y, at.z, object.name, overlap->triangles));
}

class Builder {
  public:
    Builder(const std::vector<double>& wavelengths_nm, MeshStore& meshes)
        : objects_{{}, {}, {}, {}, {}, {}, ReflectanceBands(wavelengths_nm), {}},
          of_glass_{{}, {}, {}, {}, {}, {}, ReflectanceBands(wavelengths_nm), {}},
          meshes_(meshes) {}

    /// The next entry of `geometry`.
    void add(const GeometryDesc& desc, std::vector<std::string>& warnings) {
        const double determinant = desc.world_from_object.determinant();
        if (determinant == 0 || !std::isfinite(determinant)) {
            throw InputError(
                fmt::format("{}: the transform flattens the object; give a scale "
                            "other than 0",
                            desc.where));
        }
        const std::size_t first = objects_.names.objects.size() + 1;
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
        if (!desc.glass) return;
        glass_.materials.push_back(material_of(*desc.glass));
        glass_.of_object.resize(objects_.names.objects.size() + 1);
        std::fill(glass_.of_object.begin() + static_cast<std::ptrdiff_t>(first),
                  glass_.of_object.end(), static_cast<std::uint32_t>(glass_.materials.size()));
    }

    bool has_glass() const { return !glass_.materials.empty(); }
    const SceneObjects& objects() const { return objects_; }
    SceneObjects take() { return std::move(objects_); }
    /// Those of glass.
    SceneObjects take_of_glass() {
        of_glass_.names = objects_.names;
        return std::move(of_glass_);
    }
    GlassTable take_glass_table() { return std::move(glass_); }

  private:
    Spectrum reflectance(const GeometryDesc& desc) const {
        return reflectance_or_default(desc, objects_.bands.count());
    }

    /// Where the surfaces of an entry are put.
    SceneObjects& objects_for(const GeometryDesc& desc) {
        return desc.glass ? of_glass_ : objects_;
    }

    static GlassMaterial material_of(const GlassDesc& desc) {
        GlassMaterial material{desc.n, desc.is_thin, desc.thickness, {}};
        std::ranges::copy(desc.absorption, material.absorption.begin());
        return material;
    }

    /// Adds the materials of glass of a file, whose materials are numbered after `before`.
    void add_glass(const FileSurfaces& file, std::uint32_t before) {
        for (std::size_t i = 0; i < file.glass.size(); ++i) {
            if (!file.glass[i]) continue;
            const FileGlass& glass = *file.glass[i];
            glass_.materials.push_back({glass.n, glass.is_thin, glass.thickness,
                                        objects_.bands.from_rgb(glass.absorption)});
            glass_.of_material.resize(std::max(glass_.of_material.size(), before + i + 2));
            glass_.of_material[before + i + 1] =
                static_cast<std::uint32_t>(glass_.materials.size());
        }
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
        SceneObjects& objects = objects_for(desc);
        if (!desc.glass) add_glass(*file, before.materials);
        if (file->mesh) {
            extend_bounds(desc, file->bounds, objects);
            objects.meshes.push_back(file->mesh);
        }
        if (file->of_glass) {
            extend_bounds(desc, file->bounds, of_glass_);
            of_glass_.meshes.push_back(file->of_glass);
        }
        for (const FileSurfaces::Shared& shared : file->shared) {
            for (const SharedMesh::Placement& placement : shared.placements) {
                const Affine map = desc.world_from_object * placement.file_from_mesh;
                const auto place = [&](const std::shared_ptr<const MeshObject>& object,
                                       SceneObjects& among) {
                    if (!object) return;
                    extend_bounds(desc, transformed(shared.bounds, map), among);
                    among.instances.push_back(
                        {object.get(), MeshTransform(map), before.objects + 1 + placement.object});
                };
                place(shared.object, objects);
                place(shared.of_glass, of_glass_);
            }
            if (shared.object) objects.shared_meshes.push_back(shared.object);
            if (shared.of_glass) of_glass_.shared_meshes.push_back(shared.of_glass);
        }
    }

    static void extend_bounds(const GeometryDesc& desc, const Bounds& bounds,
                              SceneObjects& objects) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(bounds.min[axis] >= -k_max_coordinate && bounds.max[axis] <= k_max_coordinate)) {
                throw InputError(fmt::format("{}: extends beyond {:g} m; check its transform",
                                             desc.where, k_max_coordinate));
            }
        }
        objects.bounds.extend(bounds);
    }

    void add_box(const GeometryDesc& desc, std::uint32_t object_id) {
        TriangleMesh mesh = box_mesh(desc);
        place_mesh(mesh, desc.world_from_object);
        extend_bounds(desc, bounds_of(mesh), objects_for(desc));
        const auto object = make_mesh_object(desc, std::move(mesh), reflectance(desc));
        object->object_id = object_id;
        objects_for(desc).meshes.push_back(object);
    }

    void add_sphere(const GeometryDesc& desc, std::uint32_t object_id) {
        const SphereObject sphere{desc.world_from_object,
                                  desc.world_from_object.inverse(),
                                  desc.center,
                                  desc.radius,
                                  object_id,
                                  reflectance(desc)};
        extend_bounds(desc, sphere.world_bounds(), objects_for(desc));
        objects_for(desc).spheres.push_back(sphere);
    }

    void add_plane(const GeometryDesc& desc, std::uint32_t object_id) {
        if (desc.glass) glass_.has_planes = true;
        objects_for(desc).planes.push_back({desc.world_from_object * desc.point,
                                            desc.world_from_object.apply_to_normal(desc.normal),
                                            object_id, reflectance(desc)});
    }

    SceneObjects objects_, of_glass_;
    GlassTable glass_;
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
    refuse_overlap(builder.objects(), geometry);
    if (!builder.has_glass()) return make_embree_surfaces(builder.take());
    SceneObjects of_glass = builder.take_of_glass();
    refuse_overlap(of_glass, geometry);
    return std::make_unique<GlassSurfaces>(make_embree_surfaces(builder.take()),
                                           make_embree_surfaces(std::move(of_glass)),
                                           builder.take_glass_table());
}

std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings) {
    MeshStore meshes;
    return build_surfaces(geometry, wavelengths_nm, warnings, meshes);
}
}  // namespace uw
