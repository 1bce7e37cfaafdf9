// ctest labels: unit
//
// NanoVDB files hold what the VDB files do that they were made from; damaged ones are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "media/inspection/vdb_inspect.h"
#include "media/volumes/vdb_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

using test::TempDir;
using test::VdbFixture;

VdbFixture blob() {
    VdbFixture fixture;
    fixture.min = {-9, 0, 3};
    fixture.max = {20, 17, 22};
    fixture.value = [](int i, int j, int k) {
        return 1.5 + std::sin(0.3 * i + 0.2 * j) + 0.01 * k;
    };
    fixture.boxes = {{{128, 0, 0}, {255, 127, 127}, 0.5}};  // a tile
    fixture.file_from_index = Affine(Matrix3(0.1, 0, 0, 0, 0.2, 0, 0.05, 0, 0.1), {1, 2, 3});
    return fixture;
}

struct Precision {
    const char* name;
    double error;  // of the range within a block, about 2
    int codec = 0;
};

class NvdbPrecision : public testing::TestWithParam<Precision> {};

TEST_P(NvdbPrecision, HasTheValuesOfTheVdbFile) {
    const TempDir dir;
    test::write_fixture(dir / "a.vdb", {blob()});
    test::write_nvdb_fixture(dir / "a.nvdb", blob(), GetParam().name, GetParam().codec);
    const LoadedGrid vdb = test::load(dir / "a.vdb", "density");
    const LoadedGrid nvdb = test::load(dir / "a.nvdb", "density");
    EXPECT_EQ(nvdb.statistics.active_voxels, vdb.statistics.active_voxels);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(nvdb.file_from_index.offset()[axis], vdb.file_from_index.offset()[axis], 1e-12);
        EXPECT_NEAR(
            glm::length(nvdb.file_from_index.linear()[axis] - vdb.file_from_index.linear()[axis]),
            0, 1e-12);
    }
    ASSERT_EQ(nvdb.bricks.size(), 1U);
    for (int i = -10; i < 24; ++i)
        for (int j = -1; j < 20; j += 3) {
            const Point3 p{i + 0.25, j + 0.5, 11.75};
            EXPECT_NEAR(nvdb.bricks[0].sample(p), vdb.bricks[0].sample(p), 2 * GetParam().error);
        }
    const Point3 in_tile{200, 60, 60};
    EXPECT_NEAR(nvdb.bricks[0].sample(in_tile), 0.5, 1e-6);
}

// Half a step of the quantisation, and of the 16 bits that grids are kept in.
INSTANTIATE_TEST_SUITE_P(Nvdb, NvdbPrecision,
                         testing::Values(Precision{"float", 2e-5}, Precision{"float", 2e-5, 1},
                                         Precision{"float", 2e-5, 2}, Precision{"fp4", 0.04},
                                         Precision{"fp8", 3e-3}, Precision{"fp16", 3e-5},
                                         Precision{"fpN", 0.04}, Precision{"fpN", 0.04, 2}));

TEST(Nvdb, SaysWhatItIs) {
    const TempDir dir;
    test::write_nvdb_fixture(dir / "a.nvdb", blob(), "fp8");
    const VdbInspection inspection = inspect_vdb(dir / "a.nvdb", "here");
    EXPECT_TRUE(inspection.header.is_nano);
    ASSERT_EQ(inspection.grids.size(), 1U);
    EXPECT_EQ(inspection.grids[0].summary.quantised, "fp8");
    EXPECT_EQ(inspection.grids[0].unread, "");
    EXPECT_EQ(inspection.grids[0].transform, "sheared");
}

TEST(Nvdb, DamageIsRefused) {
    const TempDir dir;
    for (const auto& [precision, codec] : {std::pair{"float", 0}, {"float", 2}, {"fpN", 0}}) {
        test::write_nvdb_fixture(dir / "a.nvdb", blob(), precision, codec);
        const std::string bytes = test::file_bytes(dir / "a.nvdb");
        for (std::size_t size = 9; size < bytes.size(); size += bytes.size() / 23) {
            std::ofstream(dir / "cut.nvdb", std::ios::binary) << bytes.substr(0, size);
            test::refusal(dir / "cut.nvdb", "density");
        }
        // Offsets and counts anywhere in the headers and the first nodes go astray.
        for (std::size_t at = 8; at + 8 < std::min<std::size_t>(bytes.size(), 2400); at += 8) {
            std::string forged = bytes;
            const std::uint64_t astray = (at % 16 == 0) ? 0x7fffffffffffff00ULL : at * 32;
            std::memcpy(&forged[at], &astray, sizeof astray);
            std::ofstream(dir / "forged.nvdb", std::ios::binary) << forged;
            try {
                test::load(dir / "forged.nvdb", "density");  // a name or a box may be any
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
}

}  // namespace
}  // namespace uw
