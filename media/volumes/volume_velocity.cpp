#include "media/volumes/volume_velocity.h"

#include <utility>

#include "media/volumes/fluid_domain.h"
#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/velocity_field.h"

namespace uw {

VolumeVelocity::VolumeVelocity(const VolumeDesc& desc) {
    if (desc.array) {
        field_ = std::make_unique<VelocityField>(*desc.motion, Centering::node);
        world_from_file_ = desc.world_from_upright;
    } else {
        // The file's own axes and size are those of its first grid before `voxel_size` changes it.
        const VdbHeader header = read_vdb_header(desc.file, desc.where);
        const Placement placement = decide_placement(header, desc);
        const GridMappingDesc& mapping = desc.grids.front();
        const Affine file_from_index =
            read_file_from_index(header, mapping.grid, mapping.where, desc.level_sets);
        LoadedGrid grid;
        grid.file_from_index = with_voxel_size(file_from_index, desc, find_fluid_domain(header));
        world_from_file_ =
            world_from_index(grid, placement, desc.world_from_upright) * file_from_index.inverse();
        field_ = std::make_unique<VelocityField>(*desc.motion, placement.centering);
    }
    file_from_world_ = world_from_file_.inverse();
}

VolumeVelocity::~VolumeVelocity() = default;
VolumeVelocity::VolumeVelocity(VolumeVelocity&& other) noexcept = default;
VolumeVelocity& VolumeVelocity::operator=(VolumeVelocity&& other) noexcept = default;

Vector3 VolumeVelocity::at(const Point3& x) const {
    const Point3 in_file = file_from_world_ * x;
    const openvdb::Vec3d v =
        VelocityField::Sampler(*field_)(openvdb::Vec3d(in_file.x, in_file.y, in_file.z));
    return world_from_file_.apply_to_vector(Vector3(v.x(), v.y(), v.z()));
}

}  // namespace uw
