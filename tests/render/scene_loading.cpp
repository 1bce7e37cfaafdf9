// ctest labels: unit
#include "render/scene_loading.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/calibration_texts.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

class SceneLoading : public testing::Test {
  protected:
    SceneDesc load(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        return load_scene(folder_.write("scene.yaml", text), overrides);
    }
    test::SceneFolder folder_;
};

constexpr auto k_calibrated_scene = "uwvdb: 1\ncamera: {calibration: rig.yaml}\n";

TEST_F(SceneLoading, TakesTheCameraOfACalibration) {
    folder_.write("rig.yaml", test::k_calibmar_dome);
    const SceneDesc scene = load(k_calibrated_scene);
    EXPECT_EQ(scene.camera.width, 1280);
    EXPECT_EQ(scene.camera.intrinsics.fx, 512.5);
    EXPECT_TRUE(scene.camera.port);
}

TEST_F(SceneLoading, TheCalibrationIsPartOfTheHash) {
    folder_.write("rig.yaml", test::k_calibmar_dome);
    const std::string hash = load(k_calibrated_scene).hash;
    EXPECT_EQ(load(k_calibrated_scene).hash, hash);
    std::string changed = test::k_calibmar_dome;
    changed.replace(changed.find("512.5"), 5, "513.5");
    folder_.write("rig.yaml", changed);
    EXPECT_NE(load(k_calibrated_scene).hash, hash);
}

TEST_F(SceneLoading, WithoutACalibrationIsAsRead) {
    const std::string text = "uwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: {fov_x: 60}}\n";
    const SceneDesc scene = load(text, {"camera.resolution=[32, 24]"});
    EXPECT_EQ(scene.camera.width, 32);
    EXPECT_NE(scene.hash, load(text).hash);
}

TEST_F(SceneLoading, FromTextIsAsFromTheFileThatItBelongsTo) {
    folder_.write("rig.yaml", test::k_calibmar_dome);
    const std::string hash = load(k_calibrated_scene).hash;
    const std::filesystem::path file = folder_.write("scene.yaml", "something else");
    const SceneDesc scene = load_scene_text(k_calibrated_scene, file);
    EXPECT_EQ(scene.hash, hash);
    EXPECT_EQ(scene.file, file);
    EXPECT_EQ(scene.camera.width, 1280);
}

TEST_F(SceneLoading, ThrowsWhatItsReadersThrow) {
    EXPECT_THROW(load(k_calibrated_scene), InputError);  // there is no rig.yaml
    folder_.write("rig.yaml", "no calibration");
    EXPECT_THROW(load(k_calibrated_scene), InputError);
    EXPECT_THROW(load("uwvdb: 3\n"), InputError);
}

}  // namespace
}  // namespace uw
