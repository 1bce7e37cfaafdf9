#include "media/volumes/voxel_size.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"

namespace uw {

Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc,
                       const std::optional<AdaptiveDomain>& domain) {
    std::optional<double> voxel = desc.voxel_size;
    if (!voxel && domain) voxel = domain->voxel;
    if (!voxel) return file_from_index;
    const Matrix3& m = file_from_index.linear();
    const Vector3 edges(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
    constexpr double k_rounding = 1e-4;
    for (int axis = 1; axis < 3; ++axis)
        if (!(std::abs(edges[axis] - edges[0]) <= k_rounding * edges[0]))
            throw InputError(fmt::format(
                "{}: voxel_size: is for voxels that are cubes; those of '{}' have edges of {:g}, "
                "{:g} and {:g} m: use transform.scale",
                desc.where, desc.file.string(), edges.x, edges.y, edges.z));
    const Affine place = Affine::translation(domain ? domain->first : Vector3(0));
    return Affine::scale(Vector3(*voxel / edges[0])) * file_from_index * place;
}

}  // namespace uw
