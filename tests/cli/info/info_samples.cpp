// ctest labels: unit slow
//
// The advice on files of other programs; proposed_scenes.cpp renders it. The environment
// variable UWVDB_SAMPLES names their folder; where it is set, a file that is missing is a failure.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

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
    {"openvdb_sphere_houdini.vdb", {"ls_sphere"}, "y", "node", 1, {"Map 'ls_sphere' as fog"}},
    {"oiio_sphereCd.vdb", {}, "y", "node", 1, {"Nothing to map", "holds vectors"}}};

/// The folder of the samples, or where there is none, that of the project's own plume.
std::filesystem::path samples_folder() {
    const char* const folder = std::getenv("UWVDB_SAMPLES");
    return folder != nullptr ? folder : UWVDB_SOURCE_DIR "/assets/grids";
}

class InfoSamples : public test::CliTest, public testing::WithParamInterface<Advice> {};

TEST_P(InfoSamples, AreAdvisedRightly) {
    const Advice& sample = GetParam();
    const std::filesystem::path file = samples_folder() / sample.file;
    ASSERT_TRUE(std::filesystem::exists(file)) << file << " is missing";
    const test::ProgramResult result = run({"info", file.string(), "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ParsedJson json = ParsedJson::parse(result.out);
    const ParsedJson& advice = json.at("advice");
    std::string lines;
    for (const ParsedJson& line : advice.at("lines")) lines += line.get<std::string>() + "\n";
    for (const char* part : sample.parts)
        EXPECT_NE(lines.find(part), std::string::npos) << part << "\n" << lines;
    EXPECT_EQ(advice.at("map"), ParsedJson(sample.map));
    if (sample.map.empty()) {
        EXPECT_TRUE(advice.at("volumes").is_null());
        return;
    }
    EXPECT_EQ(advice.at("up"), sample.up);
    EXPECT_EQ(advice.at("centering"), sample.centering);
    EXPECT_EQ(advice.at("scale"), sample.scale);
    // The scene that is proposed can be read and its volume loaded, wherever that lies.
    write("proposed.yaml", advice.at("scene").get<std::string>());
    const test::ProgramResult rendered =
        run({"render", "proposed.yaml", "-o", "out.exr", "--size", "16x9", "--quality", "draft",
             "--set", "render.scattering=single"});
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
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
