#include "media/volumes/vdb_file.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_stream.h"
#include "media/volumes/velocity_field.h"

namespace uw {

Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, LevelSets level_sets) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where, level_sets);
    return read_guarded(describe_grid_place(header, grid, where),
                        [&] { return to_affine(*read_transform(header, grid, where)); });
}

namespace {

constexpr std::size_t k_whole = std::numeric_limits<std::size_t>::max();  // slab

/// The contents of `slab` as concentrations; it is the whole grid if level sets become fog.
openvdb::FloatGrid::Ptr concentrations_of(const openvdb::GridBase::Ptr& slab,
                                          const GridSummary& grid, const std::string& prefix,
                                          LevelSets level_sets, double& background) {
    background = background_of(*slab);
    openvdb::FloatGrid::Ptr values = to_float(slab);
    if (level_sets == LevelSets::refused) return values;
    const bool can_be_one = grid.grid_class == "level set" || grid.grid_class == "unknown";
    if (!can_be_one || !(background > 0) || !std::isfinite(background))
        throw InputError(fmt::format(
            "{}is no level set (its class is '{}', its background {:g}), so that level_set: fog "
            "cannot apply; leave that key out, or give the grid a volume of its own",
            prefix, grid.grid_class, background));
    openvdb::tools::sdfToFogVolume(*values, static_cast<float>(background));
    background = 0;
    return values;
}

}  // namespace

LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes, LevelSets level_sets) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where, level_sets);
    const std::string prefix = describe_grid_place(header, grid, where);
    LoadedGrid loaded;
    loaded.name = grid.name;
    GridIntake intake;
    read_guarded(prefix, [&] {
        const std::size_t bytes = level_sets == LevelSets::fog ? k_whole : slab_bytes;
        read_slabs(header, grid, bytes, where, [&](const openvdb::GridBase::Ptr& slab) {
            loaded.file_from_index = to_affine(slab->transform());
            intake.add(take_slab(
                concentrations_of(slab, grid, prefix, level_sets, loaded.statistics.background),
                loaded.bricks));
        });
    });
    loaded.statistics = intake.statistics(loaded.statistics.background);
    check_loaded(header, grid, prefix, loaded);
    loaded.warnings = intake_warnings(loaded.statistics, prefix);
    return loaded;
}

namespace {

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
// A voxel moves no farther than this from the middle of the exposure to its end [voxels].
constexpr double k_furthest = 64;
// The interpolant is linear within a voxel, so that this many samples give the time average to 1e-3
// of its peak.
constexpr double k_samples_per_voxel = 4;

/// A grid's density averaged over the exposure.
class ShutterAverage {
  public:
    ShutterAverage(const openvdb::FloatGrid& density, const VelocityField& velocity, double shutter,
                   Centering centering)
        : density_(density),
          velocity_(velocity),
          shutter_(shutter),
          shift_(centering == Centering::cell ? 0.5 : 0.0) {}

    /// The average within the block at `origin`; null if it is zero.
    std::unique_ptr<FloatLeaf> block(const openvdb::Coord& origin) const {
        const VelocityField::Sampler velocity(velocity_);
        const auto density = density_.getConstAccessor();
        auto leaf = std::make_unique<FloatLeaf>(origin, 0.0F);
        for (openvdb::Index n = 0; n < FloatLeaf::SIZE; ++n) {
            const double value = average(leaf->offsetToGlobalCoord(n), velocity, density);
            if (value > 0) leaf->setValueOn(n, static_cast<float>(value));
        }
        if (leaf->isEmpty()) leaf.reset();
        return leaf;
    }

  private:
    openvdb::Vec3d centre_of_voxel(const openvdb::Vec3d& lattice) const {
        return density_.transform().indexToWorld(lattice + openvdb::Vec3d(shift_));
    }
    openvdb::Vec3d lattice_of(const openvdb::Vec3d& place) const {
        return density_.transform().worldToIndex(place) - openvdb::Vec3d(shift_);
    }

    double average(const openvdb::Coord& voxel, const VelocityField::Sampler& velocity,
                   const openvdb::FloatGrid::ConstAccessor& density) const {
        const openvdb::Vec3d lattice = voxel.asVec3d();
        const openvdb::Vec3d x = centre_of_voxel(lattice);
        const openvdb::Vec3d v = velocity(x);
        const openvdb::Vec3d displacement = lattice_of(x + shutter_ * v) - lattice;
        const double voxels = std::max(
            {std::abs(displacement.x()), std::abs(displacement.y()), std::abs(displacement.z())});
        const int count = 1 + static_cast<int>(std::min(k_samples_per_voxel * voxels,
                                                        2 * k_furthest * k_samples_per_voxel));
        double sum = 0;
        for (int n = 0; n < count; ++n) {
            const double t = shutter_ * ((n + 0.5) / count - 0.5);
            const openvdb::Vec3d half_way = velocity(x - 0.5 * t * v);
            sum += static_cast<double>(
                openvdb::tools::BoxSampler::sample(density, lattice_of(x - t * half_way)));
        }
        return sum / count;
    }

    const openvdb::FloatGrid& density_;
    const VelocityField& velocity_;
    double shutter_, shift_;
};

/// The blocks to which `density` may move within `displacement` voxels; ascending.
std::vector<openvdb::Coord> blocks_within(const openvdb::FloatGrid& density,
                                          const openvdb::Vec3d& displacement) {
    const auto furthest = [&](int axis) {
        return static_cast<int>(std::ceil(displacement[axis])) + 1;
    };
    const openvdb::Coord margin(furthest(0), furthest(1), furthest(2));
    std::set<openvdb::Coord> blocks;
    constexpr int mask = ~(k_leaf_edge - 1);
    for (auto leaf = density.tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord low = (leaf->origin() - margin) & mask;
        const openvdb::Coord high = leaf->origin().offsetBy(k_leaf_edge - 1) + margin;
        for (int i = low.x(); i <= high.x(); i += k_leaf_edge)
            for (int j = low.y(); j <= high.y(); j += k_leaf_edge)
                for (int k = low.z(); k <= high.z(); k += k_leaf_edge) blocks.insert({i, j, k});
    }
    return {blocks.begin(), blocks.end()};
}

/// The fraction of the light that the velocity stimulates at `x`, in the file's axes.
double stimulated_fraction(const StimulatedLight& light, const VelocityField::Sampler& velocity,
                           const openvdb::Vec3d& x) {
    using Quantity = EmissionDesc::Stimulus::Quantity;
    double amount = 0;
    if (light.stimulus.quantity == Quantity::speed) {
        const openvdb::Vec3d v = velocity(x);
        amount = glm::length(light.world_from_file * Vector3(v.x(), v.y(), v.z()));
    } else {
        const Matrix3 gradient =
            light.world_from_file * velocity.gradient(x) * glm::inverse(light.world_from_file);
        const double trace = gradient[0][0] + gradient[1][1] + gradient[2][2];
        double squares = 0;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                const double strain =
                    0.5 * (gradient[a][b] + gradient[b][a]) - (a == b ? trace / 3 : 0);
                squares += strain * strain;
            }
        amount = std::sqrt(2 * squares);
    }
    const double range = light.stimulus.saturation - light.stimulus.threshold;
    return std::clamp((amount - light.stimulus.threshold) / range, 0.0, 1.0);
}

void set_off(openvdb::FloatGrid& density, const VelocityField& velocity, Centering centering,
             const StimulatedLight& light) {
    std::vector<FloatLeaf*> leaves;
    for (auto leaf = density.tree().beginLeaf(); leaf; ++leaf) leaves.push_back(leaf.getLeaf());
    const openvdb::Vec3d shift(centering == Centering::cell ? 0.5 : 0.0);
    parallel_for(leaves.size(), [&](std::size_t n) {
        const VelocityField::Sampler sampler(velocity);
        for (auto value = leaves[n]->beginValueOn(); value; ++value) {
            const openvdb::Vec3d x =
                density.transform().indexToWorld(value.getCoord().asVec3d() + shift);
            value.setValue(static_cast<float>(static_cast<double>(*value) *
                                              stimulated_fraction(light, sampler, x)));
        }
    });
}

/// Reads the whole density, sanitized, with its uniform regions expanded to voxels.
openvdb::FloatGrid::Ptr read_density(const VdbHeader& header, const GridSummary& grid,
                                     const SourceLocation& where, LevelSets level_sets,
                                     LoadedGrid& loaded) {
    openvdb::FloatGrid::Ptr density;
    const std::string prefix = describe_grid_place(header, grid, where);
    read_slabs(header, grid, k_whole, where, [&](const openvdb::GridBase::Ptr& slab) {
        loaded.file_from_index = to_affine(slab->transform());
        density = concentrations_of(slab, grid, prefix, level_sets, loaded.statistics.background);
    });
    loaded.statistics = sanitize(density->tree()).statistics(loaded.statistics.background);
    constexpr double k_bytes_per_voxel = 2 * sizeof(float);  // the grid and its average
    require_memory(k_bytes_per_voxel * static_cast<double>(density->baseTree().activeVoxelCount()),
                   prefix + "its voxels in motion need", "resample it to larger voxels");
    density->tree().voxelizeActiveTiles();
    return density;
}

openvdb::Vec3d furthest_displacement(const VelocityField& velocity, const LoadedGrid& loaded,
                                     const MotionDesc& motion) {
    const Matrix3 index_from_file = loaded.file_from_index.inverse().linear();
    const openvdb::Vec3d displacement = 0.5 * motion.shutter * velocity.largest(index_from_file);
    const double most = std::max({displacement.x(), displacement.y(), displacement.z()});
    if (!(most <= k_furthest))
        throw InputError(
            fmt::format("{}: moves grid '{}' by up to {:.3g} voxels within the shutter's {:g} s, "
                        "more than {:g}; "
                        "check velocity.scale, which gives m/s, and render.shutter",
                        motion.where, loaded.name, 2 * most, motion.shutter, 2 * k_furthest));
    return displacement;
}

openvdb::FloatGrid::Ptr average(const openvdb::FloatGrid& density, const VelocityField& velocity,
                                const openvdb::Vec3d& displacement, double shutter,
                                Centering centering) {
    const std::vector<openvdb::Coord> blocks = blocks_within(density, displacement);
    std::vector<std::unique_ptr<FloatLeaf>> leaves(blocks.size());
    const ShutterAverage shutter_average(density, velocity, shutter, centering);
    parallel_for(blocks.size(),
                 [&](std::size_t n) { leaves[n] = shutter_average.block(blocks[n]); });
    auto result = make_empty_grid<openvdb::FloatGrid>(0.0F);
    for (std::unique_ptr<FloatLeaf>& leaf : leaves)
        if (leaf) result->tree().addLeaf(leaf.release());  // the tree owns it
    return result;
}

}  // namespace

LoadedGrid load_moving_grid(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, const MotionDesc& motion,
                            Centering centering, LevelSets level_sets,
                            const std::optional<StimulatedLight>& light) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where, level_sets);
    const std::string prefix = describe_grid_place(header, grid, where);
    LoadedGrid loaded;
    loaded.name = grid.name;
    read_guarded(prefix, [&] {
        const openvdb::FloatGrid::Ptr density =
            read_density(header, grid, where, level_sets, loaded);
        check_loaded(header, grid, prefix, loaded);
        const VelocityField velocity(motion, centering);
        if (light) set_off(*density, velocity, centering, *light);
        openvdb::FloatGrid::Ptr moved_density = density;
        if (motion.shutter > 0)
            moved_density =
                average(*density, velocity, furthest_displacement(velocity, loaded, motion),
                        motion.shutter, centering);
        const GridIntake moved = take_slab(moved_density, loaded.bricks);
        loaded.warnings = intake_warnings(loaded.statistics, prefix);
        // The rendered grid has other values than the file, and more voxels.
        const GridStatistics rendered = moved.statistics(loaded.statistics.background);
        loaded.statistics.active_voxels = rendered.active_voxels;
        loaded.statistics.min = rendered.min;
        loaded.statistics.mean = rendered.mean;
        loaded.statistics.max = rendered.max;
    });
    return loaded;
}

}  // namespace uw
