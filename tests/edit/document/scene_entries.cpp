// ctest labels: unit
#include "edit/document/scene_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "tests/support/edited_scenes.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

SceneText scene(const std::string& text) {
    return {text, "scene.yaml"};
}

TEST(SceneEntries, RemoveEntriesAndKeys) {
    struct Removal {
        std::string text, path, difference;
    };
    const std::string block = "lamps:\n  - name: a\n    position: [0, 0, 0]\n    intensity: 1\n";
    for (const Removal& removal : std::vector<Removal>{
             {k_commented, "lamps.left",
              "-  - name: left   # port side\n-    position: [-1.0,  -0.5, 0]\t# x\ty z\n"
              "-    profile:\n-      type: spot  # not isotropic\n-      beam: 60    # degrees\n"
              "-    intensity: 50\n"},
             {k_commented, "lamps.right",
              "-  - name: right\n-    position: [1.0, -0.5, 0]\n-    intensity: [50, 50, 50]\n"},
             {k_commented, "lamps.left.profile",
              "-    profile:\n-      type: spot  # not isotropic\n-      beam: 60    # degrees\n"},
             {k_commented, "lamps.right.name",
              "-  - name: right\n-    position: [1.0, -0.5, 0]\n"
              "+  - position: [1.0, -0.5, 0]\n"},
             {k_flow, "lamps[0]",
              "-lamps: [{name: left, position: [-1, 0, 0], intensity: 1},  # one\n"
              "-        {name: right, position: [1, 0, 0],\n"
              "+lamps: [{name: right, position: [1, 0, 0],\n"},
             {k_flow, "lamps.right.profile.beam",
              "-         intensity: 2, profile: {type: spot, # narrow\n"
              "-                                 beam: 20}}]  # two\n"
              "+         intensity: 2, profile: {type: spot # narrow\n"
              "+                                 }}]  # two\n"},
             {k_flow, "water", "-water: {preset: jerlov-II}\n"},
             {k_flow, "water.preset", "-water: {preset: jerlov-II}\n+water: {}\n"},
             {k_camera + block, "lamps.a",
              "-lamps:\n-  - name: a\n-    position: [0, 0, 0]\n-    intensity: 1\n+lamps: []\n"},
             {without_last_break(k_camera + block), "lamps.a.intensity",
              "-    position: [0, 0, 0]\n-    intensity: 1+    position: [0, 0, 0]"},
             {k_anchored, "lamps.right.profile.edge",
              "-    profile: *spot\n+    profile: {type: spot, beam: 60}\n"},
             {k_anchored, "lamps.left",
              "-  - name: left\n-    position: [-1, 0, 0]\n"
              "-    profile: &spot {type: spot, beam: 60, edge: 5}  # shared\n"
              "-    intensity: &bright [50, 50, 50]\n"
              "-    profile: *spot\n-    intensity: *bright\n"
              "+    profile: &spot {type: spot, beam: 60, edge: 5}\n"
              "+    intensity: &bright [50, 50, 50]\n"}}) {
        SCOPED_TRACE(removal.path);
        SceneText edited = scene(removal.text);
        ASSERT_NO_THROW(edited.remove(removal.path));
        EXPECT_EQ(diff(removal.text, edited.text()), removal.difference);
    }
}

TEST(SceneEntries, AppendLampsInTheStyleOfTheFile) {
    const SceneFolder folder;
    const std::string lamp =
        "{\"intensity\": 3, \"name\": \"new\", \"position\": [0, 0.5, 1], "
        "\"profile\": {\"beam\": 40, \"type\": \"spot\"}}";
    struct Addition {
        std::string text, like, difference;
    };
    for (const Addition& addition : std::vector<Addition>{
             {k_commented, "",
              "+  - name: new\n+    position: [0, 0.5, 1]\n+    profile: {type: spot, beam: 40}\n"
              "+    intensity: 3\n"},
             {k_commented, "lamps.left",
              "+  - name: new\n+    position: [0, 0.5, 1]\n+    profile:\n+      type: spot\n"
              "+      beam: 40\n+    intensity: 3\n"},
             {with_windows_lines(k_commented), "",
              "+  - name: new\r\n+    position: [0, 0.5, 1]\r\n"
              "+    profile: {type: spot, beam: 40}\r\n+    intensity: 3\r\n"},
             {k_anchored, "",
              "+  - {name: new, position: [0, 0.5, 1], profile: {type: spot, beam: 40}, "
              "intensity: 3}\n"},
             {k_flow, "",
              "-                                 beam: 20}}]  # two\n"
              "+                                 beam: 20}}, {name: new, position: [0, 0.5, 1], "
              "profile: {type: spot, beam: 40}, intensity: 3}]  # two\n"},
             {k_camera, "",
              "+lamps:\n+  - name: new\n+    position: [0, 0.5, 1]\n"
              "+    profile: {type: spot, beam: 40}\n+    intensity: 3\n"},
             {k_camera + "lamps: []  # none yet\nrender: {samples: 1}\n", "",
              "-lamps: []  # none yet\n+lamps:  # none yet\n+  - name: new\n"
              "+    position: [0, 0.5, 1]\n+    profile: {type: spot, beam: 40}\n"
              "+    intensity: 3\n"},
             {without_last_break(k_camera + "lamps:\n  - name: a\n    position: [0, 0, 0]\n"
                                            "    intensity: 1\n\n  - name: b\n"
                                            "    position: [0, 0, 0]\n    intensity: 1\n"),
              "",
              "-    intensity: 1+    intensity: 1\n+\n+  - name: new\n+    position: [0, 0.5, 1]\n"
              "+    profile: {type: spot, beam: 40}\n+    intensity: 3"},
             {k_json, "",
              "-    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5}\n"
              "+    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5}, {\"name\": "
              "\"new\", \"position\": [0, 0.5, 1], \"profile\": {\"type\": \"spot\", \"beam\": "
              "40}, \"intensity\": 3}\n"}}) {
        SCOPED_TRACE(addition.text + addition.like);
        SceneText edited = scene(addition.text);
        ASSERT_NO_THROW(edited.append("lamps", lamp, addition.like));
        EXPECT_EQ(diff(addition.text, edited.text()), addition.difference);
        const SceneDesc desc = read_scene_text(edited.text(), folder.path() / "scene.yaml");
        EXPECT_EQ(desc.lamps.back().name, "new");
        EXPECT_EQ(desc.lamps.size(),
                  read_scene_text(addition.text, folder.path() / "scene.yaml").lamps.size() + 1);
    }
}

TEST(SceneEntries, DuplicateAndRenameLamps) {
    SceneText edited = scene(k_commented);
    edited.duplicate("lamps.left", "upper");
    EXPECT_EQ(diff(k_commented, edited.text()),
              "+  - name: upper\n+    position: [-1.0, -0.5, 0]\n+    profile:\n"
              "+      type: spot\n+      beam: 60\n+    intensity: 50\n");
    edited = scene(k_anchored);
    edited.duplicate("lamps.right", "upper");
    EXPECT_EQ(diff(k_anchored, edited.text()),
              "+  - name: upper\n+    position: [1, 0, 0]\n+    profile: *spot\n"
              "+    intensity: *bright\n");
    edited = scene(k_commented);
    edited.rename("lamps.left", "port");
    EXPECT_EQ(diff(k_commented, edited.text()),
              "-  - name: left   # port side\n+  - name: port   # port side\n");
    const std::string unnamed = k_camera + "lamps:\n  - position: [0, 0, 0]\n    intensity: 1\n";
    edited = scene(unnamed);
    edited.rename("lamps.lamp1", "first");
    EXPECT_EQ(diff(unnamed, edited.text()),
              "-  - position: [0, 0, 0]\n+  - name: first\n+    position: [0, 0, 0]\n");
}

TEST(SceneEntries, ThatAreRefusedChangeNothing) {
    const std::string gltf = k_camera +
                             "geometry:\n  - {file: sea.glb, camera: true, lamps: all}\n"
                             "lamps:\n  - {name: own, position: [0, 0, 0], intensity: 1}\n";
    SceneText edited = scene(gltf);
    EXPECT_EQ(message_of<InputError>([&] { edited.set("lamps.Sun.position", "[0, 0, 0]"); }),
              "scene.yaml:4:5: lamps.Sun: is not in this file: 'lamps' asks for what is in "
              "sea.glb; change it there, with the program that made it");
    EXPECT_EQ(message_of<InputError>([&] { edited.set("camera.pose.position", "[0, 0, 0]"); }),
              "scene.yaml:4:5: camera.pose: is not in this file: 'camera' asks for what is in "
              "sea.glb; change it there, with the program that made it");
    EXPECT_NE(message_of<InputError>([&] { edited.remove("lamps.Sun"); }).find("sea.glb"),
              std::string::npos);
    EXPECT_NE(message_of<InputError>([&] {
                  edited.set("lamps[3].position", "1");
              }).find("has 1 entry, so there is no [3]"),
              std::string::npos);
    EXPECT_NE(message_of<InputError>([&] { edited.remove("water.preset"); }).find("no such key"),
              std::string::npos);
    EXPECT_NE(message_of<InputError>([&] { edited.set("lamps.own.position", "[1, 2"); }).size(),
              0U);
    EXPECT_NE(message_of<UsageError>([&] { edited.set("lamps..own", "1"); }).size(), 0U);
    EXPECT_NE(message_of<UsageError>([&] { edited.remove("[0]"); }).size(), 0U);
    EXPECT_EQ(edited.text(), gltf);
}

}  // namespace
}  // namespace uw::test
