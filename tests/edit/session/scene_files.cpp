// ctest labels: unit
#include <gtest/gtest.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "edit/session/edit_session.h"
#include "tests/support/edit_scene.h"
#include "tests/support/scene_folder.h"

namespace {

using namespace uw;
using namespace uw::test;
namespace fs = std::filesystem;

constexpr const char* k_spectrum = "wavelength_nm,power\n400,1\n700,2\n";

// A place where a scene names a file; NAME stands for it.
struct FilePlace {
    std::string path, value;
};

// All that input_files collects, as text and as map where both are possible; what variations draw;
// and a key that no scene has: which ones name files is not asked.
const std::vector<FilePlace> k_file_places{
    {"camera.calibration", R"("NAME")"},
    {"camera.calibration", R"({"file": "NAME", "camera": "left"})"},
    {"camera.calibration.file", R"("NAME")"},
    {"camera.trajectory", R"({"file": "NAME"})"},
    {"camera.sensor", R"({"quantum_efficiency": "NAME"})"},
    {"camera.sensor.quantum_efficiency", R"({"file": "NAME", "per": "power"})"},
    {"camera.sensor.image.response", R"("NAME")"},
    {"cameras", R"([{"name": "a", "calibration": "NAME"}])"},
    {"rig.trajectory", R"({"file": "NAME"})"},
    {"water.scattering", R"({"b": 0.1, "phase": {"type": "table", "file": "NAME"}})"},
    {"water.species", R"({"silt": {"library": "silt", "index": {"file": "NAME"}}})"},
    {"water.species.silt.size", R"({"type": "table", "file": "NAME"})"},
    {"water.species.mud", R"({"vsf": "NAME", "water": "removed"})"},
    {"water.profile", R"("NAME")"},
    {"water.surface.waves", R"({"type": "image", "file": "NAME", "width": 4})"},
    {"volumes", R"([{"file": "NAME", "grids": {"density": {"small": 1}}}])"},
    {"volumes", R"([{"file": "x.vdb", "motion": {"file": "NAME"}}])"},
    {"volumes",
     R"([{"grids": {"density": {"scattering": 1, "phase": {"type": "table", "file": "NAME"}}}}])"},
    {"geometry", R"([{"file": "NAME"}])"},
    {"geometry[0].file", R"("NAME")"},
    {"geometry[0].trajectory", R"({"file": "NAME"})"},
    {"lamps.left.profile", R"({"type": "ies", "file": "NAME"})"},
    {"lamps.left.spectrum", R"({"file": "NAME", "column": "power"})"},
    {"lamps.left.trajectory.file", R"("NAME")"},
    {"sky", R"({"model": "panorama", "file": "NAME"})"},
    {"sky.spectrum", R"({"file": "NAME"})"},
    {"render.response", R"("NAME")"},
    {"render.view", R"({"config": "NAME"})"},
    {"render.white", R"({"file": "NAME"})"},
    {"variations", R"({"together": [{"table": "NAME"}]})"},
    {"variations.together", R"([{"rows": [{"geometry[0].file": "NAME"}]}])"},
    {"variations.keys", R"({"render.response": {"choice": ["bands", "NAME"]}})"},
    {"water.of.tomorrow", R"([[{"x": "NAME"}]])"},
};

std::string with_name(std::string text, const std::string& name) {
    return text.replace(text.find("\"NAME\""), 6, Json(name).dump());
}

class SceneFilesTest : public testing::Test {
  protected:
    // The message with which a change is refused; empty: it is not.
    std::string refusal(const Json& change) {
        try {
            session_.edit(
                {{"revision", session_.state()["revision"]}, {"changes", Json::array({change})}});
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    }
    std::string refusal(const FilePlace& place, const std::string& name) {
        return refusal({{"op", "set"},
                        {"path", place.path},
                        {"value", Json::parse(with_name(place.value, name))}});
    }
    static bool is_of_the_folder(const std::string& refusal) {
        return refusal.find("choose a file of the scene's folder") == std::string::npos;
    }
    void link(const fs::path& target, const std::string& name) const {
        fs::create_symlink(target, folder_.path() / name);
    }
    static std::string text_of(const fs::path& file) {
        std::ifstream stream(file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    SceneFolder folder_, elsewhere_;
    fs::path file_ = folder_.write("rig.yaml", k_edit_scene);
    fs::path outside_ = elsewhere_.write("outside.csv", k_spectrum);
    EditSession session_{file_};
};

TEST_F(SceneFilesTest, NoKeyTakesAFileFromElsewhere) {
    folder_.write("sub/inside.csv", k_spectrum);
    folder_.write("x2/file.csv", k_spectrum);
    link(outside_, "link.csv");
    link(elsewhere_.path(), "folder");
    link("link.csv", "sub/../second.csv");
    link("/nowhere/at/all.csv", "dangling.csv");
    link(outside_, "frame_0007.csv");
    link(elsewhere_.path(), "x1");
    const std::string up = (fs::path("..") / elsewhere_.path().filename() / "outside.csv").string();
    const Json before = session_.state()["revision"];
    for (const FilePlace& place : k_file_places) {
        for (const std::string& name :
             {std::string("/etc/passwd"), std::string("../x.csv"), std::string("sub/../../x.csv"),
              up, outside_.string(), std::string("link.csv"), std::string("./sub/../link.csv"),
              std::string("second.csv"), std::string("folder/outside.csv"),
              std::string("folder/there/is/none.csv"), std::string("dangling.csv"),
              std::string("frame_####.csv"), std::string("frame_%04d.csv"),
              std::string("x{frame}/outside.csv"), std::string("inside.csv\0", 11)})
            EXPECT_FALSE(is_of_the_folder(refusal(place, name))) << place.path << " " << name;
        // It may be refused, but by the reader.
        for (const std::string& name : {std::string("sub/inside.csv"), std::string("none.csv"),
                                        (folder_.path() / "sub/inside.csv").string(),
                                        std::string("x2/../sub/inside.csv"), std::string(300, 'x')})
            EXPECT_TRUE(is_of_the_folder(refusal(place, name))) << place.path << " " << name;
    }
    EXPECT_GE(session_.state()["revision"], before);
    // All of a lamp that is added counts, too.
    for (const std::string name : {"/etc/passwd", "link.csv"})
        EXPECT_FALSE(is_of_the_folder(refusal(
            {{"op", "add_lamp"}, {"lamp", {{"name", "new"}, {"spectrum", {{"file", name}}}}}})));
}

TEST_F(SceneFilesTest, FilesOfTheFolderAreTaken) {
    folder_.write("sub/inside.csv", k_spectrum);
    link("sub/inside.csv", "link.csv");
    ASSERT_EQ(refusal({{"op", "set"}, {"path", "lamps.left.intensity"}, {"value", 9}}), "");
    for (const std::string& name : {std::string("sub/inside.csv"), std::string("link.csv"),
                                    (folder_.path() / "sub/inside.csv").string()})
        EXPECT_EQ(refusal({"lamps.left.spectrum", R"({"file": "NAME"})"}, name), "") << name;
}

TEST_F(SceneFilesTest, WhatTheSceneHasFromElsewhereStays) {
    std::string scene = k_edit_scene;
    const std::string old = "intensity: [10, 10, 10]";
    scene.replace(scene.find(old), old.size(),
                  "power: 9\n    spectrum: {file: " + outside_.string() + "}");
    EditSession session(folder_.write("wide.yaml", scene));
    ASSERT_TRUE(session.state()["error"].is_null()) << session.state()["error"];
    session.edit(
        {{"revision", session.state()["revision"]},
         {"changes", {{{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 0, 1}}}}}});
    session.undo();
}

TEST_F(SceneFilesTest, NoMeshTakesAFileFromElsewhere) {
    const auto mesh_with = [&](const std::string& buffer) {
        return folder_.write("mesh.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": ")" +
                                              buffer + R"(", "byteLength": 4}]})");
    };
    const FilePlace place{"geometry[1]", R"({"file": "NAME"})"};
    mesh_with((".." / elsewhere_.path().filename() / "outside.csv").string());
    EXPECT_FALSE(is_of_the_folder(refusal(place, "mesh.gltf")));
    link(outside_, "link.csv");
    mesh_with("link.csv");
    EXPECT_FALSE(is_of_the_folder(refusal(place, "mesh.gltf")));
    folder_.write("buffer.bin", "1234");
    mesh_with("buffer.bin");
    EXPECT_TRUE(is_of_the_folder(refusal(place, "mesh.gltf")));
}

TEST_F(SceneFilesTest, LinksThatLeadElsewhereAreNotOffered) {
    folder_.write("inside.ies", "");
    elsewhere_.write("outside.ies", "");
    link(elsewhere_.path() / "outside.ies", "link.ies");
    EXPECT_EQ(session_.state()["ies_files"], Json::array({"inside.ies"}));
}

TEST_F(SceneFilesTest, IsNotSavedThroughALink) {
    link(outside_, "link.yaml");
    link(elsewhere_.path() / "new.yaml", "dangling.yaml");
    for (const char* name : {"link.yaml", "dangling.yaml"})
        for (const bool overwrite : {false, true})
            EXPECT_THROW(session_.save_as({{"file", name}, {"overwrite", overwrite}}),
                         ConflictError)
                << name;
    EXPECT_EQ(text_of(outside_), k_spectrum);
    EXPECT_FALSE(fs::exists(elsewhere_.path() / "new.yaml"));
    EXPECT_TRUE(fs::is_symlink(folder_.path() / "link.yaml"));
    EXPECT_EQ(session_.state()["scene"], "rig.yaml");
    folder_.write("there.yaml", "other\n");
    session_.save_as({{"file", "there.yaml"}, {"overwrite", true}});
    EXPECT_EQ(text_of(folder_.path() / "there.yaml"), k_edit_scene);
}

// A scene that was opened by a link is saved to where that leads.
TEST_F(SceneFilesTest, ASceneThatIsALinkIsSavedThroughIt) {
    const fs::path target = elsewhere_.write("target.yaml", k_edit_scene);
    link(target, "scene.yaml");
    EditSession session(folder_.path() / "scene.yaml");
    session.edit(
        {{"revision", session.state()["revision"]},
         {"changes", {{{"op", "set"}, {"path", "lamps.left.position"}, {"value", {0, 0, 1}}}}}});
    session.save_as({{"file", "scene.yaml"}, {"overwrite", true}});
    EXPECT_NE(text_of(target), k_edit_scene);
    EXPECT_TRUE(fs::is_symlink(folder_.path() / "scene.yaml"));
}

}  // namespace
