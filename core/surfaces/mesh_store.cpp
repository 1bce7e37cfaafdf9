#include "core/surfaces/mesh_store.h"

#include <algorithm>

#include "core/meshes/files/mesh_reader.h"
#include "core/surfaces/mesh_objects.h"

namespace uw {
namespace {

/// `desc` without what changes as it moves.
GeometryDesc without_pose(const GeometryDesc& desc) {
    GeometryDesc still = desc;
    if (still.trajectory) still.world_from_object = {};
    return still;
}

MeshFile mesh_file(const GeometryDesc& desc, std::vector<std::string>& warnings) {
    if (desc.mesh) return {*desc.mesh, {}, {desc.mesh_name}, {}};
    return read_mesh(desc.file, warnings,
                     {desc.import.camera || desc.import.any_lamps(), desc.is_pbr,
                      desc.is_material_given, desc.time});
}

std::shared_ptr<const FileSurfaces> surfaces_of(MeshFile file, const GeometryDesc& desc,
                                                const IdsBefore& before,
                                                const std::optional<Spectrum>& reflectance) {
    auto surfaces = std::make_shared<FileSurfaces>();
    surfaces->objects = std::move(file.objects);
    surfaces->materials = std::move(file.materials);
    if (!file.mesh.triangles.empty()) {
        place_mesh(file.mesh, desc.world_from_object);
        surfaces->bounds = bounds_of(file.mesh);
        const auto object = make_mesh_object(desc, std::move(file.mesh), reflectance);
        object->object_id = before.objects + 1;
        object->materials_end = before.materials;
        surfaces->mesh = object;
    }
    for (SharedMesh& shared : file.shared) {
        const Bounds bounds = bounds_of(shared.mesh);
        const auto object = make_mesh_object(desc, std::move(shared.mesh), reflectance);
        object->materials_end = before.materials;
        surfaces->shared.push_back({object, bounds, std::move(shared.placements)});
    }
    return surfaces;
}

}  // namespace

MeshStore::Stamps MeshStore::stamps_of(const GeometryDesc& desc) {
    if (desc.mesh) return {};
    Stamps stamps{{desc.file, stamp_of(desc.file)}};
    for (const std::filesystem::path& named : files_named_by_mesh(desc.file))
        stamps.emplace_back(named, stamp_of(named));
    return stamps;
}

bool MeshStore::is_unchanged(const Kept& kept) {
    return std::ranges::all_of(kept.stamps,
                               [](const auto& of) { return stamp_of(of.first) == of.second; });
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
        return kept.desc == still && (kept.file || kept.before == before);
    });
    if (known != kept_.end() && is_unchanged(*known)) {
        known->is_used = true;
        warnings.insert(warnings.end(), known->warnings.begin(), known->warnings.end());
        if (known->surfaces) return known->surfaces;
        return surfaces_of(*known->file, desc, before, reflectance);
    }
    if (known != kept_.end()) kept_.erase(known);
    Kept kept{still, stamps_of(desc), {}, nullptr, nullptr, before, true};
    MeshFile file = mesh_file(desc, kept.warnings);
    warnings.insert(warnings.end(), kept.warnings.begin(), kept.warnings.end());
    std::shared_ptr<const FileSurfaces> surfaces;
    if (desc.trajectory) {
        kept.file = std::make_shared<const MeshFile>(std::move(file));
        surfaces = surfaces_of(*kept.file, desc, before, reflectance);
    } else {
        kept.surfaces = surfaces = surfaces_of(std::move(file), desc, before, reflectance);
    }
    kept_.push_back(std::move(kept));
    return surfaces;
}

}  // namespace uw
