// ctest labels: unit analytic
#include "cli/info/vdb_advice.h"

#include <gtest/gtest.h>

#include "media/water/water_types.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

/// A box of 40 x 20 x 10 voxels of 5 cm filled with `value`, so that through its middle side it is
/// 1 m deep.
VdbInspection box_of(const test::TempDir& dir, double value) {
    test::VdbFixture fixture;
    fixture.boxes = {{{0, 0, 0}, {39, 19, 9}, value}};
    fixture.file_from_index = Affine::scale(Vector3(0.05));
    test::write_fixture(dir / "box.vdb", {fixture});
    return inspect_vdb(dir / "box.vdb", "here");
}

VdbAdvice advice_to_map(const VdbInspection& inspection, double scale) {
    VdbAdvice advice;
    advice.map = {"density"};
    advice.scale = scale;
    start_concentrations(inspection, advice);
    return advice;
}

TEST(VdbConcentration, BeginsWithAnOpticalDepthOfOneAndAHalf) {
    const test::TempDir dir;
    const VdbInspection inspection = box_of(dir, 0.5);
    const VdbAdvice advice = advice_to_map(inspection, 1);
    // Small and large particles, 1 to 5 by volume, scatter with Kopelevich's coefficients and
    // absorb nothing: 1.5 of optical depth over 1 m of value 0.5.
    const double per_ppm = kopelevich_small_scattering(540) + 5 * kopelevich_large_scattering(540);
    EXPECT_NEAR(advice.small_ppm, 1.5 / (0.5 * per_ppm), 0.05 * advice.small_ppm);  // two digits
    EXPECT_EQ(advice.large_ppm, 5 * advice.small_ppm);
    ASSERT_EQ(advice.optical_depth.size(), 3U);
    // Less half of the last voxels' slopes, an eightieth.
    EXPECT_NEAR(advice.optical_depth[1], 0.5 * per_ppm * advice.small_ppm, 0.03);
    EXPECT_NEAR(advice.bounds.max.x - advice.bounds.min.x, 2, 1e-9);
}

TEST(VdbConcentration, FallsWithTheSizeAndTheValues) {
    const test::TempDir dir;
    const VdbAdvice plain = advice_to_map(box_of(dir, 0.5), 1);
    EXPECT_NEAR(advice_to_map(box_of(dir, 0.5), 10).small_ppm, plain.small_ppm / 10,
                0.05 * plain.small_ppm / 10);
    EXPECT_NEAR(advice_to_map(box_of(dir, 50), 1).small_ppm, plain.small_ppm / 100,
                0.05 * plain.small_ppm / 100);
}

TEST(VdbConcentration, IsThatOfADraftInWhichItIsPlainToSee) {
    const test::TempDir dir;
    const VdbInspection inspection = box_of(dir, 0.5);
    VdbAdvice advice;
    advice.map = {"density"};
    choose_concentrations(inspection, {}, advice);
    EXPECT_GT(advice.view.draft.contrast, k_plain_to_see);
    EXPECT_GT(advice.small_ppm, 0);
    // What a unit adds per metre, over the metre that the box is deep.
    const double per_ppm = kopelevich_small_scattering(540) + 5 * kopelevich_large_scattering(540);
    EXPECT_NEAR(advice.optical_depth[1], 0.5 * per_ppm * advice.small_ppm,
                0.02 * advice.optical_depth[1]);
    ASSERT_EQ(advice.lines.size(), 2U);
    EXPECT_NE(advice.lines[0].find("neither invisible nor black"), std::string::npos)
        << advice.lines[0];
    EXPECT_NE(advice.lines[1].find("with render.scattering: multiple"), std::string::npos)
        << advice.lines[1];
}

}  // namespace
}  // namespace uw
