#include "render/object_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/meshes/gltf/gltf_placements.h"

namespace uw {

namespace {

std::optional<Affine> inverse_of(const Affine& map) {
    const double determinant = map.determinant();
    if (determinant == 0 || !std::isfinite(determinant)) return std::nullopt;
    return map.inverse();
}

/// Of the `count` objects of one entry of `geometry`.
ObjectMotions motions_of(const GeometryDesc& now, const GeometryDesc& then, std::size_t count,
                         std::vector<std::string>& warnings) {
    if (now.file != then.file) {
        warnings.push_back(fmt::format(
            "{}: no flow: its files are one for each frame, and do not say which points of one "
            "are which of the next; animate one glTF file instead",
            now.where));
        return ObjectMotions(count, std::nullopt);
    }
    const Affine object_from_world = now.world_from_object.inverse();
    if (!now.animation)
        return ObjectMotions(count, now.world_from_object == then.world_from_object
                                        ? Affine()
                                        : then.world_from_object * object_from_world);
    const std::vector<Affine> before = gltf_placements(now.file, now.time.value_or(0));
    const std::vector<Affine> after = gltf_placements(then.file, then.time.value_or(0));
    ObjectMotions motions(count);
    for (std::size_t i = 0; i < std::min({count, before.size(), after.size()}); ++i) {
        // A node that is scaled to nothing shows no points.
        if (const auto node_from_file = inverse_of(before[i]))
            motions[i] = then.world_from_object * after[i] * *node_from_file * object_from_world;
    }
    return motions;
}

}  // namespace

ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings) {
    if (now.geometry == then.geometry) return {};
    std::vector<std::size_t> counts(now.geometry.size(), 0);
    for (const SurfaceName& object : names.objects) ++counts.at(object.entry);
    ObjectMotions motions;
    for (std::size_t entry = 0; entry < now.geometry.size(); ++entry) {
        const ObjectMotions own =
            motions_of(now.geometry[entry], then.geometry[entry], counts[entry], warnings);
        motions.insert(motions.end(), own.begin(), own.end());
    }
    return motions;
}

}  // namespace uw
