// ctest labels: unit
#include "edit/document/scene_text.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/input_files.h"
#include "core/scene/scene_desc.h"
#include "tests/support/edited_scenes.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

struct Case {
    const char* name;
    std::string text, path, value;
    std::string difference;
};

// The differences are written by hand.
const std::vector<Case>& changes() {
    static const std::vector<Case> cases{
        {"one number of a list", k_commented, "lamps.left.position", "[-1, -0.75, 0]",
         "-    position: [-1.0,  -0.5, 0]\t# x\ty z\n+    position: [-1.0,  -0.75, 0]\t# x\ty z\n"},
        {"one number by its index", k_commented, "lamps[1].position[2]", "0.125",
         "-    position: [1.0, -0.5, 0]\n+    position: [1.0, -0.5, 0.125]\n"},
        {"nested block map", k_commented, "lamps.left.profile.beam", "45",
         "-      beam: 60    # degrees\n+      beam: 45    # degrees\n"},
        {"key added to a block map", k_commented, "lamps.left.profile.edge", "5",
         "+      edge: 5\n"},
        {"key added between others", k_commented, "lamps.right.direction", "[0, 0.5, 1]",
         "+    direction: [0, 0.5, 1]\n"},
        {"map of another kind in a block", k_commented, "lamps.left.profile",
         "{type: cosine, fwhm: 80}",
         "-      type: spot  # not isotropic\n-      beam: 60    # degrees\n"
         "+      type: cosine  # not isotropic\n+      fwhm: 80\n"},
        {"lamp of another kind of brightness", k_commented, "lamps.right",
         "{\"frame\":\"world\",\"name\":\"right\",\"position\":[1.0,-0.5,0.0],\"power\":20}",
         "-    intensity: [50, 50, 50]\n+    power: 20\n+    frame: world\n"},
        {"scalar for a list", k_commented, "lamps.right.intensity", "7",
         "-    intensity: [50, 50, 50]\n+    intensity: 7\n"},
        {"list for a scalar", k_commented, "lamps.left.intensity", "[1, 2, 3]",
         "-    intensity: 50\n+    intensity: [1, 2, 3]\n"},
        {"section that is missing", k_commented, "water.preset", "jerlov-IB",
         "+water: {preset: jerlov-IB}\n"},
        {"Windows line ends", with_windows_lines(k_commented), "lamps.right.position",
         "[2, -0.5, 0]", "-    position: [1.0, -0.5, 0]\r\n+    position: [2, -0.5, 0]\r\n"},
        {"key added with Windows line ends", with_windows_lines(k_commented),
         "lamps.left.direction", "[0, 0, 1]", "+    direction: [0, 0, 1]\r\n"},
        {"no line break at the end", without_last_break(k_camera + "render: {samples: 4}\n"),
         "render.samples", "2", "-render: {samples: 4}+render: {samples: 2}"},
        {"key added where there is none", without_last_break(k_camera + "render:\n  samples: 4\n"),
         "render.integrator", "volume", "-  samples: 4+  samples: 4\n+  integrator: volume"},
        {"through an alias", k_anchored, "lamps.right.profile.beam", "30",
         "-    profile: *spot\n+    profile: {type: spot, beam: 30, edge: 5}\n"},
        {"alias as a whole", k_anchored, "lamps.right.intensity", "[1, 2, 3]",
         "-    intensity: *bright\n+    intensity: [1, 2, 3]\n"},
        {"alias in a flow map", k_anchored, "lamps.far.profile.edge", "1",
         "-  - {name: far, position: [3, 0, 0], profile: *spot, intensity: 9}\n"
         "+  - {name: far, position: [3, 0, 0], profile: {type: spot, beam: 60, edge: 1}, "
         "intensity: 9}\n"},
        {"anchor that others share", k_anchored, "lamps.left.profile.beam", "30",
         "-    profile: &spot {type: spot, beam: 60, edge: 5}  # shared\n"
         "+    profile: {type: spot, beam: 30, edge: 5}  # shared\n"
         "-    profile: *spot\n"
         "+    profile: &spot {type: spot, beam: 60, edge: 5}\n"},
        {"whole value of an anchor", k_anchored, "lamps.left.intensity", "4",
         "-    intensity: &bright [50, 50, 50]\n+    intensity: 4\n"
         "-    intensity: *bright\n+    intensity: &bright [50, 50, 50]\n"},
        {"anchor that nobody uses", k_camera + "render: &r {samples: 1}\n", "render.samples", "3",
         "-render: &r {samples: 1}\n+render: &r {samples: 3}\n"},
        {"flow list over several lines", k_flow, "lamps.right.profile.beam", "25",
         "-                                 beam: 20}}]  # two\n"
         "+                                 beam: 25}}]  # two\n"},
        {"key added to a flow map", k_flow, "lamps.left.profile", "{type: isotropic}",
         "-lamps: [{name: left, position: [-1, 0, 0], intensity: 1},  # one\n"
         "+lamps: [{name: left, position: [-1, 0, 0], profile: {type: isotropic}, intensity: "
         "1},  # one\n"},
        {"key added behind a flow map's last", k_flow, "water.salinity", "12",
         "-water: {preset: jerlov-II}\n+water: {preset: jerlov-II, salinity: 12}\n"},
        {"JSON", k_json, "lamps.left.frame", "world",
         "-    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5}\n"
         "+    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5, \"frame\": "
         "\"world\"}\n"},
        {"JSON number", k_json, "lamps[0].position[0]", "-0.5",
         "-    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5}\n"
         "+    {\"name\": \"left\", \"position\": [-0.5, 1, 2], \"intensity\": 5}\n"},
        {"quoted keys and texts",
         k_camera + "'water':\n  \"preset\" : \"jerlov-II\"   # clear\n  'salinity':  35\n",
         "water.preset", "jerlov-III",
         "-  \"preset\" : \"jerlov-II\"   # clear\n+  \"preset\" : \"jerlov-III\"   # clear\n"},
        {"keys and comments that are not ASCII",
         "# Größe: ½ m, 水\n" + k_camera + "water: {preset: 'jerlov-II', salinity: 30} # «eau»\n",
         "water.salinity", "31.5",
         "-water: {preset: 'jerlov-II', salinity: 30} # «eau»\n"
         "+water: {preset: 'jerlov-II', salinity: 31.5} # «eau»\n"},
        {"names that are not ASCII",
         k_camera + "render: {response: größe 水.csv, samples: 1}\t# Öl\n", "render.response",
         "'naïve: 2.csv'",
         "-render: {response: größe 水.csv, samples: 1}\t# Öl\n"
         "+render: {response: 'naïve: 2.csv', samples: 1}\t# Öl\n"},
        {"text in double quotes", k_camera + "render: {response: \"größe 水.csv\"}\n",
         "render.response", "naïve.csv",
         "-render: {response: \"größe 水.csv\"}\n+render: {response: \"naïve.csv\"}\n"},
        {"byte order mark",
         "\xEF\xBB\xBFuwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: "
         "{fov_x: 60}}\n",
         "camera.intrinsics.fov_x", "70",
         "-camera: {resolution: [64, 48], intrinsics: {fov_x: 60}}\n"
         "+camera: {resolution: [64, 48], intrinsics: {fov_x: 70}}\n"},
        {"list with each number on its line",
         k_camera + "water:\n  bands:\n    - 620  # red\n    - 540\n\n    - 450\n", "water.bands",
         "[620, 550, 450]", "-    - 540\n+    - 550\n"},
        {"shorter list", k_camera + "water:\n  bands:\n    - 620  # red\n    - 540\n    - 450\n",
         "water.bands", "[620, 540]", "-    - 450\n"},
        {"longer list", k_camera + "water:\n  bands:\n    - 620  # red\n    - 540  # green\n",
         "water.bands", "[620, 540, 450]", "+    - 450\n"},
        {"longer flow list", k_camera + "water: {bands: [620,540]}\n", "water.bands",
         "[620, 540, 450]", "-water: {bands: [620,540]}\n+water: {bands: [620,540,450]}\n"},
        {"dashes at the margin",
         k_camera + "lamps:\n- name: a\n  position: [0, 0, 0]\n  intensity: 1\n-\n"
                    "  name: b\n  position: [0, 0, 0]\n  intensity: 1\n",
         "lamps.b.frame", "world", "+  frame: world\n"},
        {"lamp that is named by its place",
         k_camera + "lamps:\n  - position: [0, 0, 0]\n    intensity: 1\n", "lamps.lamp1.intensity",
         "2", "-    intensity: 1\n+    intensity: 2\n"},
        {"value that is missing", k_camera + "water:   # to be filled in\nlamps: []\n",
         "water.preset", "jerlov-II",
         "-water:   # to be filled in\n+water: {preset: jerlov-II}   # to be filled in\n"},
        {"empty flow map", k_camera + "water: {}  # default\n", "water.salinity", "0",
         "-water: {}  # default\n+water: {salinity: 0}  # default\n"},
        {"documents with marks", "%YAML 1.2\n---\n" + k_camera + "render: {samples: 1}\n...\n",
         "render.samples", "8", "-render: {samples: 1}\n+render: {samples: 8}\n"},
        {"the same number spelled otherwise", k_commented, "lamps.left.position", "[-1, -5e-1, 0]",
         ""},
        {"a number computed", k_commented, "lamps.right.intensity[1]", "0.30000000000000004",
         "-    intensity: [50, 50, 50]\n+    intensity: [50, 0.30000000000000004, 50]\n"},
    };
    return cases;
}

SceneText as_scene(const std::string& text) {
    return {text, "scene.yaml"};
}

TEST(SceneText, ChangeTheirValuesOnlyAndMeanWhatSetMeans) {
    const SceneFolder folder;
    for (const char* name : {"größe 水.csv", "naïve: 2.csv", "naïve.csv"}) folder.write(name, "x");
    const auto hash_of = [&](const std::string& text, const std::vector<std::string>& overrides) {
        return read_scene(folder.write("scene.yaml", text), overrides).hash;
    };
    for (const Case& change : changes()) {
        SCOPED_TRACE(change.name);
        SceneText edited = as_scene(change.text);
        ASSERT_NO_THROW(edited.set(change.path, change.value));
        EXPECT_EQ(diff(change.text, edited.text()), change.difference);
        EXPECT_EQ(hash_of(edited.text(), {}),
                  hash_of(change.text, {change.path + "=" + change.value}));
    }
    EXPECT_GE(changes().size(), 20U);
}

// Every value of every scene, replaced by others of its kind and back again: the text is the same
// as before, unless an anchor had to be given up.
TEST(SceneText, OfAnyNumberAreUndoneByTheOppositeEdit) {
    std::size_t count = 0;
    const auto walk = [&](const auto& self, const SceneText& all, const ConfigNode& node,
                          const std::string& path) -> void {
        for (const ConfigNode::Entry& entry : node.entries)
            self(self, all, entry.value, path + (path.empty() ? "" : ".") + entry.key);
        for (std::size_t i = 0; i < node.items.size(); ++i)
            self(self, all, node.items[i], path + "[" + std::to_string(i) + "]");
        const bool is_value = node.kind == ConfigNode::Kind::scalar && !node.quoted &&
                              node.scalar.find_first_not_of("0123456789.-") == std::string::npos;
        if (!is_value || path == "uwvdb") return;
        SCOPED_TRACE(path);
        SceneText edited = all;
        ASSERT_NO_THROW(edited.set(path, "17.25"));
        EXPECT_EQ(edited.find(path)->scalar, "17.25");
        edited.set(path, node.scalar);
        ++count;
        const bool has_anchors = all.text().find('&') != std::string::npos;
        // 1.0 comes back as 1.
        const bool is_shortest =
            number_text(std::strtod(node.scalar.c_str(), nullptr)) == node.scalar;
        if (!has_anchors && is_shortest) {
            EXPECT_EQ(diff(all.text(), edited.text()), "");
        }
    };
    for (const Case& change : changes()) {
        SCOPED_TRACE(change.name);
        const SceneText all = as_scene(change.text);
        walk(walk, all, all.tree(), "");
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes")) {
        if (entry.path().extension() != ".yaml") continue;
        SCOPED_TRACE(entry.path());
        const SceneText all = as_scene(read_text_file(entry.path(), "", 1 << 20, "scene"));
        walk(walk, all, all.tree(), "");
    }
    EXPECT_GT(count, 300U);
}

TEST(SceneText, RoundNumbersAsTheyAreTold) {
    SceneText edited = as_scene(k_commented);
    edited.set("lamps.left.position", "[0.123456, -0.0000001, 1.99999]", {.decimals = 3});
    EXPECT_EQ(edited.find("lamps.left.position")->items[0].scalar, "0.123");
    EXPECT_EQ(diff(k_commented, edited.text()),
              "-    position: [-1.0,  -0.5, 0]\t# x\ty z\n"
              "+    position: [0.123,  0, 2]\t# x\ty z\n");
}

}  // namespace
}  // namespace uw::test
