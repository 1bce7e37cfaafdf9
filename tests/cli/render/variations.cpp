// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

constexpr const char* k_section = R"(variations:
  seed: 3
  keys:
    lamps.left.position[0]: {uniform: [-1, 0]}
    lamps[0].intensity: {log-uniform: [10, 100]}
    geometry[1].reflectance: {choice: [[0.7, 0.4, 0.2], 0.3]}
)";

/// "varied.yaml": the small scene with variations.
class RenderedVariations : public test::CliTest {
  protected:
    RenderedVariations() { write("varied.yaml", std::string(test::k_small_scene) + k_section); }

    test::ProgramResult expect_runs(const std::vector<std::string>& arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    void expect_same_bytes(const std::string& a, const std::string& b) const {
        EXPECT_TRUE(exists(a)) << a;
        EXPECT_TRUE(read(a) == read(b)) << a << " and " << b << " differ";
    }
    ParsedJson manifest(const std::string& name = "varied.variations.json") const {
        return ParsedJson::parse(read(name));
    }
};

TEST_F(RenderedVariations, EachIsToTheByteTheSceneWithItsValuesSet) {
    expect_runs({"render", "varied.yaml", "--variations", "3", "-o", "out/x.exr"});
    const ParsedJson variations = manifest("out/varied.variations.json").at("variations");
    ASSERT_EQ(variations.size(), 3U);
    for (const ParsedJson& variation : variations) {
        std::vector<std::string> arguments{"render", "varied.yaml", "-o", "alone.exr"};
        for (const std::string value : variation.at("set"))
            arguments.insert(arguments.end(), {"--set", value});
        expect_runs(arguments);
        const std::string image =
            "out/" + variation.at("images").at(0).at("file").get<std::string>();
        expect_same_bytes("alone.exr", image);
        std::string preview = image;
        expect_same_bytes("alone.png", preview.replace(preview.size() - 3, 3, "png"));
    }
    EXPECT_FALSE(read("out/x.v0000.exr") == read("out/x.v0001.exr"));
}

TEST_F(RenderedVariations, OneAloneHasTheBytesThatItHasAmongOthers) {
    expect_runs({"render", "varied.yaml", "--variations", "4", "--threads", "2"});
    EXPECT_TRUE(exists("varied.v0002.exr"));
    expect_runs({"render", "varied.yaml", "--variation", "3,2", "-o", "{variation}/x.exr",
                 "--threads", "1"});
    expect_same_bytes("0002/x.exr", "varied.v0002.exr");
    expect_same_bytes("0003/x.exr", "varied.v0003.exr");
    EXPECT_FALSE(exists("0001"));
}

TEST_F(RenderedVariations, AnotherKeyChangesNoneOfTheOthers) {
    expect_runs({"render", "varied.yaml", "--variations", "2", "-o", "a.png"});
    const ParsedJson before = manifest().at("variations");
    write("varied.yaml", std::string(test::k_small_scene) + k_section +
                             "    camera.pose.position[2]: {normal: [0, 0.1]}\n");
    expect_runs({"render", "varied.yaml", "--variations", "2", "-o", "a.png"});
    const ParsedJson after = manifest().at("variations");
    for (std::size_t i = 0; i < 2; ++i)
        for (const auto& [key, value] : before[i].at("values").items())
            EXPECT_EQ(after[i].at("values").at(key), value) << key;
}

TEST_F(RenderedVariations, TheManifestIsOfTheSetWhicheverOfItIsRendered) {
    expect_runs({"render", "varied.yaml", "--variations", "3", "-o", "all/x.exr"});
    expect_runs(
        {"render", "varied.yaml", "--variations", "3", "--variation", "1", "-o", "some/x.exr"});
    EXPECT_TRUE(exists("some/x.v0001.exr"));
    EXPECT_FALSE(exists("some/x.v0000.exr"));
    for (const char* name : {"varied.variations.csv", "varied.variations.json"})
        EXPECT_EQ(read(std::string("all/") + name), read(std::string("some/") + name));
    // One alone belongs to no set, and says what it draws.
    const test::ProgramResult one =
        expect_runs({"render", "varied.yaml", "--variation", "1", "-o", "one/x.exr"});
    EXPECT_FALSE(exists("one/varied.variations.csv"));
    EXPECT_NE(one.err.find("variation 1: lamps.left.position[0]=-0."), std::string::npos)
        << one.err;
}

TEST_F(RenderedVariations, TheManifestHasARowForEachImage) {
    write("moving.yaml", std::string(test::k_small_scene) + k_section);
    expect_runs({"render", "moving.yaml", "--variations", "2", "--frames", "4-5", "-o",
                 "out/####.{variation}.png", "--contact-sheet", "sheet.png"});
    const std::string csv = read("out/moving.variations.csv");
    EXPECT_TRUE(
        csv.starts_with("image,variation,frame,camera,scene_hash,lamps.left.position[0],"
                        "lamps[0].intensity,geometry[1].reflectance\n0004.0000.png,0,4,,"))
        << csv;
    EXPECT_EQ(test::line_count(csv), 5) << csv;
    EXPECT_NE(csv.find("\n0005.0001.png,1,5,,"), std::string::npos) << csv;
    EXPECT_TRUE(exists("out/0005.0001.png"));
}

TEST_F(RenderedVariations, ASetContinuesWhereItStopped) {
    const std::vector<std::string> all{"render", "varied.yaml", "--variations", "3", "--resume"};
    expect_runs({"render", "varied.yaml", "--variation", "0,2"});
    const std::string first = read("varied.v0000.exr");
    const test::ProgramResult rest = expect_runs(all);
    EXPECT_NE(rest.err.find("resume: 2 of 3 images are there already, 1 image left"),
              std::string::npos)
        << rest.err;
    EXPECT_TRUE(read("varied.v0000.exr") == first);
    EXPECT_TRUE(exists("varied.v0001.exr"));
    // Another seed, other images.
    std::vector<std::string> other = all;
    other.insert(other.end(), {"--set", "variations.seed=4"});
    EXPECT_EQ(expect_runs(other).err.find("resume:"), std::string::npos);
    EXPECT_FALSE(read("varied.v0000.exr") == first);
}

TEST_F(RenderedVariations, RigsHaveAnImageOfEachCameraInEach) {
    write("rig.yaml", R"(uwvdb: 1
cameras:
  - {name: left, resolution: [16, 9], intrinsics: {fov_x: 60}}
  - {name: right, resolution: [16, 9], intrinsics: {fov_x: 60}, pose: {position: [0.3, 0, 0], look_at: [0.3, 0, 1]}}
geometry: [{type: plane, point: [0, 0, 2], normal: [0, 0, -1]}]
lamps: [{name: a, position: [0, -0.3, 0], intensity: 50}]
variations: {keys: {lamps.a.intensity: {uniform: [10, 90]}}}
)");
    expect_runs({"render", "rig.yaml", "--variations", "2", "--stats", "stats.json"});
    for (const char* name : {"rig.v0000.left.exr", "rig.v0001.right.exr"})
        EXPECT_TRUE(exists(name)) << name;
    const ParsedJson images = manifest("rig.variations.json").at("variations").at(1).at("images");
    EXPECT_EQ(images.at(1).at("file"), "rig.v0001.right.exr");
    EXPECT_EQ(images.at(1).at("camera"), "right");
    EXPECT_EQ(ParsedJson::parse(read("stats.json")).at("frames").size(), 4U);
}

TEST_F(RenderedVariations, TheSceneItselfIsRenderedWithoutTheOption) {
    expect_runs({"render", "varied.yaml", "-o", "a.exr"});
    write("varied.yaml", test::k_small_scene);
    expect_runs({"render", "varied.yaml", "-o", "b.exr"});
    expect_same_bytes("a.exr", "b.exr");
}

TEST_F(RenderedVariations, AWrongValueIsReportedWithItsVariation) {
    const std::string scene = test::k_small_scene;
    write("typo.yaml", scene + "variations: {keys: {lamps.left.pwer: {uniform: [1, 2]}}}\n");
    expect_failure({"render", "typo.yaml", "--variations", "2"}, 3,
                   "typo.yaml:15:21: variation 0: lamps.left.pwer=1.");
    expect_failure({"render", "typo.yaml", "--variations", "2"}, 3, "did you mean 'power'?");
    expect_failure({"info", "typo.yaml"}, 3, "did you mean 'power'?");
    write("bad.yaml", scene + "variations: {keys: {lamps.left.intensity: {choice: [1, -1]}}}\n");
    expect_failure({"render", "bad.yaml", "--variations", "9"}, 3,
                   ": lamps.left.intensity=-1: lamps[0].intensity: must not be negative");
    // What shows elsewhere names all values.
    write("far.yaml",
          scene + "variations: {keys: {camera.pose.position: {choice: [[0, 0, 1]]}}}\n");
    expect_failure({"render", "far.yaml", "--variation", "7"}, 3,
                   "(variation 7: camera.pose.position=[0, 0, 1])");
    EXPECT_EQ(file_count(), 5U);  // the scenes alone
}

TEST_F(RenderedVariations, RequestsThatMakeNoSenseAreRefused) {
    expect_failure({"render", "scene.yaml", "--variations", "3"}, 2,
                   "--variations: the scene has none; add a section such as variations:");
    expect_failure({"render", "varied.yaml", "--variations", "3", "--variation", "3"}, 2,
                   "--variation 3: there are --variations 3, from 0 to 2");
    expect_failure({"render", "varied.yaml", "--variation", "x"}, 2,
                   "--variation: 'x': expected variations such as 7, 1-10 or 20-40:2");
    expect_failure({"render", "varied.yaml", "-o", "{variation}.exr"}, 2, "take {variation} out");
    expect_failure({"render", "varied.yaml", "--variations", "2", "--set",
                    "lamps[0].position=[0, 0, 0]", "--set", "lamps.left.intensity=3"},
                   2, "the variations draw lamps[0].intensity, so this would have no effect");
}

TEST_F(RenderedVariations, ACameraWithoutASeedThatVariesIsWarnedOf) {
    const std::string sensor =
        "camera.sensor={exposure: 0.1, gain: 1, pixel_pitch: 5e-6, quantum_efficiency: 0.5}";
    const std::string lens = "camera.lens={f_number: 2.8, focal_length: 0.006}";
    const std::vector<std::string> once{"render", "varied.yaml", "--variations", "1",
                                        "--set",  sensor,        "--set",        lens};
    const std::string part = "the camera's noise is the same in all of them";
    EXPECT_NE(expect_runs(once).err.find(part), std::string::npos);
    write("varied.yaml", std::string(test::k_small_scene) + k_section +
                             "    camera.sensor.seed: {integer: [0, 1000]}\n");
    EXPECT_EQ(expect_runs(once).err.find(part), std::string::npos);
}

}  // namespace
}  // namespace uw
