// ctest labels: unit
#include "core/scene/key_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml_document.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

constexpr std::string_view k_scene =
    "uwvdb: 1\n"
    "camera: {resolution: [64, 48], intrinsics: {fx: 50}}\n"
    "lamps:\n"
    "- {name: left, position: [0, 0, 0], intensity: 1}\n"
    "- {position: [0, 0, 0], intensity: 2}\n";

SceneDesc read_with(const std::vector<std::string>& overrides) {
    const test::SceneFolder folder;
    return read_scene(folder.write("scene.yaml", k_scene), overrides);
}

std::string override_error(const std::vector<std::string>& overrides) {
    try {
        read_with(overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no InputError";
}

TEST(SceneOverride, setsByIndexAndByName) {
    EXPECT_EQ(read_with({"lamps[1].intensity=[4, 5, 6]"}).lamps[1].intensity, (PerBand{4, 5, 6}));
    EXPECT_EQ(read_with({"lamps.left.intensity=7"}).lamps[0].intensity, (PerBand{7, 7, 7}));
    EXPECT_EQ(read_with({"lamps.lamp2.intensity=8"}).lamps[1].intensity, (PerBand{8, 8, 8}));
    EXPECT_EQ(read_with({"lamps[0].position[2]=3.5"}).lamps[0].position, (Point3{0, 0, 3.5}));
}

TEST(SceneOverride, makesMapsOnTheWay) {
    const SceneDesc scene = read_with(
        {"camera.pose.position=[0, 1, 2]", "camera.pose.look_at=[0, 1, 3]", "water.bands=[500]"});
    EXPECT_EQ(scene.camera.world_from_camera.offset(), Vector3(0, 1, 2));
    EXPECT_EQ(scene.water.bands_nm, std::vector<double>{500});
}

TEST(SceneOverride, replacesWholeValuesAndTheLastOneHolds) {
    const SceneDesc scene =
        read_with({"camera.intrinsics={fov_x: 60}", "render.samples=2", "render.samples=3"});
    EXPECT_NEAR(scene.camera.intrinsics.fx, 32 * std::sqrt(3.0), 1e-12);  // 32 / tan 30 deg
    EXPECT_EQ(scene.render.samples, 3);
}

TEST(SceneOverride, reachesGridsWithBracketsInTheirName) {
    const test::SceneFolder folder;
    folder.write("a.vdb", "x");
    const auto file = folder.write(
        "scene.yaml",
        std::string(k_scene) + "volumes:\n- {file: a.vdb, grids: {\"density[1]\": {small: 1}}}\n");
    const SceneDesc scene = read_scene(file, {"volumes[0].grids.density[1].small=9"});
    EXPECT_EQ(scene.volumes.at(0).grids.at(0).small_ppm, 9);
}

TEST(SceneOverride, starsStandForEveryEntry) {
    for (const char* text : {"lamps.*.intensity=[4, 5, 6]", "lamps[*].intensity=[4, 5, 6]"}) {
        const SceneDesc scene = read_with({text});
        EXPECT_EQ(scene.lamps[0].intensity, (PerBand{4, 5, 6}));
        EXPECT_EQ(scene.lamps[1].intensity, (PerBand{4, 5, 6}));
    }
    // Of numbers in lists, and keys that are not there yet.
    const SceneDesc scene = read_with({"lamps.*.position.*=2", "lamps.*.direction=[0, 1, 0]"});
    for (const LampDesc& lamp : scene.lamps) {
        EXPECT_EQ(lamp.position, (Point3{2, 2, 2}));
        EXPECT_EQ(lamp.direction, Vector3(0, 1, 0));
    }
    // What comes later holds.
    EXPECT_EQ(read_with({"lamps.*.intensity=3", "lamps.left.intensity=4"}).lamps[0].intensity,
              (PerBand{4, 4, 4}));
    EXPECT_EQ(read_with({"lamps.left.intensity=4", "lamps.*.intensity=3"}).lamps[0].intensity,
              (PerBand{3, 3, 3}));
    for (const char* nothing : {"volumes.*.up=z", "lamps.*.extent.*=1", "cameras.*.name=a"})
        EXPECT_NE(
            override_error({nothing}).find("the scene has nothing of that kind; * stands for"),
            std::string::npos)
            << override_error({nothing});
    EXPECT_NE(override_error({"lamps.*.intensty=3"}).find("did you mean 'intensity'?"),
              std::string::npos);
}

TEST(SceneOverride, quotesHoldWhatIsNoWord) {
    const test::SceneFolder folder;
    folder.write("a.vdb", "x");
    const auto file = folder.write(
        "scene.yaml",
        "uwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: {fx: 50}}\n"
        "lamps:\n- {name: a, position: [0, 0, 0], intensity: 1}\n"
        "- {name: b, position: [0, 0, 0], intensity: 1}\n"
        "volumes:\n- {file: a.vdb, grids: {'[0]': {small: 1}, 'a.b=c': {small: 1}, \"it's\": "
        "{small: 1}, '*': {small: 1}}}\n");
    const auto small_ppm = [&](const std::string& path) {
        const SceneDesc scene = read_scene(file, {path + "=9"});
        std::string changed;
        for (const GridMappingDesc& grid : scene.volumes.at(0).grids)
            if (grid.small_ppm == 9) changed += grid.grid + " ";
        return changed;
    };
    EXPECT_EQ(small_ppm("volumes[0].grids.\"a.b=c\".small"), "a.b=c ");
    EXPECT_EQ(small_ppm("volumes[0].grids.'a.b=c'.small"), "a.b=c ");
    EXPECT_EQ(small_ppm("volumes[0].grids.\"it's\".small"), "it's ");
    EXPECT_EQ(small_ppm("volumes[0].grids.\"*\".small"), "* ");
    EXPECT_EQ(small_ppm("volumes[0].grids.*.small"), "[0] a.b=c it's * ");
    // A grid without a name.
    for (const char* path : {"volumes[0].grids[0].small", "volumes[0].grids.[0].small",
                             "volumes[0].grids.'[0]'.small", "volumes.*.grids[0].small"})
        EXPECT_EQ(small_ppm(path), "[0] ") << path;
    const SceneDesc named = read_scene(file, {"lamps.\"a\".intensity=7"});
    EXPECT_EQ(named.lamps[0].intensity, (PerBand{7, 7, 7}));
    EXPECT_EQ(named.lamps[1].intensity, (PerBand{1, 1, 1}));
    for (const char* wrong : {"lamps.\"a.intensity=7", "lamps.'a'x=7", "''=7x"})
        EXPECT_THROW(read_scene(file, {wrong}), std::runtime_error) << wrong;
}

// The path that a step or an expansion is written as leads to the same place.
TEST(SceneOverride, pathsAreReadAsTheyAreWritten) {
    const ConfigNode tree = parse_yaml(
        "a:\n- {name: x.y, v: 1}\n- {v: 2}\n- {name: x.y, v: 3}\n- {name: '', v: 4}\n"
        "b: {p q: 1, '*': 2, 'c[1]': 3, '[0]': 4, \"d'e\": 5, 'f=g': 6}\n",
        "s.yaml");
    for (const auto& [path, count] : {std::pair("a.*.v", 4U), std::pair("b.*", 6U)}) {
        const auto paths = expanded_paths(tree, path, "test");
        ASSERT_EQ(paths.size(), count);
        for (std::size_t i = 0; i < count; ++i) {
            const ConfigNode* const found = find_value(tree, paths[i]);
            ASSERT_NE(found, nullptr) << paths[i];
            EXPECT_EQ(found->scalar, std::to_string(i + 1)) << paths[i];
        }
    }
    EXPECT_EQ(find_value(tree, "a.*.v"), nullptr);
    ConfigNode less = tree;
    EXPECT_TRUE(remove_value(less, "a.*.v"));
    for (const ConfigNode& item : less.find("a")->items) EXPECT_EQ(item.find("v"), nullptr);
    EXPECT_FALSE(remove_value(less, "a.*.v"));
    EXPECT_TRUE(is_part_of(tree, "a[2].v", "a.*"));
    EXPECT_TRUE(is_part_of(tree, "a.*.v", "a[2]"));
    EXPECT_TRUE(is_part_of(tree, "b.c[1]", "b.\"c[1]\""));
    EXPECT_FALSE(is_part_of(tree, "a.*.v", "b"));
    EXPECT_TRUE(overlap(tree, {"b.*", "a", "b.c[1]"}));
    EXPECT_FALSE(overlap(tree, {"b.c[1]", "a.*.v", "c.*.none.*"}));
    EXPECT_EQ(end_of_path("a.\"b=c\".d=e=f"), 9U);
    EXPECT_EQ(end_of_path("lamps[0].name=it's"), 13U);
    EXPECT_EQ(end_of_path("a.b"), std::string_view::npos);
}

TEST(SceneOverride, wrongFormIsWrongUsage) {
    std::string deep = "a";
    for (int i = 0; i < 100000; ++i) deep += ".a";
    EXPECT_THROW(read_with({deep + "=1"}), UsageError);
    for (const char* const text : {"render.samples", "=3", "a..b=3", "a.=3", "[0].x=3", "a[=3",
                                   "a[x]=3", "a[1]b=3", "a[-1]=3", ".a=3", ""}) {
        EXPECT_THROW(read_with({text}), UsageError) << text;
    }
}

TEST(SceneOverride, errorsNameTheOverrideAndTheHint) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"water.bnds=[1, 2, 3]",
         "--set water.bnds=[1, 2, 3]: water.bnds: unknown key; did you mean 'bands'?"},
        {"lamps[2].intensity=3",
         "--set lamps[2].intensity=3: lamps: has 2 entries, so there is no [2]; count from [0]"},
        {"lamps.left.positon[0]=3",
         "lamps.left.positon: is not in the scene, so there is no [0]; did you mean 'position'?"},
        {"volumes[0].up=z", "volumes: has 0 entries, so there is no [0]; set the whole list"},
        {"lamps.right.intensity=3",
         "lamps: is a list, and none of its 2 entries is called 'right'; there are: left, lamp2"},
        {"camera[0]=3", "camera: is a map, not a list; leave out [0]"},
        {"uwvdb.x=3", "uwvdb: is the number 1, so it has no key 'x'; set uwvdb itself"},
        {"render.samples=", "render.samples: has no value"},
        {"render.samples=abc", "--set render.samples=abc: render.samples: expected a number"},
        {"lamps=[1, 2", "--set lamps=[1, 2: end of sequence flow not found; correct"},
    };
    for (const auto& [text, expected] : cases) {
        EXPECT_NE(override_error({text}).find(expected), std::string::npos)
            << text << "\n  gave:     " << override_error({text}) << "\n  expected: " << expected;
    }
}

}  // namespace
}  // namespace uw
