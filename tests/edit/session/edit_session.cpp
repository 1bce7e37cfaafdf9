// ctest labels: unit threads
#include "edit/session/edit_session.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/base/error.h"
#include "render/light_left_out.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/edit_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/scene_folder.h"

namespace {

using namespace uw;
using namespace uw::test;

class EditSessionTest : public testing::Test {
  protected:
    Json edit(const Json& change, const std::string& group = "") {
        session_.edit({{"revision", session_.state()["revision"]},
                       {"label", "change"},
                       {"group", group},
                       {"changes", Json::array({change})}});
        return session_.state();
    }
    Json set(const std::string& path, const Json& value) {
        return edit({{"op", "set"}, {"path", path}, {"value", value}});
    }
    // The outlines come with the first picture.
    Json state_but_outlines() const {
        Json all = session_.state();
        all.erase("outlines");
        return all;
    }
    std::string text() const {
        std::ifstream stream(file_);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    void wait_for_final_picture() {
        ASSERT_TRUE(eventually([&] {
            const auto picture = session_.picture();
            return picture && picture->quality == PictureQuality::final &&
                   picture->scene->revision == session_.state()["revision"];
        }));
    }

    SceneFolder folder_;
    std::filesystem::path file_ = folder_.write("rig.yaml", k_edit_scene);
    EditSession session_{file_};
};

TEST_F(EditSessionTest, ShowsTheScene) {
    const Json state = session_.state();
    EXPECT_EQ(state["scene"], "rig.yaml");
    EXPECT_EQ(state["unsaved"], false);
    EXPECT_TRUE(state["error"].is_null());
    ASSERT_EQ(state["lamps"].size(), 2U);
    const Json& left = state["lamps"][0];
    EXPECT_EQ(left["name"], "left");
    EXPECT_EQ(left["brightness"]["kind"], "intensity");
    EXPECT_EQ(left["band_intensity"], Json::parse("[40.0, 30.0, 20.0]"));
    EXPECT_EQ(left["profile"]["beam"], 60);
    EXPECT_EQ(left["frame"], "camera");
}

TEST_F(EditSessionTest, UndoesAndRedoes) {
    EXPECT_EQ(set("lamps.left.position", {0, 1, 1})["lamps"][0]["position"][1], 1);
    session_.undo();
    EXPECT_EQ(session_.state()["lamps"][0]["position"][1], 0);
    EXPECT_EQ(session_.state()["unsaved"], false);
    EXPECT_THROW(session_.undo(), ConflictError);
    session_.redo();
    EXPECT_EQ(session_.state()["lamps"][0]["position"][1], 1);
    EXPECT_THROW(session_.redo(), ConflictError);
}

TEST_F(EditSessionTest, OneGroupIsOneStep) {
    for (const double x : {0.1, 0.2, 0.3})
        edit({{"op", "set"}, {"path", "lamps.left.position"}, {"value", {x, 0, 1}}}, "drag-1");
    session_.undo();
    EXPECT_EQ(session_.state()["lamps"][0]["position"][0], -0.5);
    EXPECT_EQ(session_.state()["can_undo"], false);
}

TEST_F(EditSessionTest, AllChangesOfARequestOrNone) {
    const Json before = state_but_outlines();
    const Json good = {{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 1, 1}}};
    const Json bad = {{"op", "set"}, {"path", "water.preset"}, {"value", "puddle"}};
    EXPECT_THROW(session_.edit({{"revision", before["revision"]}, {"changes", {good, bad}}}),
                 InputError);
    EXPECT_EQ(state_but_outlines(), before);
}

TEST_F(EditSessionTest, RefusesWhatIsNotOfTheForm) {
    const Json before = state_but_outlines();
    const auto revision = before["revision"];
    for (const char* change :
         {R"({"op": "explode"})", R"({"op": "set"})", R"({"op": "set", "path": 1, "value": 2})",
          R"({"op": "remove_lamp", "lamp": "none"})", R"("set")",
          R"({"op": "move_lamp", "lamp": "left", "pixel": [1]})",
          R"({"op": "move_lamp", "lamp": "left", "pixel": [1, 2], "keep": "x"})",
          R"({"op": "move_lamp", "lamp": "left"})", R"({"op": "lamp_on", "lamp": "left", "on": 1})",
          R"({"op": "set", "path": "geometry[0].file", "value": "/etc/passwd"})",
          R"({"op": "set", "path": "lamps.left.profile",
              "value": {"type": "ies", "file": "../../x.ies"}})"})
        EXPECT_THROW(edit(Json::parse(change)), UsageError) << change;
    EXPECT_THROW(session_.edit({{"changes", Json::array()}}), UsageError);
    EXPECT_THROW(session_.edit({{"revision", revision}, {"changes", 3}}), UsageError);
    EXPECT_EQ(state_but_outlines(), before);
}

TEST_F(EditSessionTest, AnotherWindowsChangeOfTheSameIsNotLost) {
    const auto old = session_.state()["revision"];
    set("lamps.left.position", {0, 1, 1});
    const auto late = [&](const std::string& path) {
        session_.edit({{"revision", old},
                       {"changes", {{{"op", "set"}, {"path", path}, {"value", {0, 2, 1}}}}}});
    };
    EXPECT_THROW(late("lamps.left.position"), ConflictError);
    late("lamps.right.position");
    EXPECT_EQ(session_.state()["lamps"][0]["position"][1], 1);
    EXPECT_EQ(session_.state()["lamps"][1]["position"][1], 2);
    session_.undo();
    EXPECT_THROW(late("lamps.right.position"), ConflictError);
}

TEST_F(EditSessionTest, ALampThatIsDraggedIsSeenThere) {
    for (const char* keep : {"distance", "z"}) {
        const Json state =
            edit({{"op", "move_lamp"}, {"lamp", "left"}, {"pixel", {60.5, 20.25}}, {"keep", keep}});
        const Json& handle = state["lamps"][0]["handle"];
        // Positions are written to 0.1 mm: 0.05 mm at 0.7 m is 0.007 of these pixels.
        EXPECT_NEAR(handle["pixel"][0].get<double>(), 60.5, 0.01) << keep;
        EXPECT_NEAR(handle["pixel"][1].get<double>(), 20.25, 0.01) << keep;
    }
    const Json aimed = edit({{"op", "aim_lamp"}, {"lamp", "left"}, {"pixel", {40, 30}}});
    EXPECT_NEAR(aimed["lamps"][0]["axis_handle"]["pixel"][0].get<double>(), 40, 0.02);
    EXPECT_NEAR(aimed["lamps"][0]["axis_handle"]["pixel"][1].get<double>(), 30, 0.02);
}

TEST_F(EditSessionTest, MirrorsDuplicatesRenamesAndRemovesLamps) {
    edit({{"op", "remove_lamp"}, {"lamp", "right"}});
    Json state = edit({{"op", "mirror_lamp"}, {"lamp", "left"}, {"copy", true}});
    ASSERT_EQ(state["lamps"].size(), 2U);
    EXPECT_EQ(state["lamps"][1]["name"], "right");
    EXPECT_EQ(state["lamps"][1]["position"][0], 0.5);
    EXPECT_EQ(state["lamps"][1]["brightness"], state["lamps"][0]["brightness"]);
    state = edit({{"op", "duplicate_lamp"}, {"lamp", "left"}});
    EXPECT_EQ(state["lamps"][2]["name"], "left2");
    state = edit({{"op", "rename_lamp"}, {"lamp", "left2"}, {"name", "top"}});
    EXPECT_EQ(state["lamps"][2]["name"], "top");
    state = edit({{"op", "lamp_on"}, {"lamp", "top"}, {"on", false}});
    EXPECT_EQ(state["lamps"][2]["on"], false);
    EXPECT_EQ(state["lamps"][0]["on"], true);
}

TEST_F(EditSessionTest, SavesTheTextWithItsComments) {
    set("lamps.left.position", {0, 1, 1});
    session_.save(Json::object());
    EXPECT_EQ(session_.state()["unsaved"], false);
    std::string expected = k_edit_scene;
    const std::string before = "[-0.5, 0, 0.6]";
    expected.replace(expected.find(before), before.size(), "[0, 1, 1]");
    EXPECT_EQ(text(), expected);
}

TEST_F(EditSessionTest, DoesNotOverwriteWhatOthersHaveWritten) {
    set("lamps.left.position", {0, 1, 1});
    const std::string theirs = std::string(k_edit_scene) + "# theirs\n";
    folder_.write("rig.yaml", theirs);
    EXPECT_TRUE(eventually([&] { return session_.state()["changed_on_disk"] == true; }));
    EXPECT_THROW(session_.save(Json::object()), ConflictError);
    EXPECT_EQ(text(), theirs);
    session_.save({{"overwrite", true}});
    EXPECT_NE(text(), theirs);
    EXPECT_EQ(session_.state()["changed_on_disk"], false);
}

TEST_F(EditSessionTest, ADeletedFileIsSavedAgain) {
    std::filesystem::remove(file_);
    ASSERT_TRUE(eventually([&] { return session_.state()["deleted_on_disk"] == true; }));
    EXPECT_EQ(session_.state()["changed_on_disk"], false);
    EXPECT_TRUE(session_.state()["error"].is_null());
    session_.save(Json::object());
    EXPECT_EQ(text(), k_edit_scene);
    EXPECT_EQ(session_.state()["deleted_on_disk"], false);
}

TEST_F(EditSessionTest, SavesAsAnotherFileOfTheFolderOnly) {
    for (const char* name : {"../x.yaml", "/tmp/x.yaml", "x.txt", ".x.yaml", "", "a/b.yaml"})
        EXPECT_THROW(session_.save_as({{"file", name}}), UsageError) << name;
    folder_.write("there.yaml", "other\n");
    EXPECT_THROW(session_.save_as({{"file", "there.yaml"}}), ConflictError);
    session_.save_as({{"file", "new.yaml"}});
    EXPECT_EQ(session_.state()["scene"], "new.yaml");
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "new.yaml"));
}

TEST_F(EditSessionTest, ASceneThatBreaksOnDiskIsMended) {
    folder_.write("rig.yaml", std::string(k_edit_scene) + "nonsense: 1\n");
    ASSERT_TRUE(eventually([&] { return !session_.state()["error"].is_null(); }));
    const Json broken = session_.state();
    EXPECT_EQ(broken["error"]["line"], 1 + line_count(k_edit_scene));
    EXPECT_EQ(broken["error"]["column"], 1);
    // The last good one stays.
    EXPECT_EQ(broken["lamps"].size(), 2U);
    std::string mended = k_edit_scene;
    mended.replace(mended.find("name: left"), 10, "name: port");
    folder_.write("rig.yaml", mended);
    EXPECT_TRUE(eventually([&] { return session_.state()["error"].is_null(); }));
    EXPECT_EQ(session_.state()["lamps"][0]["name"], "port");
}

TEST(EditSessionStart, ASceneThatIsBrokenAtFirstIsMended) {
    const SceneFolder folder;
    const auto file = folder.write("rig.yaml", "uwvdb: 1\nlamps: [\n");
    EditSession session(file);
    EXPECT_FALSE(session.state()["error"].is_null());
    EXPECT_THROW(session.undo(), ConflictError);
    EXPECT_THROW(session.edit({{"revision", 0}, {"changes", {{{"op", "set"}}}}}), ConflictError);
    folder.write("rig.yaml", k_edit_scene);
    EXPECT_TRUE(eventually([&] { return session.state()["error"].is_null(); }));
    EXPECT_EQ(session.state()["lamps"].size(), 2U);
    EXPECT_THROW(EditSession(folder.path() / "none.yaml"), IoError);
}

TEST_F(EditSessionTest, BrightnessAndNamesRenderNothing) {
    wait_for_final_picture();
    const auto before = session_.picture();
    const std::size_t rendered = session_.pictures().rendered();
    set("lamps.left.intensity", {1, 2, 3});
    edit({{"op", "lamp_on"}, {"lamp", "right"}, {"on", false}});
    edit({{"op", "rename_lamp"}, {"lamp", "left"}, {"name", "port"}});
    wait_for_final_picture();
    EXPECT_EQ(session_.pictures().rendered(), rendered);
    EXPECT_EQ(session_.picture()->number, before->number);
    EXPECT_EQ(session_.picture()->lamps, before->lamps);
}

// The note is the one of `uwvdb render`: it is there once the picture is, and not with all light.
TEST_F(EditSessionTest, SaysWhatSingleScatteringLeavesOut) {
    Renderer renderer;
    renderer.set_scene(load_scene(file_, {{"water.preset=jerlov-5C"}}));
    const auto left_out = renderer.light_left_out();
    const std::string note = left_out_note(renderer.assembled(), left_out).value_or("");
    ASSERT_NE(note, "");
    EXPECT_NE(session_.state()["light_note"], note);
    set("water.preset", "jerlov-5C");
    EXPECT_TRUE(eventually([&] { return session_.state()["light_note"] == note; }));
    set("render.scattering", "multiple");
    EXPECT_TRUE(eventually([&] { return session_.state()["light_note"].is_null(); }));
}

TEST(EditSessionLamps, ASunIsDimmedAndSwitchedOffButNotMoved) {
    std::string scene = k_edit_scene;
    scene.insert(scene.find("geometry:"), "  surface: {point: [0, -5, 0], normal: [0, -1, 0]}\n");
    scene.insert(scene.find("  - name: right"),
                 "  - {name: sun, type: sun, direction: [0, 1, 0.2], irradiance: [3, 2, 1]}\n");
    const SceneFolder folder;
    EditSession session(folder.write("rig.yaml", scene));
    ASSERT_TRUE(session.state()["error"].is_null()) << session.state()["error"];
    const auto edit = [&](const Json& change) {
        session.edit({{"revision", session.state()["revision"]}, {"changes", {change}}});
        return session.state()["lamps"][1];
    };
    EXPECT_EQ(session.state()["lamps"][1]["editable"], true);
    const auto set = [&](const char* path, const Json& value) {
        return edit({{"op", "set"}, {"path", path}, {"value", value}});
    };
    EXPECT_EQ(set("lamps.sun.irradiance", {6, 4, 2})["band_intensity"], Json({6.0, 4.0, 2.0}));
    EXPECT_EQ(set("lamps.sun.direction", {0, 1, 0})["direction"], Json({0.0, 1.0, 0.0}));
    EXPECT_EQ(session.state()["lamps"][1]["sun"]["angle"], 0);
    EXPECT_EQ(set("lamps.sun.angle", 0.5)["sun"]["angle"], 0.5);
    EXPECT_THROW(set("lamps.sun.angle", 91), InputError);
    EXPECT_EQ(session.state()["lamps"][1]["sun"]["angle"], 0.5);
    EXPECT_TRUE(session.state()["lamps"][0]["sun"].is_null());
    EXPECT_EQ(edit({{"op", "lamp_on"}, {"lamp", "sun"}, {"on", false}})["on"], false);
    for (const Json& change : {Json{{"op", "move_lamp"}, {"lamp", "sun"}, {"world", {0, 0, 0}}},
                               Json{{"op", "aim_lamp"}, {"lamp", "sun"}, {"world", {0, 0, 0}}},
                               Json{{"op", "mirror_lamp"}, {"lamp", "sun"}}})
        EXPECT_THROW(edit(change), UsageError) << change;
}

TEST(EditSessionChoice, ShowsEachCameraOfARig) {
    EditSession session(std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes/stereo.yaml");
    const Json before = session.state();
    ASSERT_EQ(before["cameras"].size(), 2U);
    EXPECT_EQ(before["camera"]["name"], before["cameras"][0]);
    EXPECT_TRUE(before["moment"].is_null());
    session.show({{"camera", before["cameras"][1]}});
    const Json after = session.state();
    EXPECT_EQ(after["camera"]["name"], before["cameras"][1]);
    EXPECT_NE(after["camera"]["position"], before["camera"]["position"]);
    EXPECT_EQ(after["lamps"][0]["world_position"], before["lamps"][0]["world_position"]);
    EXPECT_EQ(after["unsaved"], false);
    // A change stays with that camera.
    const Json change{{"op", "lamp_on"}, {"lamp", after["lamps"][0]["name"]}, {"on", false}};
    session.edit({{"revision", after["revision"]}, {"changes", {change}}});
    EXPECT_EQ(session.state()["camera"], after["camera"]);
    EXPECT_THROW(session.show({{"camera", "none"}}), UsageError);
    EXPECT_THROW(session.show({{"frame", 1}}), UsageError);
    EXPECT_EQ(session.state()["camera"], after["camera"]);
}

TEST(EditSessionChoice, ShowsEachFrameOfWhatMoves) {
    EditSession session(std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes/dive.yaml");
    const Json before = session.state();
    const int last = before["moment"]["last"];
    ASSERT_GT(last, 0);
    session.show({{"frame", last}});
    const Json after = session.state();
    EXPECT_EQ(after["moment"]["frame"], last);
    EXPECT_GT(after["moment"]["time"], before["moment"]["time"]);
    EXPECT_NE(after["camera"]["position"], before["camera"]["position"]);
    EXPECT_THROW(session.show({{"frame", last + 1}}), UsageError);
}

// The changes are those that the page sends. Nothing of another kind is left in the file.
TEST_F(EditSessionTest, APointBecomesARectangleADiskAndAPointAgain) {
    const auto become = [&](const Json& keys) {
        Json changes = Json::array();
        for (const auto& [key, value] : keys.items())
            changes.push_back({{"op", "set"}, {"path", "lamps.right." + key}, {"value", value}});
        session_.edit({{"revision", session_.state()["revision"]}, {"changes", changes}});
        return session_.state()["lamps"][1];
    };
    const Json before = session_.state()["lamps"][1];
    ASSERT_TRUE(before["extent"].is_null());
    const Json none{{"type", nullptr},   {"width", nullptr},  {"height", nullptr},
                    {"radius", nullptr}, {"rotate", nullptr}, {"samples", nullptr}};
    Json keys = none;
    keys.update({{"type", "rectangle"}, {"width", 0.2}, {"height", 0.1}, {"samples", 64}});
    EXPECT_EQ(become(keys)["extent"], Json({{"type", "rectangle"},
                                            {"width", 0.2},
                                            {"height", 0.1},
                                            {"rotate", 0.0},
                                            {"samples", 64}}));
    keys = none;
    keys.update({{"type", "disk"}, {"radius", 0.1}, {"samples", 64}});
    EXPECT_EQ(become(keys)["extent"], Json({{"type", "disk"}, {"radius", 0.1}, {"samples", 64}}));
    const Json after = become(none);
    EXPECT_TRUE(after["extent"].is_null());
    EXPECT_EQ(after["profile"], before["profile"]);
    EXPECT_EQ(after["band_intensity"], before["band_intensity"]);
    session_.save(Json::object());
    EXPECT_EQ(text(), k_edit_scene);
    // Only a key may be missing, not what it is of.
    EXPECT_THROW(set("lamps.none.type", nullptr), InputError);
}

TEST(EditSessionLamps, ALampHasASizeThatIsSet) {
    std::string scene = k_edit_scene;
    scene.insert(scene.find("    intensity: [10"),
                 "    type: rectangle\n    width: 0.2\n    height: 0.1\n");
    const SceneFolder folder;
    EditSession session(folder.write("rig.yaml", scene));
    ASSERT_TRUE(session.state()["error"].is_null()) << session.state()["error"];
    session.edit({{"revision", session.state()["revision"]},
                  {"changes", {{{"op", "set"}, {"path", "lamps.right.width"}, {"value", 0.3}}}}});
    const Json extent = session.state()["lamps"][1]["extent"];
    EXPECT_EQ(extent["type"], "rectangle");
    EXPECT_EQ(extent["width"], 0.3);
    EXPECT_EQ(extent["height"], 0.1);
    EXPECT_TRUE(session.state()["lamps"][0]["extent"].is_null());
}

TEST_F(EditSessionTest, OnlyTheLampThatMovedIsRendered) {
    wait_for_final_picture();
    const auto before = session_.picture();
    set("lamps.left.position", {0, 0.2, 0.6});
    wait_for_final_picture();
    const auto after = session_.picture();
    EXPECT_NE(after->lamps[0], before->lamps[0]);
    EXPECT_EQ(after->lamps[1], before->lamps[1]);
    EXPECT_EQ(after->unlit, before->unlit);
}

}  // namespace
