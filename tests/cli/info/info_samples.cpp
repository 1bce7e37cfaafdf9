// ctest labels: unit
//
// The advice on files of other programs, and that its block renders as it is. The environment
// variable UWVDB_SAMPLES names their folder; where it is set, a file that is missing is a failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using Json = nlohmann::json;

struct Advice {
    const char* file;
    std::vector<std::string> map;
    const char* up;
    const char* centering;
    double scale;
    std::vector<const char*> parts;  // of the advice's lines
};

std::ostream& operator<<(std::ostream& out, const Advice& advice) {
    return out << advice.file;
}

constexpr const char* k_blender = "a cache of Blender's fluid solver";
constexpr const char* k_plausible = "Units are plausible";

const std::vector<Advice> k_samples{
    {"plume128_blosc_half_0020.vdb",
     {"density"},
     "z",
     "cell",
     1,
     {k_blender, k_plausible, "'shadow' has no value above 0"}},
    {"plume128_blosc_half_0030.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"plume128_blosc_half_0040.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"plume128long_blosc_half_0100.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"plume96_noise2_data_0030.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"plume96_noise2_noise_0030.vdb", {"density_noise"}, "z", "cell", 1, {k_blender}},
    {"plume96_none32_0024.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"plume96_zip32_0024.vdb", {"density"}, "z", "cell", 1, {k_blender, k_plausible}},
    {"fire64_blosc_half_0020.vdb",
     {"density"},
     "z",
     "cell",
     1,
     {k_blender, "'temperature', 'flame'", "'velocity' holds vectors"}},
    {"openvdb_smoke_houdini.vdb",
     {"density"},
     "y",
     "node",
     0.01,
     {"written by Houdini", "if these are centimetres"}},
    {"gaffer_sphere.vdb", {"density"}, "y", "node", 1, {"written by Houdini"}},
    {"oiio_sphere.vdb", {"density"}, "y", "node", 1, {k_plausible}},
    {"arnold_torus01.vdb", {"voxel_fog_density"}, "y", "node", 1, {"the name says density"}},
    {"arnold_grids.vdb",
     {"density[0]", "density[1]", "density[2]"},
     "y",
     "node",
     1,
     {"3 grids are called 'density'"}},
    {"arnold_pointgrid.vdb", {}, "y", "node", 1, {"Nothing to map", "holds points"}},
    {"openvdb_sphere_houdini.vdb", {}, "y", "node", 1, {"Nothing to map", "is a level set"}},
    {"oiio_sphereCd.vdb", {}, "y", "node", 1, {"Nothing to map", "holds vectors"}}};

std::string triple(const Json& p) {
    return "[" + std::to_string(p[0].get<double>()) + ", " + std::to_string(p[1].get<double>()) +
           ", " + std::to_string(p[2].get<double>()) + "]";
}

std::string scene_around(const Json& advice) {
    const Json& eye = advice.at("view").at("position");
    const Json& target = advice.at("view").at("look_at");
    const auto at = [](const Json& p, std::size_t i) { return p[i].get<double>(); };
    const double away = std::hypot(at(eye, 1) - at(target, 1), at(eye, 2) - at(target, 2));
    const Json lamp{at(target, 0) - 0.2 * away, at(target, 1) + 0.6 * away,
                    at(target, 2) + 0.2 * away};
    const Json wall{0.0, 0.0, at(target, 2) - 0.5 * away};
    return "uwvdb: 1\ncamera: {resolution: [48, 36], intrinsics: {fov_x: 50}, pose: {position: " +
           triple(eye) + ", look_at: " + triple(target) + "}}\nlamps: [{position: " + triple(lamp) +
           ", frame: world, intensity: 50}]\ngeometry: [{type: plane, point: " + triple(wall) +
           ", normal: [0, 0, 1]}]\nrender: {samples: 1}\n";
}

/// The folder of the samples, or where there is none, that of the project's own plume.
std::filesystem::path samples_folder() {
    const char* const folder = std::getenv("UWVDB_SAMPLES");
    return folder != nullptr ? folder : UWVDB_SOURCE_DIR "/assets/grids";
}

class InfoSamples : public test::CliTest, public testing::WithParamInterface<Advice> {};

TEST_P(InfoSamples, AreAdvisedRightlyAndTheBlockRenders) {
    const Advice& sample = GetParam();
    const std::filesystem::path file = samples_folder() / sample.file;
    ASSERT_TRUE(std::filesystem::exists(file)) << file << " is missing";
    const test::ProgramResult result = run({"info", file.string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json json = Json::parse(result.out);
    const Json& advice = json.at("advice");
    std::string lines;
    for (const Json& line : advice.at("lines")) lines += line.get<std::string>() + "\n";
    for (const char* part : sample.parts)
        EXPECT_NE(lines.find(part), std::string::npos) << part << "\n" << lines;
    EXPECT_EQ(advice.at("map"), Json(sample.map));
    if (sample.map.empty()) {
        EXPECT_TRUE(advice.at("volumes").is_null());
        return;
    }
    EXPECT_EQ(advice.at("up"), sample.up);
    EXPECT_EQ(advice.at("centering"), sample.centering);
    EXPECT_EQ(advice.at("scale"), sample.scale);

    // The camera that sees all of it, a lamp above and a wall behind, with and without the block.
    const std::string scene = scene_around(advice);
    write("scene.yaml", scene);
    const test::ImageFile without = render();
    write("scene.yaml", scene + advice.at("volumes").get<std::string>());
    const test::ImageFile with = render();
    test::expect_finite_and_lit(with);
    float change = 0, clearest = 1;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) {
            const float ratio = with.at("G", x, y) / without.at("G", x, y);
            change = std::max(change, std::abs(ratio - 1));
            clearest = std::min(
                clearest, with.at("transmittance.G", x, y) / without.at("transmittance.G", x, y));
        }
    // It is seen, and it is no black hole: e^-1.5 = 0.22 through its densest part from the side
    // that the advice speaks of; from others up to three times as deep, or as thin.
    EXPECT_GT(change, 0.2F);
    EXPECT_LT(clearest, 0.8F);
    EXPECT_GT(clearest, 0.01F);
}

std::vector<Advice> samples_where_available() {
    if (std::getenv("UWVDB_SAMPLES") != nullptr) return k_samples;
    std::vector<Advice> there;
    for (const Advice& sample : k_samples)
        if (std::filesystem::exists(samples_folder() / sample.file)) there.push_back(sample);
    return there;
}

INSTANTIATE_TEST_SUITE_P(Info, InfoSamples, testing::ValuesIn(samples_where_available()));

}  // namespace
}  // namespace uw
