#include <cmath>
#include <cstdio>
#include <filesystem>

#include "tests/support/vdb/vdb_fixtures.h"

// Small volumes of every kind that is read, into the folders vdb and nanovdb below the one named.
int main(int count, char** arguments) {
    using namespace uw::test;
    if (count != 2) {
        std::fputs("usage: fuzz_volume_seeds FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path vdb = std::filesystem::path(arguments[1]) / "vdb";
    const std::filesystem::path nano = std::filesystem::path(arguments[1]) / "nanovdb";
    std::filesystem::create_directories(vdb);
    std::filesystem::create_directories(nano);

    // Across a corner of leaves, in one node of each level above: such a node of the highest takes
    // 8 kB, and scripts/fuzz cuts what is longer than 64 kB.
    VdbFixture blob;
    blob.min = {6, 6, 6};
    blob.max = {10, 10, 10};
    blob.value = [](int i, int j, int k) {
        return std::exp(-0.3 * ((i - 8) * (i - 8) + (j - 8) * (j - 8) + (k - 8) * (k - 8)));
    };
    VdbFixture tiles = blob;
    tiles.boxes = {{{0, 16, 16}, {127, 31, 31}, 0.5}};
    VdbFixture half = blob, wide = blob, blender = blob;
    half.numbers = VdbNumbers::half;
    wide.numbers = VdbNumbers::float64;
    blender.blender_metadata = true;
    write_fixture(vdb / "float.vdb", {blob});
    write_fixture(vdb / "tiles.vdb", {tiles});
    write_fixture(vdb / "half.vdb", {half});
    write_fixture(vdb / "double.vdb", {wide});
    write_fixture(vdb / "blender.vdb", {blender}, "Blender");
    write_vector_grid(vdb / "vectors.vdb");
    write_bool_and_int_grids(vdb / "integers.vdb");
    write_instanced_grids(vdb / "instances.vdb");
    write_frustum_grid(vdb / "frustum.vdb");
    write_nvdb_fixture(nano / "zip.nvdb", blob, "float", 1);
    write_nvdb_fixture(nano / "blosc.nvdb", blob, "fp8", 2);
    return 0;
}
