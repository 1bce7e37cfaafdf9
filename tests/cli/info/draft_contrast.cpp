// ctest labels: unit analytic
//
// The contrast that `uwvdb info SCENE` states, against a closed form: a slab that only absorbs, in
// water that does nothing, before an evenly lit wall. It leaves e^-tau of the light, so its
// contrast is 1 - e^-tau.
#include "cli/info/plume_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

constexpr double k_thickness = 0.5;

class DraftContrastTest : public test::CliTest {
  protected:
    /// The slab covers the left half of a narrow view of the wall, which a lamp far to the right
    /// lights behind it.
    DraftContrastTest() {
        test::VdbFixture slab;
        slab.boxes = {{{-40, -40, 0}, {-1, 39, 9}, 1}};
        slab.file_from_index = Affine::scale(Vector3(k_thickness / 10));
        test::write_fixture(folder_ / "slab.vdb", {slab});
    }
    ParsedJson survey(double depth, const std::string& more = "") const {
        write("slab.yaml", R"(uwvdb: 1
camera: {resolution: [256, 144], intrinsics: {fov_x: 4}, pose: {position: [0, 0, 6], look_at: [0, 0, 0]}}
water: {absorption: 0, scattering: {b: 0, phase: {type: hg, g: 0}}}
geometry: [{type: plane, point: [0, 0, -4], normal: [0, 0, 1]}]
lamps: [{position: [60, 0, 56], direction: [-1, 0, -1], frame: world, intensity: 100}]
volumes: [{file: slab.vdb, centering: cell, grids: {density: {absorption: )" +
                               std::to_string(depth / k_thickness) + "}}}]\n" + more);
        const test::ProgramResult result = run({"info", "slab.yaml", "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ParsedJson::parse(result.out);
    }
    static bool warns(const ParsedJson& json) {
        return std::ranges::any_of(json.at("warnings"), [](const ParsedJson& line) {
            return line.get<std::string>().find("change the picture by") != std::string::npos;
        });
    }
};

TEST_F(DraftContrastTest, OfAnAbsorbingSlabIsOneLessItsTransmittance) {
    for (const double depth : {0.1, 0.7, 2.0}) {
        const ParsedJson contrast = survey(depth).at("contrast");
        // Drafts are within 3 % of the transmittance, and the wall's light within 1 % of its mean.
        EXPECT_NEAR(contrast.at("contrast").get<double>(), 1 - std::exp(-depth),
                    0.03 * std::exp(-depth) + 0.01);
        // The slab is even, so half of its pixels have all of its contrast.
        EXPECT_NEAR(contrast.at("median_contrast").get<double>(),
                    contrast.at("contrast").get<double>(), 0.05);
        // The slab's last voxel slopes down over a tenth of the view.
        EXPECT_NEAR(contrast.at("seen").get<double>(), 0.5, 0.15);
        EXPECT_NEAR(contrast.at("optical_depth").get<double>(), depth, 0.02 * depth);
        EXPECT_NEAR(contrast.at("brightness").get<double>(), std::exp(-depth), 0.04);
    }
}

TEST_F(DraftContrastTest, BelowFivePerCentThereIsAWarningThatSaysWhatToDo) {
    EXPECT_FALSE(warns(survey(0.1)));       // 9.5 %
    const ParsedJson faint = survey(0.03);  // 3 %
    ASSERT_TRUE(warns(faint)) << faint.at("warnings");
    const std::string line = faint.at("warnings").back().get<std::string>();
    EXPECT_NE(line.find("raise the ppm per unit"), std::string::npos) << line;
}

TEST_F(DraftContrastTest, WaterInFrontCounts) {
    // A lamp beside the camera lights the water before the slab, not it: what was plain to see is
    // lost in backscatter, however thick it is.
    survey(2.0);
    write("hazy.yaml", [this] {
        std::string text = read("slab.yaml");
        const auto replace = [&](const std::string& from, const std::string& to) {
            text.replace(text.find(from), from.size(), to);
        };
        replace("scattering: {b: 0, phase: {type: hg, g: 0}}",
                "scattering: {b: 1, phase: {type: hg, g: 0}}");
        replace("position: [60, 0, 56], direction: [-1, 0, -1]",
                "position: [0.3, 0, 6], direction: [0, 0, -1]");
        return text;
    }());
    const test::ProgramResult result = run({"info", "hazy.yaml", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ParsedJson json = ParsedJson::parse(result.out);
    EXPECT_LT(json.at("contrast").at("contrast").get<double>(), k_hardly_seen);
    EXPECT_TRUE(warns(json));
    EXPECT_NE(json.at("warnings").dump().find("move the lamps away from the camera"),
              std::string::npos)
        << json.at("warnings");
}

TEST_F(DraftContrastTest, WithoutVolumesOrLampsThereIsNone) {
    const test::ProgramResult result = run({"info", "scene.yaml", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(ParsedJson::parse(result.out).at("contrast").is_null());
}

}  // namespace
}  // namespace uw
