#include "media/vdb_file.h"

#include <fmt/format.h>

#define NANOVDB_USE_TBB
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "core/error.h"
#include "media/vdb_layout.h"

namespace uw {
namespace {

constexpr int k_largest_index = 1 << 30;

void initialize_once() {
    static const bool done = (openvdb::initialize(), true);
    static_cast<void>(done);
}

/// One grid's part of the file, as a stream set up the way openvdb::io::File does it. File itself
/// would refuse the whole file for one grid of a type it does not know, and clips in world space.
class GridStream {
  public:
    GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
               const SourceLocation& where)
        : header_(header),
          grid_(grid),
          voxels_(voxels),
          where_(where),
          stream_(header.file, std::ios::binary) {
        stream_.exceptions(std::ios::failbit | std::ios::badbit);
        metadata_->setFileVersion(header.version);
        metadata_->setLibraryVersion({header.library_major, header.library_minor});
        metadata_->setCompression(voxels.compression);
        metadata_->setHalfFloat(voxels.half);
        metadata_->setSeekable(true);
        openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/true);
    }

    openvdb::math::Transform::ConstPtr read_transform() {
        openvdb::FloatGrid grid;
        stream_.seekg(grid_.transform_offset);
        grid.readTransform(stream_);
        return grid.transformPtr();
    }
    /// A grid with its transform and tree, but no voxel values yet.
    template <class GridT>
    typename GridT::Ptr read_topology() {
        auto grid = GridT::create();
        grid->setSaveFloatAsHalf(voxels_.half);
        stream_.seekg(voxels_.transform_offset);
        grid->readTransform(stream_);
        if (!layout_checked_) check_layout(header_, voxels_, stream_.tellg(), where_);
        layout_checked_ = true;
        metadata_->setLeaf(0);
        grid->readTopology(stream_);
        const auto blocks = stream_.tellg();
        if (&grid_ != &voxels_) {
            stream_.seekg(grid_.transform_offset);
            grid->readTransform(stream_);
            stream_.seekg(blocks);
        }
        return grid;
    }
    template <class GridT>
    void read_values(GridT& grid) {
        grid.readBuffers(stream_);
    }
    /// Only the voxels within `box`; the others become inactive.
    template <class GridT>
    void read_values(GridT& grid, const openvdb::CoordBBox& box) {
        grid.readBuffers(stream_, box);
    }

  private:
    const VdbHeader& header_;
    const GridSummary& grid_;
    const GridSummary& voxels_;
    const SourceLocation& where_;
    bool layout_checked_ = false;
    std::ifstream stream_;
    // The stream keeps a pointer to this very member.
    openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
};

Affine to_affine(const openvdb::math::Transform& transform) {
    const auto column = [&](int axis) {
        openvdb::Vec3d unit(0, 0, 0);
        unit[axis] = 1;
        const openvdb::Vec3d v =
            transform.indexToWorld(unit) - transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
        return Vector3(v.x(), v.y(), v.z());
    };
    const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
    return {Matrix3(column(0), column(1), column(2)), {origin.x(), origin.y(), origin.z()}};
}

/// Cuts a tree (topology only) across its longest axis at block boundaries, so that no slab holds
/// more than `slab_bytes` of leaf values, or an eighth of all.
template <class TreeT>
std::vector<openvdb::CoordBBox> cut_into_slabs(const TreeT& tree, std::size_t slab_bytes) {
    openvdb::CoordBBox box;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) box.expand(leaf->origin());
    const std::size_t leaf_bytes = sizeof(float) * TreeT::LeafNodeType::SIZE;
    const std::size_t total = tree.leafCount() * leaf_bytes;
    if (total <= slab_bytes) return {};
    slab_bytes = std::max(slab_bytes, total / 8);

    const auto axis = static_cast<int>(box.maxExtent());
    std::map<int, std::size_t> leaves_at;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) ++leaves_at[leaf->origin()[axis]];
    std::vector<openvdb::CoordBBox> slabs{openvdb::CoordBBox::inf()};
    std::size_t bytes = 0;
    for (const auto& [origin, leaves] : leaves_at) {
        if (bytes > 0 && bytes + leaves * leaf_bytes > slab_bytes) {
            slabs.back().max()[axis] = origin - 1;
            slabs.push_back(openvdb::CoordBBox::inf());
            slabs.back().min()[axis] = origin;
            bytes = 0;
        }
        bytes += leaves * leaf_bytes;
    }
    return slabs;
}

/// Makes every value finite and >= 0, zero voxels inactive, inactive ones zero, and prunes.
GridIntake sanitize(openvdb::FloatTree& tree) {
    using Tree = openvdb::FloatTree;
    tree.root().setBackground(0.0F, /*updateChildNodes=*/false);
    GridIntake total;
    auto tiles = tree.beginValueAll();
    tiles.setMaxDepth(Tree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tiles; ++tiles) {
        const auto voxels = static_cast<std::int64_t>(tiles.getVoxelCount());
        const float value = tiles.isValueOn() ? total.take(*tiles, voxels) : 0.0F;
        tiles.setValue(value);
        tiles.setActiveState(value > 0);
    }
    openvdb::tree::LeafManager<Tree> leaves(tree);
    std::vector<GridIntake> parts(leaves.leafCount());  // summed in order: the same for any threads
    leaves.foreach ([&parts](Tree::LeafNodeType& leaf, std::size_t index) {
        float* values = leaf.buffer().data();
        for (openvdb::Index n = 0; n < Tree::LeafNodeType::SIZE; ++n) {
            values[n] = leaf.isValueOn(n) ? parts[index].take(values[n], 1) : 0.0F;
            leaf.setActiveState(n, values[n] > 0);
        }
    });
    for (const GridIntake& part : parts) total.add(part);
    openvdb::tools::prune(tree);  // blocks of one value become tiles, which cost nothing
    return total;
}

void append_brick(const openvdb::FloatGrid& grid, std::vector<NanoGrid>& bricks) {
    openvdb::CoordBBox box;
    if (!grid.tree().evalActiveVoxelBoundingBox(box)) return;
    for (int axis = 0; axis < 3; ++axis)
        if (box.min()[axis] <= -k_largest_index || box.max()[axis] >= k_largest_index)
            throw std::range_error("it has voxels further than 2^30 from its origin");
    nanovdb::OpenToNanoVDB<float, nanovdb::Fp16> converter;
    converter.setStats(nanovdb::StatsMode::Disable);
    converter.setChecksum(nanovdb::ChecksumMode::Disable);
    auto handle = std::make_shared<nanovdb::GridHandle<nanovdb::HostBuffer>>(converter(grid));
    const void* data = handle->data();
    const std::size_t bytes = handle->size();
    bricks.emplace_back(std::move(handle), data, bytes,
                        std::array{box.min().x(), box.min().y(), box.min().z()},
                        std::array{box.max().x(), box.max().y(), box.max().z()});
}

/// The slab's values as a float grid without transform (bricks work in index space).
GridIntake take_slab(const openvdb::FloatGrid::Ptr& grid, std::vector<NanoGrid>& bricks) {
    const GridIntake intake = sanitize(grid->tree());
    grid->setTransform(openvdb::math::Transform::createLinearTransform());
    append_brick(*grid, bricks);
    return intake;
}

GridIntake take_slab(openvdb::DoubleGrid::Ptr grid, std::vector<NanoGrid>& bricks) {
    auto tree = std::make_shared<openvdb::FloatTree>(grid->tree());
    grid.reset();
    return take_slab(openvdb::FloatGrid::create(tree), bricks);
}

template <class GridT>
GridIntake read_grid(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
                     std::size_t slab_bytes, const SourceLocation& where, LoadedGrid& loaded) {
    GridStream stream(header, grid, voxels, where);
    typename GridT::Ptr first = stream.template read_topology<GridT>();
    loaded.file_from_index = to_affine(first->transform());
    loaded.statistics.background = static_cast<double>(first->background());
    const std::vector<openvdb::CoordBBox> slabs = cut_into_slabs(first->tree(), slab_bytes);
    if (slabs.empty()) {
        stream.read_values(*first);
        return take_slab(std::move(first), loaded.bricks);
    }
    first.reset();
    GridIntake total;
    for (const openvdb::CoordBBox& slab : slabs) {
        typename GridT::Ptr part = stream.template read_topology<GridT>();
        stream.read_values(*part, slab);
        total.add(take_slab(std::move(part), loaded.bricks));
    }
    return total;
}

const GridSummary& holder_of_voxels(const VdbHeader& header, const GridSummary& grid) {
    if (grid.instance_of.empty()) return grid;
    for (const GridSummary& other : header.grids)
        if (other.unique_name == grid.instance_of && other.instance_of.empty() &&
            other.tree_type == grid.tree_type)
            return other;
    throw std::runtime_error("the grid it shares its voxels with is missing");
}

std::string describe(const VdbHeader& header, const GridSummary& grid,
                     const SourceLocation& where) {
    return fmt::format("{}: grid '{}' of '{}': ", where, grid.name, header.file.string());
}

/// What `read` returns; what OpenVDB throws becomes an InputError that starts with `prefix`.
template <class Read>
auto read_guarded(const std::string& prefix, const Read& read) {
    try {
        return read();
    } catch (const InputError&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw InputError(prefix + "the file is cut short or damaged; copy or export it again");
    } catch (const std::bad_alloc&) {
        throw InputError(prefix + "it needs more memory than there is");
    } catch (const std::exception& error) {
        throw InputError(prefix + "cannot be read: " + error.what());
    }
}

}  // namespace

Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where) {
    initialize_once();
    const GridSummary& grid = select_grid(header, name, where);
    return read_guarded(describe(header, grid, where), [&] {
        return to_affine(*GridStream(header, grid, grid, where).read_transform());
    });
}

LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes) {
    initialize_once();
    const GridSummary& grid = select_grid(header, name, where);
    const std::string prefix = describe(header, grid, where);
    LoadedGrid loaded;
    loaded.name = grid.name;
    const GridIntake intake = read_guarded(prefix, [&] {
        const GridSummary& voxels = holder_of_voxels(header, grid);
        return grid.value_type == "double"
                   ? read_grid<openvdb::DoubleGrid>(header, grid, voxels, slab_bytes, where, loaded)
                   : read_grid<openvdb::FloatGrid>(header, grid, voxels, slab_bytes, where, loaded);
    });
    loaded.statistics = intake.statistics(loaded.statistics.background);
    const bool classless = grid.grid_class != "fog volume";
    if (classless && loaded.statistics.background > 0 && intake.negative > 0)
        throw InputError(fmt::format(
            "{}is a level set, though its class is '{}' (background {:g}, {} negative voxels), not "
            "a concentration; export a fog volume; the file has {}",
            prefix, grid.grid_class, loaded.statistics.background, intake.negative,
            header.describe_grids()));
    const double determinant = loaded.file_from_index.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw InputError(prefix + "its transform is singular (voxels without volume)");
    loaded.warnings = intake_warnings(loaded.statistics, prefix);
    return loaded;
}

}  // namespace uw
