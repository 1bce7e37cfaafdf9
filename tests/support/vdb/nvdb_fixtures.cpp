#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Compression.h>
#include <openvdb/openvdb.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

openvdb::FloatGrid::Ptr make_float_grid(const VdbFixture& fixture) {
    const TempDir dir;  // by way of a VDB file, which OpenVDB itself reads
    write_fixture(dir / "a.vdb", {fixture});
    openvdb::io::File file((dir / "a.vdb").string());
    file.open();
    auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(fixture.name));
    file.close();
    return grid;
}

template <class BuildT>
nanovdb::GridHandle<> convert(const openvdb::FloatGrid& grid) {
    nanovdb::OpenToNanoVDB<float, BuildT> converter;
    converter.setChecksum(nanovdb::ChecksumMode::Full);
    return converter(grid);
}

nanovdb::GridHandle<> convert(const openvdb::FloatGrid& grid, const std::string& precision) {
    if (precision == "fp4") return convert<nanovdb::Fp4>(grid);
    if (precision == "fp8") return convert<nanovdb::Fp8>(grid);
    if (precision == "fp16") return convert<nanovdb::Fp16>(grid);
    if (precision == "fpN") return convert<nanovdb::FpN>(grid);
    return convert<float>(grid);
}

}  // namespace

void write_nvdb_fixture(const std::filesystem::path& file, const VdbFixture& density,
                        const std::string& precision, int codec) {
    const nanovdb::GridHandle<> handle = convert(*make_float_grid(density), precision);
    nanovdb::io::writeGrid(file.string(), handle);
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    in.close();
    if (codec != 0) {  // this NanoVDB is built without codecs; they are OpenVDB's
        const std::size_t head = bytes.size() - handle.size();
        std::ostringstream packed;
        const auto* data = reinterpret_cast<const char*>(handle.data());
        if (codec == 1)
            openvdb::io::zipToStream(packed, data, handle.size());
        else
            openvdb::io::bloscToStream(packed, data, sizeof(float), handle.size() / sizeof(float));
        bytes = bytes.substr(0, head) + packed.str();
        const auto code = static_cast<std::uint16_t>(codec);
        const std::uint64_t size = packed.str().size();
        std::memcpy(&bytes[14], &code, sizeof code);   // of the segment
        std::memcpy(&bytes[24], &size, sizeof size);   // of the grid in the file
        std::memcpy(&bytes[184], &code, sizeof code);  // of the grid
    }
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace uw::test
