// ctest labels: unit
#include "cli/render/run_stats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class Stats : public test::CliTest {};

TEST_F(Stats, SayHowLongEachStageTookAndOnWhat) {
    test::VdbFixture smoke;
    smoke.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    smoke.file_from_index = Affine::translation({-0.4, -0.4, 2}) * Affine::scale(Vector3(0.1));
    test::write_fixture(folder_ / "smoke.vdb", {smoke});
    write("scene.yaml", std::string(test::k_small_scene) +
                            "volumes: [{file: smoke.vdb, grids: {density: {large: 1}}}]\n");
    render({"--stats", "stats.json", "--irradiance-vdb", "light.vdb", "--samples", "3"});
    const nlohmann::json stats = nlohmann::json::parse(read("stats.json"));
    EXPECT_EQ(stats.at("scene"), "scene.yaml");
    EXPECT_EQ(stats.at("output"), "out.exr");
    double sum = 0;
    for (const char* stage :
         {"scene", "volumes", "geometry", "splat", "render", "write", "irradiance"}) {
        const double seconds = stats.at("seconds").at(stage);
        EXPECT_GE(seconds, 0) << stage;
        sum += seconds;
    }
    EXPECT_NEAR(stats.at("seconds").at("total"), sum, 1e-9);
    EXPECT_EQ(stats.at("pixels"), 33 * 19);
    EXPECT_EQ(stats.at("camera_rays"), 33 * 19 * 4);
    EXPECT_EQ(stats.at("active_voxels"), 512);
    EXPECT_EQ(stats.at("triangles"), 12);  // the box
    EXPECT_EQ(stats.at("lamps"), 1);
    EXPECT_EQ(stats.at("bands"), 3);
    EXPECT_GT(stats.at("splat_rays"), 0);
    EXPECT_GT(stats.at("grid_bytes"), 0);
    EXPECT_GT(stats.at("light_field_bytes"), 0);
    EXPECT_GT(stats.at("peak_memory_bytes"), 10'000'000);
}

}  // namespace
}  // namespace uw
