// ctest labels: analytic
// What images leave out that have the shadows of a sky from so many parts, and the light of a
// volume from so many points, against whole images with four times as many.
#include "render/light_points.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "tests/support/film_rendering.h"
#include "tests/support/scene_folder.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

// As many pixels as there are rays that find_pointed_lamps looks along: through their middles. The
// camera looks through Snell's window, where the surface mirrors little.
const std::string k_camera =
    "uwvdb: 1\ncamera: {resolution: [12, 9], intrinsics: {fov_x: 75}, pose: {position: [0, 0, 0], "
    "look_at: [0, 1, 0.2]}}\nrender: {samples: 1}\n";

class LightPoints : public testing::Test {
  protected:
    SceneDesc scene(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        SceneDesc desc = read_scene(folder_.write("scene.yaml", k_camera + text), overrides);
        desc.render.quality = RenderDesc::Quality::exact;
        return desc;
    }
    std::vector<PointedLamp> found(const SceneDesc& desc) {
        renderer_.set_scene(SceneDesc(desc));
        return find_pointed_lamps(renderer_.assemble());
    }
    std::vector<std::string> notes(const std::vector<PointedLamp>& lamps) {
        return pointed_lamp_notes(renderer_.assembled(), lamps);
    }

    /// RMS of the differences between two images, over the mean of the first.
    static double change(const SceneDesc& one, const SceneDesc& other) {
        const RenderedFilm a(one), b(other);
        double squares = 0, mean = 0;
        const int width = a.film().width(), height = a.film().height();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                double first = 0, second = 0;
                for (int band = 0; band < 3; ++band) {
                    first += a.total(x, y, band) / 3;
                    second += b.total(x, y, band) / 3;
                }
                mean += first / (width * height);
                squares += (first - second) * (first - second) / (width * height);
            }
        return std::sqrt(squares) / mean;
    }

    SceneFolder folder_;
    Renderer renderer_;
};

// Below a slit between two boards each part of the sky casts a shaft of its own.
const std::string k_below_sky =
    "water: {surface: {height: 2, n: 1.34}, bands: [620, 540, 450], absorption: [0.3, 0.1, 0.1], "
    "scattering: {b: [0.2, 0.3, 0.3], phase: {type: hg, g: 0.9}}}\n"
    "sky: {model: overcast, irradiance: [1, 2, 3]}\n"
    "geometry: [{type: plane, point: [0, -1, 0], normal: [0, 1, 0], reflectance: 0.3}, {type: box, "
    "min: [-5, 0.8, -5], max: [-0.1, 0.85, 5]}, {type: box, min: [0.1, 0.8, -5], max: [5, 0.85, "
    "5]}]\n";

TEST_F(LightPoints, OfASkyAreJudgedAsImagesOfMoreDirectionsDo) {
    const auto below_slit = [&](int samples) {
        return scene(k_below_sky,
                     {"camera.pose.position=[0, 0.1, 0]", "camera.pose.look_at=[0, 0.5, 1]",
                      fmt::format("sky.samples={}", samples)});
    };
    const SceneDesc desc = below_slit(32);
    const std::vector<PointedLamp> lamps = found(desc);
    ASSERT_EQ(lamps.size(), 1U);
    EXPECT_EQ(lamps[0].count, 32U);
    const double truth = change(desc, below_slit(128));
    EXPECT_GT(truth, 0.03);
    // Six places on each ray, and a tenth of the light beside what is seen in the window.
    EXPECT_NEAR(lamps[0].change, truth, 0.15 * truth);
    const std::vector<std::string> text = notes(lamps);
    ASSERT_EQ(text.size(), 1U);
    EXPECT_NE(text[0].find("sky.samples: 128"), std::string::npos) << text[0];
    // Of more of them less is left out.
    const SceneDesc finer = below_slit(256);
    EXPECT_LT(found(finer)[0].change, 0.5 * truth);
}

TEST_F(LightPoints, OfAVolumeAreJudgedAsImagesOfMorePointsDo) {
    VdbFixture grid;
    grid.name = "flame";
    grid.min = {-10, -10, -10};
    grid.max = {10, 10, 10};
    grid.value = [](int, int, int) { return 1.0; };
    grid.file_from_index = Affine::translation({0.0, 2.0, 0.4}) * Affine::scale(Vector3(0.1));
    write_fixture(folder_.path() / "emission.vdb", {grid});
    const auto with_points = [&](int samples) {
        return scene(fmt::format(
            "water: {{bands: [620, 540, 450], absorption: [0.3, 0.2, 0.2], scattering: {{b: [0.8, "
            "0.8, 0.8], phase: {{type: hg, g: 0.5}}}}}}\n"
            "volumes: [{{file: emission.vdb, emission: {{flame: {{per_unit: [3, 2, 1], samples: "
            "{}}}}}}}]\n",
            samples));
    };
    const SceneDesc desc = with_points(16);
    const std::vector<PointedLamp> lamps = found(desc);
    ASSERT_EQ(lamps.size(), 1U);
    EXPECT_EQ(lamps[0].count, 16U);
    const double truth = change(desc, with_points(64));
    EXPECT_GT(truth, 0.01);
    // Six places on each ray, which may lie near a point or not.
    EXPECT_NEAR(lamps[0].change, truth, 0.5 * truth);
    EXPECT_NE(notes(lamps).at(0).find("render.scattering: multiple"), std::string::npos);
    // In all light there is no surface for them to light.
    SceneDesc all_light = desc;
    all_light.render.scattering = RenderDesc::Scattering::multiple;
    EXPECT_EQ(found(all_light)[0].change, 0);
}

TEST_F(LightPoints, AreNothingWithoutSkyAndEmission) {
    EXPECT_TRUE(found(scene("lamps: [{position: [1, 0, 0], intensity: [5, 5, 5]}]\n")).empty());
    // A black sky is not a lamp; what does not scatter over a black floor shows the sky alone.
    const std::vector<PointedLamp> lamps = found(
        scene("water: {surface: {height: 2, n: 1.34}, bands: [620, 540, 450], absorption: [0.3, "
              "0.1, 0.1], scattering: {b: [0, 0, 0], phase: {type: hg, g: 0.9}}}\n"
              "sky: {model: uniform, irradiance: [1, 2, 3]}\n"));
    ASSERT_EQ(lamps.size(), 1U);
    EXPECT_EQ(lamps[0].change, 0);
    EXPECT_TRUE(notes(lamps).empty());
}

}  // namespace
}  // namespace uw::test
