#include "media/volumes/level_set_mesh.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>
#include <limits>

#include "core/base/available_memory.h"
#include "core/base/parallel.h"
#include "core/geometry/mesh_reader.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_stream.h"

namespace uw {

namespace {

// The memory for a voxel that the surface passes, in OpenVDB's lists and in ours [bytes].
constexpr double k_bytes_per_crossing = 160;

openvdb::FloatGrid::Ptr read_level_set(const VdbHeader& header, const GridSummary& grid,
                                       const SourceLocation& where, const std::string& prefix) {
    openvdb::FloatGrid::Ptr values;
    double background = 0;
    read_slabs(header, grid, std::numeric_limits<std::size_t>::max(), where,
               [&](const openvdb::GridBase::Ptr& slab) {
                   background = background_of(*slab);
                   values = to_float(slab);
               });
    const bool can_be_one = grid.grid_class == "level set" || grid.grid_class == "unknown";
    if (!can_be_one || !(background > 0) || !std::isfinite(background))
        throw InputError(
            fmt::format("{}is no level set (its class is '{}', its background {:g}), so that it "
                        "has no surface; "
                        "a fog belongs under volumes",
                        prefix, grid.grid_class, background));
    const auto voxels = static_cast<double>(values->activeVoxelCount());
    require_memory(voxels * k_bytes_per_crossing, prefix + "its surface needs",
                   "resample it to larger voxels");
    return values;
}

/// The gradient of a level set's values by its index coordinates.
class Gradient {
  public:
    explicit Gradient(const openvdb::FloatGrid& values) : accessor_(values.getConstAccessor()) {}

    Vector3 at(const openvdb::Vec3d& index) const {
        constexpr double k_step = 0.5;  // [voxels]
        Vector3 rise(0);
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Vec3d step(0);
            step[axis] = k_step;
            const float up = openvdb::tools::BoxSampler::sample(accessor_, index + step);
            const float down = openvdb::tools::BoxSampler::sample(accessor_, index - step);
            rise[axis] = static_cast<double>(up - down);
        }
        return rise;
    }

  private:
    openvdb::FloatGrid::ConstAccessor accessor_;
};

void append(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t corner : {a, b, c}) mesh.triangles.push_back(corner);
}

/// `upright_from_index`: where the value with the index (i, j, k) lies.
TriangleMesh mesh_of(openvdb::FloatGrid& values, const Affine& upright_from_index) {
    // In index space, whose coordinates are small: points are single precision.
    values.setTransform(openvdb::math::Transform::createLinearTransform(1.0));
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(values, points, triangles, quads);
    throw_if_stopped();
    TriangleMesh mesh;
    const Gradient gradient(values);
    // Normals are covectors.
    const Matrix3 normal_from_index = glm::transpose(upright_from_index.inverse().linear());
    for (const openvdb::Vec3s& point : points) {
        const openvdb::Vec3d index(point);
        const Point3 at = upright_from_index * Point3{index.x(), index.y(), index.z()};
        const Vector3 across = normal_from_index * gradient.at(index);
        const double length = glm::length(across);
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(static_cast<float>(at[axis]));
            // None where the values are flat or not finite.
            const bool has_normal = length > 0 && std::isfinite(length);
            mesh.normals.push_back(has_normal ? static_cast<float>(across[axis] / length) : 0);
        }
    }
    for (const openvdb::Vec4I& q : quads) {
        append(mesh, q[0], q[1], q[2]);
        append(mesh, q[0], q[2], q[3]);
    }
    for (const openvdb::Vec3I& t : triangles) append(mesh, t[0], t[1], t[2]);
    return mesh;
}

}  // namespace

std::shared_ptr<const TriangleMesh> mesh_level_set(const std::filesystem::path& file,
                                                   const LevelSetDesc& desc,
                                                   const SourceLocation& where,
                                                   std::vector<std::string>& warnings) {
    initialize_openvdb();
    const VdbHeader header = read_vdb_header(file, where);
    const GridSummary& grid = select_grid(header, desc.grid, where, LevelSets::fog);
    const std::string prefix = describe_grid_place(header, grid, where);
    VolumeDesc upright;
    upright.up = desc.up;
    const Placement placement = decide_placement(header, upright);
    auto mesh = std::make_shared<TriangleMesh>();
    read_guarded(prefix, [&] {
        const Affine file_from_index = to_affine(*read_transform(header, grid, where));
        const double half = placement.centering == Centering::cell ? 0.5 : 0;
        const openvdb::FloatGrid::Ptr values = read_level_set(header, grid, where, prefix);
        *mesh = mesh_of(*values, upright_from_file(placement.up) * file_from_index *
                                     Affine::translation(Vector3(half)));
    });
    DroppedTriangles dropped;
    drop_bad_triangles(*mesh, dropped);
    dropped.report(file.string(), warnings);
    if (mesh->triangles.empty())
        throw InputError(prefix +
                         "has no surface: its values nowhere change their sign; check what was "
                         "exported");
    return mesh;
}

}  // namespace uw
