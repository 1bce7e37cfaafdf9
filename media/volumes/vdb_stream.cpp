#include "media/volumes/vdb_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <istream>
#include <map>
#include <set>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/nvdb_grid.h"
#include "media/volumes/vdb_header.h"

namespace uw {

namespace {

using Mask = std::vector<std::uint64_t>;
using Key = std::array<std::int32_t, 3>;

constexpr std::int64_t k_leaf_values = 512, k_lower_values = 4096, k_upper_values = 32768;
constexpr std::uint32_t k_first_with_mask_compression = 222;
constexpr std::uint32_t k_zip = 1, k_active_mask = 2, k_blosc = 4;

std::int64_t count_on(const Mask& mask) {
    std::int64_t count = 0;
    for (const std::uint64_t word : mask) count += std::popcount(word);
    return count;
}

bool is_on(const Mask& mask, std::int64_t n) {
    return (mask[static_cast<std::size_t>(n / 64)] >> (n % 64) & 1U) != 0;
}

std::int64_t components_of(const std::string& value_type) {
    return value_type.starts_with("vec3") ? 3 : 1;
}

std::int64_t bytes_of_value(const std::string& value_type) {
    const bool wide = value_type == "double" || value_type == "int64" || value_type == "vec3d";
    return components_of(value_type) * (wide ? 8 : 4);
}

/// Traverses the tree of a grid of floats, doubles, integers or 3-vectors of them in the file
/// without decoding it, and checks that each block of values has the size implied by its masks.
/// OpenVDB 10 trusts the block sizes and would write past its buffers.
class LayoutWalk {
  public:
    LayoutWalk(ByteReader& in, const VdbHeader& header, const GridSummary& grid)
        : in_(in),
          old_(header.version < k_first_with_mask_compression),
          compression_(grid.compression),
          value_bytes_(bytes_of_value(grid.value_type)),
          stored_bytes_(grid.half ? 2 * components_of(grid.value_type) : value_bytes_),
          half_(grid.half) {}

    void walk_tree() {
        if (in_.get<std::int32_t>() != 1) in_.fail_damaged();  // buffers; 1 since OpenVDB 1.0
        in_.skip(value_bytes_);                                // background
        const auto tiles = in_.get<std::uint32_t>();
        const auto children = in_.get<std::uint32_t>();
        // Leaves are stored in the order of a sorted table of tiles and children: an out-of-order
        // or duplicate key would pair masks with other leaves' values.
        std::set<Key> tile_keys;
        for (std::uint32_t n = 0; n < tiles; ++n) {
            tile_keys.insert(in_.get<Key>());
            in_.skip(value_bytes_);
            // Whether it is active: OpenVDB reads the byte into a bool as it is.
            if (in_.get<std::uint8_t>() > 1) in_.fail_damaged();
        }
        Key last{};
        for (std::uint32_t n = 0; n < children; ++n) {
            const Key key = in_.get<Key>();
            if ((n > 0 && key <= last) || tile_keys.contains(key)) in_.fail_damaged();
            last = key;
            walk_upper();
        }
        for (const std::int64_t count_of_leaf : leaf_counts_) walk_leaf(count_of_leaf);
    }

  private:
    Mask read_mask(std::int64_t values) {
        Mask mask(static_cast<std::size_t>(values / 64));
        in_.read(reinterpret_cast<char*>(mask.data()), mask.size() * sizeof mask[0]);
        return mask;
    }

    /// One node's values: an indicator, inactive values, a mask between them, and the data.
    void walk_values(std::int64_t values, std::int64_t active) {
        constexpr std::int8_t one_inactive = 2, mask_only = 3, mask_one = 4, mask_two = 5, all = 6;
        const std::int8_t indicator = old_ ? all : in_.get<std::int8_t>();
        if (indicator == one_inactive || indicator == mask_one) in_.skip(value_bytes_);
        if (indicator == mask_two) in_.skip(2 * value_bytes_);
        if (indicator >= mask_only && indicator <= mask_two) in_.skip(values / 8);
        const bool active_only = (compression_ & k_active_mask) != 0 && indicator != all;
        const std::int64_t count = active_only ? active : values;
        if (half_ && count < 1) return;
        const std::int64_t bytes = count * stored_bytes_;
        if ((compression_ & (k_zip | k_blosc)) == 0) {
            in_.skip(bytes);
            return;
        }
        const auto packed = in_.get<std::int64_t>();  // negative: stored uncompressed
        if (packed <= 0 && packed != -bytes) in_.fail_damaged();
        in_.skip(packed > 0 ? packed : bytes);
    }

    /// The masks and values of an internal node; returns the mask of its children.
    Mask walk_internal(std::int64_t values) {
        Mask children = read_mask(values);
        const Mask active = read_mask(values);
        walk_values(old_ ? values - count_on(children) : values, count_on(active));
        return children;
    }
    void walk_upper() {
        const Mask children = walk_internal(k_upper_values);
        for (std::int64_t n = 0; n < k_upper_values; ++n)
            if (is_on(children, n)) walk_lower();
    }
    void walk_lower() {
        const std::int64_t children = count_on(walk_internal(k_lower_values));
        for (std::int64_t n = 0; n < children; ++n)
            leaf_counts_.push_back(count_on(read_mask(k_leaf_values)));
    }
    void walk_leaf(std::int64_t active) {
        in_.skip(k_leaf_values / 8);  // its mask, repeated
        if (old_) {
            in_.skip(sizeof(Key));
            if (in_.get<std::int8_t>() != 1) in_.fail_damaged();
        }
        walk_values(k_leaf_values, active);
    }

    ByteReader& in_;
    bool old_;
    std::uint32_t compression_;
    std::int64_t value_bytes_, stored_bytes_;
    bool half_;
    std::vector<std::int64_t> leaf_counts_;  // active values of each leaf, in the file's order
};

/// Checks what OpenVDB 10 trusts in a frustum transform: the length of its second map's name, for
/// which it allocates memory, and that this map is not a frustum again, which it reads recursively.
/// Throws InputError starting with `where`.
void check_transform(const VdbHeader& header, const GridSummary& grid,
                     const SourceLocation& where) {
    constexpr const char* k_frustum = "NonlinearFrustumMap";
    if (grid.map_type != k_frustum) return;
    ByteReader in(header.file, where);
    in.seek(grid.transform_offset);
    in.text();                    // that name
    in.skip(8 * sizeof(double));  // its box, taper and depth
    if (in.text() == k_frustum) in.fail_damaged();
}

/// A file whose reading ends with Interrupted once the calling thread's work is to stop.
class StoppableFile : public std::filebuf {
  protected:
    std::streamsize xsgetn(char* bytes, std::streamsize count) override {
        throw_if_stopped();
        return std::filebuf::xsgetn(bytes, count);
    }
};

/// One grid's part of a VDB file, as a stream set up as openvdb::io::File does it. File itself
/// would reject the whole file for one grid of an unknown type, and clips in world space.
class GridStream {
  public:
    /// `voxels`: the grid that holds the voxels of `grid`, usually itself (holder_of_voxels).
    GridStream(const VdbHeader& header, const GridSummary& grid, const GridSummary& voxels,
               const SourceLocation& where)
        : header_(header), grid_(grid), voxels_(voxels), where_(where) {
        if (file_.open(header.file, std::ios::in | std::ios::binary) == nullptr)
            stream_.setstate(std::ios::failbit);
        check_transform(header, grid, where);
        check_transform(header, voxels, where);
        stream_.exceptions(std::ios::failbit | std::ios::badbit);
        metadata_->setFileVersion(header.version);
        metadata_->setLibraryVersion({header.library_major, header.library_minor});
        metadata_->setCompression(voxels.compression);
        metadata_->setHalfFloat(voxels.half);
        metadata_->setSeekable(true);
        openvdb::io::setStreamMetadataPtr(stream_, metadata_, /*transfer=*/true);
    }

    openvdb::math::Transform::ConstPtr read_transform() {
        const auto transform = openvdb::math::Transform::createLinearTransform();
        stream_.seekg(grid_.transform_offset);
        transform->read(stream_);
        return transform;
    }

    /// A grid with its transform and tree, but no voxel values yet.
    openvdb::GridBase::Ptr read_topology() {
        auto grid = openvdb::GridBase::createGrid("Tree_" + voxels_.value_type + "_5_4_3");
        grid->setSaveFloatAsHalf(voxels_.half);
        stream_.seekg(voxels_.transform_offset);
        grid->readTransform(stream_);
        check_layout_once();
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

    void read_values(openvdb::GridBase& grid) { grid.readBuffers(stream_); }
    /// Only the voxels within `box`; the others become inactive.
    void read_values(openvdb::GridBase& grid, const openvdb::CoordBBox& box) {
        grid.readBuffers(stream_, box);
    }

  private:
    /// The tree begins where the stream is.
    void check_layout_once() {
        if (layout_checked_) return;
        ByteReader in(header_.file, where_);
        in.seek(stream_.tellg());
        LayoutWalk(in, header_, voxels_).walk_tree();
        layout_checked_ = true;
    }

    const VdbHeader& header_;
    const GridSummary& grid_;
    const GridSummary& voxels_;
    const SourceLocation& where_;
    bool layout_checked_ = false;
    StoppableFile file_;
    std::istream stream_{&file_};
    // The stream keeps a pointer to this member.
    openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
};

/// The grid whose voxels `grid` shares, or itself. Throws std::runtime_error if it is missing.
const GridSummary& holder_of_voxels(const VdbHeader& header, const GridSummary& grid) {
    if (grid.instance_of.empty()) return grid;
    for (const GridSummary& other : header.grids)
        if (other.unique_name == grid.instance_of && other.instance_of.empty() &&
            other.tree_type == grid.tree_type)
            return other;
    throw std::runtime_error("the grid it shares its voxels with is missing");
}

/// Calls `take(origin)` for every leaf.
void for_each_leaf(const openvdb::GridBase& grid,
                   const std::function<void(const openvdb::Coord&)>& take) {
    grid.apply<ReadableGrids>([&](const auto& typed) {
        for (auto upper = typed.tree().root().cbeginChildOn(); upper; ++upper)
            for (auto lower = upper->cbeginChildOn(); lower; ++lower)
                for (auto leaf = lower->cbeginChildOn(); leaf; ++leaf) take(leaf->origin());
    });
}

std::size_t bytes_of_leaf(const openvdb::GridBase& grid) {
    std::size_t bytes = 0;
    grid.apply<ReadableGrids>([&](const auto& typed) {
        using Tree = typename std::decay_t<decltype(typed)>::TreeType;
        bytes = sizeof(typename Tree::ValueType) * std::size_t{Tree::LeafNodeType::SIZE};
    });
    return bytes;
}

/// The greatest size of slabs [bytes] if `total` bytes are cut into slabs of about `slab_bytes`.
std::size_t max_slab(std::size_t total, std::size_t slab_bytes) {
    return std::min(total, std::max(slab_bytes, total / 8));
}

void check_memory(const openvdb::GridBase& grid, std::size_t slab_bytes,
                  const std::string& prefix) {
    const std::size_t leaves = grid.constBaseTree().leafCount();
    const std::size_t total = leaves * bytes_of_leaf(grid);
    // A voxel takes 16 bits in what is kept, and a slab is there twice while it is converted.
    constexpr std::size_t k_kept_bytes_per_leaf = 2 * 512;
    require_memory(static_cast<double>(leaves * k_kept_bytes_per_leaf) +
                       2 * static_cast<double>(max_slab(total, slab_bytes)),
                   prefix + "it needs", "resample it to larger voxels");
}

/// The boxes into which a grid (topology only) is split for read_slabs; empty: no need to split.
std::vector<openvdb::CoordBBox> cut_into_slabs(const openvdb::GridBase& grid,
                                               std::size_t slab_bytes) {
    const std::size_t leaf_bytes = bytes_of_leaf(grid);
    const std::size_t total = grid.constBaseTree().leafCount() * leaf_bytes;
    if (total <= slab_bytes) return {};
    slab_bytes = max_slab(total, slab_bytes);

    openvdb::CoordBBox box;
    for_each_leaf(grid, [&](const openvdb::Coord& origin) { box.expand(origin); });
    const std::size_t axis = box.maxExtent();
    std::map<int, std::size_t> leaves_at;
    for_each_leaf(grid, [&](const openvdb::Coord& origin) { ++leaves_at[origin[axis]]; });
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

}  // namespace

openvdb::math::Transform::ConstPtr read_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where) {
    if (header.is_nano) return read_nvdb_transform(header, grid, where);
    return GridStream(header, grid, grid, where).read_transform();
}

void read_slabs(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                const SourceLocation& where,
                const std::function<void(const openvdb::GridBase::Ptr&)>& take) {
    if (header.is_nano) {
        take(read_nvdb_grid(header, grid, where));
        return;
    }
    GridStream stream(header, grid, holder_of_voxels(header, grid), where);
    openvdb::GridBase::Ptr first = stream.read_topology();
    check_memory(*first, slab_bytes, describe_grid_place(header, grid, where));
    const std::vector<openvdb::CoordBBox> slabs = cut_into_slabs(*first, slab_bytes);
    if (slabs.empty()) {
        stream.read_values(*first);
        take(first);
        return;
    }
    first.reset();
    for (const openvdb::CoordBBox& slab : slabs) {
        throw_if_stopped();
        const openvdb::GridBase::Ptr part = stream.read_topology();
        stream.read_values(*part, slab);
        take(part);
    }
}

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

std::string describe_grid_place(const VdbHeader& header, const GridSummary& grid,
                                const SourceLocation& where) {
    return fmt::format("{}: grid '{}' of '{}': ", where, grid.name, header.file.string());
}

}  // namespace uw
