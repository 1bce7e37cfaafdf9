#include "media/vdb/placement.h"

namespace uw {

Placement decide_placement(const VdbHeader& header, const VolumeDesc& desc) {
    const bool blender = header.from_blender_fluid();
    Placement placement{desc.centering, desc.up, desc.centering == Centering::automatic,
                        desc.up == UpAxis::automatic};
    if (placement.automatic_centering)
        placement.centering = blender ? Centering::cell : Centering::node;
    if (placement.automatic_up)
        placement.up = blender || header.from_embergen() ? UpAxis::z : UpAxis::y;
    return placement;
}

Affine upright_from_file(UpAxis up) {
    // Column by column: x stays, the file's y becomes -z, its z becomes y.
    const Affine upright_from_z_up(Matrix3(1, 0, 0, 0, 0, -1, 0, 1, 0), Vector3(0.0));
    return up == UpAxis::z ? upright_from_z_up : Affine();
}

Affine world_from_index(const LoadedGrid& grid, const Placement& placement,
                        const Affine& world_from_upright) {
    return world_from_upright * upright_from_file(placement.up) * grid.file_from_index;
}

}  // namespace uw
