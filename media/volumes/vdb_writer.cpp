#include "media/volumes/vdb_writer.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "media/volumes/grid_bricks.h"

namespace uw {
namespace {

/// One block of 8^3 values, or nothing if all are 0 or outside the grid.
std::unique_ptr<openvdb::FloatTree::LeafNodeType> make_block(const VdbOutputGrid& grid,
                                                             const openvdb::Coord& origin) {
    throw_if_stopped();
    auto leaf = std::make_unique<openvdb::FloatTree::LeafNodeType>(origin, 0.0F);
    const auto end = [&](int axis) {
        return std::min(origin[axis] + k_leaf_edge, grid.size[static_cast<std::size_t>(axis)]);
    };
    for (int i = origin[0]; i < end(0); ++i)
        for (int j = origin[1]; j < end(1); ++j)
            for (int k = origin[2]; k < end(2); ++k) {
                const float value = grid.value(i, j, k);
                if (value != 0) leaf->setValueOn(openvdb::Coord(i, j, k), value);
            }
    if (leaf->isEmpty()) leaf.reset();
    return leaf;
}

openvdb::FloatGrid::Ptr make_grid(const VdbOutputGrid& source) {
    auto grid = make_empty_grid<openvdb::FloatGrid>(0.0F);
    grid->setName(source.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    const auto transform = openvdb::math::Transform::createLinearTransform(source.voxel_size);
    transform->postTranslate(openvdb::Vec3d(source.origin.x, source.origin.y, source.origin.z));
    grid->setTransform(transform);
    for (const auto& [key, value] : source.metadata)
        grid->insertMeta(key, openvdb::StringMetadata(value));
    for (int i = 0; i < source.size[0]; i += k_leaf_edge)
        for (int j = 0; j < source.size[1]; j += k_leaf_edge)
            for (int k = 0; k < source.size[2]; k += k_leaf_edge)
                if (auto leaf = make_block(source, {i, j, k}))
                    grid->tree().addLeaf(leaf.release());  // the tree owns it
    return grid;
}

/// A stream buffer through which OpenVDB writes to an OutputFile, which keeps errors until it is
/// committed. Throws Interrupted once the calling thread's work is to stop.
class StoppableOutput : public std::streambuf {
  public:
    explicit StoppableOutput(OutputFile& out) : out_(out) {}

  protected:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        throw_if_stopped();
        out_.write(std::string_view(bytes, static_cast<std::size_t>(count)));
        return count;
    }
    int_type overflow(int_type character) override {
        const char byte = traits_type::to_char_type(character);
        xsputn(&byte, 1);
        return character;
    }
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode mode) override {
        const auto here = static_cast<off_type>(out_.position());
        if (from == std::ios::cur && offset == 0) return here;
        if (from == std::ios::end) return off_type{-1};
        return seekpos(from == std::ios::cur ? here + offset : offset, mode);
    }
    pos_type seekpos(pos_type position, std::ios::openmode) override {
        out_.seek(static_cast<std::uint64_t>(off_type{position}));
        return position;
    }

  private:
    OutputFile& out_;
};

/// Writes what openvdb::io::File would, to any stream.
class VdbArchive : public openvdb::io::Archive {
  public:
    VdbArchive() = default;
    using Archive::write;
};

}  // namespace

void write_vdb(OutputFile& out, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata) {
    initialize_openvdb();
    const auto fail = [&](const std::string& why) {
        throw IoError(fmt::format("{}: cannot write: {}", out.path().string(), why));
    };
    try {
        openvdb::GridPtrVec output;
        for (const VdbOutputGrid& grid : grids) output.push_back(make_grid(grid));
        openvdb::MetaMap map;
        for (const auto& [key, value] : metadata)
            map.insertMeta(key, openvdb::StringMetadata(value));
        StoppableOutput buffer(out);
        std::ostream stream(&buffer);
        stream.exceptions(std::ios::badbit);  // passes on what the buffer throws
        constexpr bool k_seekable = true;
        VdbArchive().write(stream, output, k_seekable, map);
    } catch (const Interrupted&) {
        throw;
    } catch (const std::bad_alloc&) {
        fail("not enough memory");
    } catch (const std::exception& error) {
        fail(error.what());
    }
}

void write_vdb(const std::filesystem::path& file, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata) {
    OutputFile out(file);
    write_vdb(out, grids, metadata);
    out.commit();
}

}  // namespace uw
