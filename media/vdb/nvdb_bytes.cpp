#include "media/vdb/nvdb_bytes.h"

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/HostBuffer.h>
#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <new>

#include "core/base/available_memory.h"
#include "media/vdb/byte_reader.h"

namespace uw {
namespace {

using Buffer = nanovdb::HostBuffer;  // aligned as nodes require

constexpr std::uint64_t k_chunk_bytes = std::uint64_t{1} << 30;  // compressed one by one

/// Decompresses the data at `in`'s position. Lengths preceding compressed chunks are not trusted.
void unpack(ByteReader& in, const std::filesystem::path& file, bool zip, Buffer& to) {
    std::ifstream stream(file, std::ios::binary);
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
    if (bytes > available_memory_bytes()) throw std::bad_alloc();
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

}  // namespace uw
