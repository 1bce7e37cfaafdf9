// ctest labels: metamorphic
// The layers of lamps hold all light but what surfaces emit: of every kind of emitter, in every way
// of rendering it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "core/scene/scene_desc.h"
#include "tests/support/film_rendering.h"
#include "tests/support/ies_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

/// How a scene is rendered: what stands under `render` in its file.
struct LayersOf {
    const char* name;
    const char* render;
    RenderDesc::Quality quality = RenderDesc::Quality::final;
};

void PrintTo(const LayersOf& rendering, std::ostream* out) {
    *out << rendering.name;
}

class LampLayers : public testing::TestWithParam<LayersOf> {
  protected:
    LampLayers() {
        VdbFixture grid;
        grid.name = "flame";
        grid.min = {-3, -3, -3};
        grid.max = {3, 3, 3};
        grid.value = [](int, int, int) { return 1.0; };
        grid.file_from_index = Affine::translation({0.4, 0.8, 2.5}) * Affine::scale(Vector3(0.05));
        write_fixture(folder_.path() / "emission.vdb", {grid});
        IesWriter ies;
        ies.polar = {0, 30, 60, 90};
        ies.candelas = [](double polar, double) { return 900 - 10 * polar; };
        folder_.write("lamp.ies", ies.text());
    }

    /// Looks up at a slanting angle: at Snell's window, at what the surface mirrors beside it, and
    /// at a wall below. `lamps`: entries of the list, `more`: further keys of the scene.
    SceneDesc scene(const std::string& lamps, const std::string& more = "",
                    const std::string& wall = "reflectance: 0.5") const {
        SceneDesc desc = read_scene(
            folder_.write(
                "scene.yaml",
                fmt::format(
                    "uwvdb: 1\n"
                    "camera: {{resolution: [12, 9], intrinsics: {{fov_x: 75}}, pose: {{position: "
                    "[0, 0, 0], look_at: [0, 0.7, 1]}}}}\n"
                    "water: {{surface: {{height: 2, n: 1.34}}, bands: [620, 540, 450], absorption: "
                    "[0.3, 0.05, 0.05], scattering: {{b: [0.1, 0.12, 0.15], phase: {{type: hg, g: "
                    "0.8}}}}}}\n"
                    "lamps: [{}]\n"
                    "geometry: [{{type: plane, point: [0, 0, 4], normal: [0, 0, -1], {}}}]\n"
                    "render: {{{}}}\n{}",
                    lamps, wall, GetParam().render, more)),
            {});
        desc.render.quality = GetParam().quality;
        return desc;
    }

    /// The worst difference between the sum of the lamps and the total, less what an image without
    /// lamps has; relative to the pixel, or to the mean of the image where that is brighter.
    static double worst(const SceneDesc& desc, const RenderedFilm* without_lamps = nullptr) {
        const RenderedFilm film(desc);
        const int width = film.film().width(), height = film.film().height();
        double worst = 0;
        for (int band = 0; band < 3; ++band) {
            double mean = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) mean += film.total(x, y, band) / (width * height);
            EXPECT_GT(mean, 0);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    double sum = without_lamps ? without_lamps->total(x, y, band) : 0;
                    for (std::size_t lamp = 0; lamp < desc.lamps.size(); ++lamp)
                        sum += film.lamp(lamp, x, y, band);
                    const double total = film.total(x, y, band);
                    worst = std::max(worst, std::abs(sum - total) / std::max(total, mean));
                }
        }
        return worst;
    }

    SceneFolder folder_;
};

// Layers are floats, of which each has a rounding of its own.
constexpr double k_rounding = 2e-6;

const std::string k_spot =
    "{name: spot, position: [0.5, -0.2, 1], direction: [0, 0, 1], frame: world, intensity: [3, 3, "
    "3], profile: {type: spot, beam: 60}}";
const std::string k_panel =
    "{name: panel, type: rectangle, position: [-0.6, 0.3, 2], direction: [0, 0, 1], frame: world, "
    "width: 0.3, height: 0.2, samples: 4, intensity: [4, 3, 2], profile: {type: cosine, fwhm: "
    "120}}";
const std::string k_ball =
    "{name: ball, type: sphere, position: [0.2, 1, 2], radius: 0.1, samples: 4, frame: world, "
    "intensity: [2, "
    "2, 2]}";
const std::string k_ies =
    "{name: ies, position: [-0.2, 0, 1], direction: [0, 0.5, 1], frame: world, intensity: [3, 3, "
    "3], profile: {type: ies, file: lamp.ies}}";
const std::string k_sun =
    "{name: sun, type: sun, direction: [0.4, -1, 0.2], irradiance: [1, 1, 1], samples: 4}";
const std::string k_sky = "sky: {model: uniform, irradiance: [1, 2, 3], samples: 8}\n";
const std::string k_emissive_volume =
    "volumes: [{file: emission.vdb, emission: {flame: {per_unit: [5, 2, 1], samples: 4}}}]\n";

// Each by itself, so that none hides behind a brighter one.
TEST_P(LampLayers, HoldTheLightOfEachKindOfLamp) {
    for (const std::string& lamp : {k_spot, k_panel, k_ball, k_ies, k_sun}) {
        SCOPED_TRACE(lamp);
        EXPECT_LT(worst(scene(lamp)), k_rounding);
    }
}

TEST_P(LampLayers, HoldTheSkyThatIsSeen) {
    EXPECT_LT(worst(scene("", k_sky)), k_rounding);
    EXPECT_LT(
        worst(scene("", "sky: {model: clear, sun: {azimuth: 20, elevation: 35}, samples: 8}\n")),
        k_rounding);
}

TEST_P(LampLayers, HoldTheLightOfVolumes) {
    EXPECT_LT(worst(scene("", k_emissive_volume)), k_rounding);
}

TEST_P(LampLayers, HoldAllOfThemTogether) {
    const SceneDesc desc =
        scene(k_spot + ", " + k_panel + ", " + k_ball + ", " + k_sun, k_sky + k_emissive_volume);
    EXPECT_EQ(desc.lamps.size(), 6U);
    EXPECT_LT(worst(desc), k_rounding);
}

const LayersOf k_volume{"volume", "integrator: volume"};

INSTANTIATE_TEST_SUITE_P(Renderings, LampLayers,
                         testing::Values(k_volume,
                                         LayersOf{"reference", "integrator: reference, samples: 1"},
                                         LayersOf{"path", "integrator: path, samples: 4"}),
                         [](const auto& rendering) { return std::string(rendering.param.name); });

class LampLayersOfAllLight : public LampLayers {};

TEST_P(LampLayersOfAllLight, HoldTheSkyAndALamp) {
    EXPECT_LT(worst(scene(k_spot, k_sky)), k_rounding);
}

INSTANTIATE_TEST_SUITE_P(Renderings, LampLayersOfAllLight,
                         testing::Values(LayersOf{"multiple", "scattering: multiple",
                                                  RenderDesc::Quality::draft}),
                         [](const auto& rendering) { return std::string(rendering.param.name); });

class LayersBesideEmission : public LampLayers {};

// What surfaces emit is no lamp's: the rest of the image is that of the same scene without lamps,
// where nothing is random.
TEST_P(LayersBesideEmission, LeaveOutWhatSurfacesEmit) {
    folder_.write("wall.mtl", "newmtl bright\nKd 0.3 0.3 0.3\nKe 0.2 0.1 0.05\n");
    folder_.write("wall.obj",
                  "mtllib wall.mtl\nv -1 -1 3\nv 1 -1 3\nv 1 1 3\nv -1 1 3\nusemtl bright\n"
                  "f 1 2 3 4\n");
    const auto with_wall = [&](const std::string& lamps, const std::string& more) {
        SceneDesc desc = scene(lamps, more);
        const SceneDesc of_file = read_scene(
            folder_.write("wall.yaml",
                          "uwvdb: 1\ncamera: {resolution: [1, 1], intrinsics: {fov_x: 30}}\n"
                          "geometry: [{file: wall.obj, material: pbr}]\n"),
            {});
        desc.geometry.push_back(of_file.geometry[0]);
        return desc;
    };
    const RenderedFilm dark(with_wall("", ""));
    EXPECT_LT(worst(with_wall(k_spot + ", " + k_sun, k_sky + k_emissive_volume), &dark),
              k_rounding);
}

INSTANTIATE_TEST_SUITE_P(Renderings, LayersBesideEmission, testing::Values(k_volume),
                         [](const auto& rendering) { return std::string(rendering.param.name); });

}  // namespace
}  // namespace uw::test
