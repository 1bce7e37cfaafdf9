#include "media/volumes/nvdb_grid.h"

#include <fmt/format.h>
#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/HostBuffer.h>
#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/input_files.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_header.h"

namespace uw {

namespace {

using Buffer = nanovdb::HostBuffer;  // aligned as nodes require

constexpr std::uint64_t k_chunk_bytes = std::uint64_t{1} << 30;  // compressed one by one

/// Decompresses the data at `in`'s position. Lengths preceding compressed chunks are not trusted.
void unpack(ByteReader& in, const std::filesystem::path& file, bool zip, Buffer& to) {
    std::ifstream stream = open_input(file, file.string(), "volume");
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    for (std::uint64_t done = 0; done < to.size();) {
        const std::uint64_t chunk = zip ? to.size() : std::min(k_chunk_bytes, to.size() - done);
        const std::int64_t begin = in.position();
        const auto packed = in.get<std::int64_t>();
        if (packed < 1 || packed > in.size() - in.position()) in.fail_damaged();
        if (!zip) {  // blosc's own header: flags, uncompressed bytes, block size, compressed bytes
            const auto head = in.get<std::array<std::uint32_t, 4>>();
            if (head[1] != chunk || head[3] != static_cast<std::uint64_t>(packed))
                in.fail_damaged();
        }
        stream.seekg(begin);
        char* const data = reinterpret_cast<char*>(to.data()) + done;
        if (zip)
            openvdb::io::unzipFromStream(stream, data, chunk);
        else
            openvdb::io::bloscFromStream(stream, data, chunk);
        in.seek(begin + static_cast<std::int64_t>(sizeof packed) + packed);
        done += chunk;
    }
}

}  // namespace

NvdbBytes read_nvdb_bytes(const VdbHeader& header, const GridSummary& grid,
                          const SourceLocation& where) {
    ByteReader in(header.file, where);
    const auto bytes = static_cast<std::uint64_t>(grid.grid_bytes);
    if (bytes < sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>)) in.fail_damaged();
    require_memory(
        static_cast<double>(bytes),
        fmt::format("{}: grid '{}' of '{}' needs", where, grid.name, header.file.string()),
        "resample it to larger voxels");
    const auto storage = std::make_shared<Buffer>(Buffer::create(bytes));
    Buffer& buffer = *storage;
    in.seek(grid.blocks_offset);
    if (grid.compression == 0)
        in.read(reinterpret_cast<char*>(buffer.data()), bytes);
    else
        unpack(in, header.file, grid.compression == 1, buffer);
    const auto* data = reinterpret_cast<const nanovdb::GridData*>(buffer.data());
    constexpr std::uint64_t k_later_magic = 0x314244566f6e614e;  // "NanoVDB1", from 32.6 on
    if ((data->mMagic != NANOVDB_MAGIC_NUMBER && data->mMagic != k_later_magic) ||
        data->mGridSize > bytes)
        in.fail_damaged();
    return {{storage, buffer.data()}, bytes};
}

namespace {

constexpr std::size_t k_alignment = NANOVDB_DATA_ALIGNMENT;

openvdb::math::Transform::Ptr to_transform(const nanovdb::GridData& data) {
    openvdb::Mat4d m = openvdb::Mat4d::identity();
    for (int row = 0; row < 3; ++row) {  // OpenVDB multiplies row vectors from the left
        for (int column = 0; column < 3; ++column)
            m[column][row] = data.mMap.mMatD[3 * row + column];
        m[3][row] = data.mMap.mVecD[row];
    }
    return openvdb::math::Transform::createLinearTransform(m);
}

template <class T>
T convert(const T& value) {
    return value;
}
template <class T>
openvdb::math::Vec3<T> convert(const nanovdb::Vec3<T>& v) {
    return {v[0], v[1], v[2]};
}

/// The nodes of one level of a tree: where each begins, in bytes from the tree's beginning, and
/// which have been visited.
class Level {
  public:
    /// `at`: greater than all before.
    void add(std::uint64_t at) {
        begins_.push_back(at);
        visited_.push_back(false);
    }
    /// Marks the node at `at` as visited; false if there is none, or it was visited before.
    bool visit(std::uint64_t at) {
        const auto found = std::ranges::lower_bound(begins_, at);
        if (found == begins_.end() || *found != at) return false;
        const auto index = static_cast<std::size_t>(found - begins_.begin());
        if (visited_[index]) return false;
        visited_[index] = true;
        return true;
    }

  private:
    std::vector<std::uint64_t> begins_;
    std::vector<bool> visited_;
};

/// Delivers the active values of a grid to an OpenVDB grid, from which bricks are built as from
/// those of VDB files. The file is a memory image, whose nodes refer to each other by offsets: none
/// is followed before it is known to lead to a node of the right kind to which no other leads.
template <class BuildT, class GridT>
class Conversion {
    using Root = typename nanovdb::NanoRoot<BuildT>::DataType;
    using Upper = typename nanovdb::NanoUpper<BuildT>::DataType;
    using Lower = typename nanovdb::NanoLower<BuildT>::DataType;
    using Leaf = nanovdb::NanoLeaf<BuildT>;
    using LeafData = typename Leaf::DataType;

  public:
    Conversion(const NvdbBytes& bytes, ByteReader& in)
        : in_(in),
          data_(*reinterpret_cast<const nanovdb::GridData*>(bytes.data.get())),
          tree_(bytes.data.get() + sizeof(nanovdb::GridData)),
          available_(bytes.size - sizeof(nanovdb::GridData)),
          head_(*reinterpret_cast<const nanovdb::TreeData<3>*>(tree_)) {}

    typename GridT::Ptr run() {
        find_nodes<Upper>(2, uppers_);
        find_nodes<Lower>(1, lowers_);
        find_nodes<LeafData>(0, leaves_);
        const std::uint64_t at = head_.mNodeOffset[3];
        require(at % k_alignment == 0 && at >= sizeof head_ && at <= available_ &&
                available_ - at >= sizeof(Root));
        const auto* root = reinterpret_cast<const Root*>(tree_ + at);
        require(root->mTableSize <= (available_ - at - sizeof(Root)) / sizeof(typename Root::Tile));
        grid_ = make_empty_grid<GridT>(convert(root->mBackground));
        for (std::uint32_t n = 0; n < root->mTableSize; ++n) take_root_tile(*root, n);
        check_sum();
        grid_->setTransform(to_transform(data_));
        return grid_;
    }

  private:
    void require(bool holds) const {
        if (!holds) in_.fail_damaged();
    }
    static openvdb::Coord coord(const nanovdb::Coord& c) { return {c[0], c[1], c[2]}; }
    template <class Node>
    std::uint64_t offset_of(const Node& node, std::int64_t child) const {
        const auto at =
            static_cast<std::uint64_t>(reinterpret_cast<const std::uint8_t*>(&node) - tree_);
        return at + static_cast<std::uint64_t>(
                        child);  // an invalid one wraps to a position without a node
    }
    /// Nodes of a level are stored consecutively.
    template <class Node>
    void find_nodes(int level, Level& nodes) {
        std::uint64_t at = head_.mNodeOffset[level];
        const std::uint64_t count = head_.mNodeCount[level];
        require(count == 0 || (at <= available_ && at % k_alignment == 0));
        for (std::uint64_t n = 0; n < count; ++n) {
            require(available_ - at >= sizeof(Node));
            nodes.add(at);
            std::uint64_t bytes = sizeof(Node);
            if constexpr (std::is_same_v<Node, nanovdb::NanoLeaf<nanovdb::FpN>::DataType>) {
                const auto* leaf = reinterpret_cast<const Node*>(tree_ + at);
                constexpr unsigned k_widest = 4;  // 2^4 bits a value
                require((leaf->mFlags >> 5U) <= k_widest);
                bytes = leaf->memUsage();
                require(bytes <= available_ - at);
            }
            at += bytes;
        }
    }

    void take_root_tile(const Root& root, std::uint32_t n) {
        const auto& tile = *(reinterpret_cast<const typename Root::Tile*>(&root + 1) + n);
        const openvdb::Coord origin = coord(tile.origin());
        if (tile.child == 0) {
            if (tile.state != 0) grid_->tree().addTile(3, origin, convert(tile.value), true);
            return;
        }
        const std::uint64_t at = offset_of(root, tile.child);
        require(uppers_.visit(at));
        const auto& upper = *reinterpret_cast<const Upper*>(tree_ + at);
        take_table(
            upper, origin, 5, 7, 2, [this](std::uint64_t child, const openvdb::Coord& begin) {
                require(lowers_.visit(child));
                const auto& lower = *reinterpret_cast<const Lower*>(tree_ + child);
                take_table(
                    lower, begin, 4, 3, 1,
                    [this](std::uint64_t leaf, const openvdb::Coord& o) { take_leaf(leaf, o); });
            });
    }
    /// The children and active tiles of an internal node of 2^log2 children a side, each of
    /// 2^child_log2 voxels a side.
    template <class Node, class TakeChild>
    void take_table(const Node& node, const openvdb::Coord& origin, unsigned log2,
                    unsigned child_log2, openvdb::Index level, const TakeChild& take_child) {
        const std::uint32_t side = (1U << log2) - 1;
        for (std::uint32_t n = 0; n < (1U << (3 * log2)); ++n) {
            const bool child = node.mChildMask.isOn(n);
            if (!child && !node.mValueMask.isOn(n)) continue;
            const openvdb::Coord begin =
                origin.offsetBy(static_cast<int>((n >> (2 * log2)) << child_log2),
                                static_cast<int>((n >> log2 & side) << child_log2),
                                static_cast<int>((n & side) << child_log2));
            if (child)
                take_child(offset_of(node, node.mTable[n].child), begin);
            else
                grid_->tree().addTile(level, begin, convert(node.mTable[n].value), true);
        }
    }
    void take_leaf(std::uint64_t at, const openvdb::Coord& origin) {
        require(leaves_.visit(at));
        const auto& leaf = *reinterpret_cast<const Leaf*>(tree_ + at);
        auto made =
            std::make_unique<typename GridT::TreeType::LeafNodeType>(origin, grid_->background());
        for (std::uint32_t n = 0; n < 512; ++n)
            if (leaf.data()->mValueMask.isOn(n)) made->setValueOn(n, convert(leaf.getValue(n)));
        grid_->tree().addLeaf(made.release());  // the tree owns it
    }
    /// Checks the checksum if this library version computed it. Others compute it differently.
    void check_sum() const {
        const std::uint64_t stated = data_.mChecksum;
        if (data_.mVersion.getMinor() != NANOVDB_MINOR_VERSION_NUMBER || stated == 0 ||
            stated == ~std::uint64_t{0})
            return;
        const auto* grid = reinterpret_cast<const nanovdb::NanoGrid<BuildT>*>(&data_);
        require(nanovdb::validateChecksum(*grid));
    }

    ByteReader& in_;
    const nanovdb::GridData& data_;
    const std::uint8_t* tree_;
    std::uint64_t available_;
    const nanovdb::TreeData<3>& head_;
    Level uppers_, lowers_, leaves_;
    typename GridT::Ptr grid_;
};

template <class BuildT, class GridT>
openvdb::GridBase::Ptr convert_grid(const NvdbBytes& bytes, ByteReader& in) {
    const auto* data = reinterpret_cast<const nanovdb::GridData*>(bytes.data.get());
    if (data->mGridType != nanovdb::mapToGridType<BuildT>()) in.fail_damaged();
    return Conversion<BuildT, GridT>(bytes, in).run();
}

}  // namespace

openvdb::GridBase::Ptr read_nvdb_grid(const VdbHeader& header, const GridSummary& grid,
                                      const SourceLocation& where) {
    using openvdb::FloatGrid;
    const std::string& type = grid.quantised.empty() ? grid.value_type : grid.quantised;
    ByteReader in(header.file, where);
    if (type == "vec3i") in.fail_damaged();  // NanoVDB has no such grids
    const NvdbBytes bytes = read_nvdb_bytes(header, grid, where);
    if (type == "float") return convert_grid<float, FloatGrid>(bytes, in);
    if (type == "fp4") return convert_grid<nanovdb::Fp4, FloatGrid>(bytes, in);
    if (type == "fp8") return convert_grid<nanovdb::Fp8, FloatGrid>(bytes, in);
    if (type == "fp16") return convert_grid<nanovdb::Fp16, FloatGrid>(bytes, in);
    if (type == "fpN") return convert_grid<nanovdb::FpN, FloatGrid>(bytes, in);
    if (type == "double") return convert_grid<double, openvdb::DoubleGrid>(bytes, in);
    if (type == "int32") return convert_grid<std::int32_t, openvdb::Int32Grid>(bytes, in);
    if (type == "int64") return convert_grid<std::int64_t, openvdb::Int64Grid>(bytes, in);
    if (type == "vec3s") return convert_grid<nanovdb::Vec3f, openvdb::Vec3SGrid>(bytes, in);
    if (type == "vec3d") return convert_grid<nanovdb::Vec3d, openvdb::Vec3DGrid>(bytes, in);
    in.fail_damaged();
}

openvdb::math::Transform::Ptr read_nvdb_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where) {
    const NvdbBytes bytes = read_nvdb_bytes(header, grid, where);
    return to_transform(*reinterpret_cast<const nanovdb::GridData*>(bytes.data.get()));
}

}  // namespace uw
