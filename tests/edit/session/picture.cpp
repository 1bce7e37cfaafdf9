// ctest labels: unit metamorphic threads
#include "edit/session/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/scene/yaml_document.h"
#include "edit/session/picture_renderer.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/edit_picture.h"
#include "tests/support/edit_scene.h"
#include "tests/support/meshes/mesh_fixtures.h"

namespace {

using namespace uw;
using namespace uw::test;

std::shared_ptr<const EditedScene> scene_of(const std::string& text) {
    return make_edited_scene(text, parse_yaml(text, "rig.yaml"), "rig.yaml", {}, 1);
}

// The plane of this layer of an image that the renderer makes by itself.
std::vector<float> rendered_plane(const std::string& text, const std::string& lamp,
                                  const std::string& layer) {
    SceneDesc scene = load_scene_text(text, "rig.yaml");
    std::erase_if(scene.lamps, [&](const LampDesc& other) { return other.name != lamp; });
    Renderer renderer;
    renderer.set_scene(std::move(scene));
    const Film& film = renderer.render({.layers = layer});
    std::vector<float> plane;
    const std::vector<std::string>& names = film.channel_names();
    const auto first =
        static_cast<std::size_t>(std::ranges::find(names, layer + ".R") - names.begin());
    for (std::size_t at = first; at < film.values().size(); at += names.size())
        for (std::size_t c = 0; c < 3; ++c) plane.push_back(film.values()[at + c]);
    return plane;
}

TEST(Pictures, FinalPlanesAreThoseOfTheRenderer) {
    PictureRenderer renderer(quiet_callbacks());
    const auto picture = final_picture(renderer, scene_of(k_edit_scene));
    const ReadPicture served = read_picture(picture_bytes(*picture, SampleType::f32));
    EXPECT_EQ(served.header["lamp_brightness"], Json::parse("[[40.0,30.0,20.0],[10.0,10.0,10.0]]"));
    int compared = 0;
    for (std::size_t p = 0; p < served.planes.size(); ++p) {
        const Json& plane = served.header["planes"][p];
        if (plane["lamp"].is_null()) continue;
        // To the bit: the same renderer made it of the same scene.
        EXPECT_EQ(served.planes[p], rendered_plane(k_edit_scene, plane["lamp"], plane["layer"]))
            << plane;
        ++compared;
    }
    EXPECT_EQ(compared, 8);  // direct, backscatter, clean and irradiance of two lamps
}

TEST(Pictures, HalvesAreTheSameToTheirPrecision) {
    PictureRenderer renderer(quiet_callbacks());
    const auto picture = final_picture(renderer, scene_of(k_edit_scene));
    const ReadPicture exact = read_picture(picture_bytes(*picture, SampleType::f32));
    const ReadPicture half = read_picture(picture_bytes(*picture, SampleType::f16));
    ASSERT_EQ(exact.planes.size(), half.planes.size());
    for (std::size_t p = 0; p < exact.planes.size(); ++p) {
        const float factor = half.header["planes"][p]["factor"].get<float>();
        for (std::size_t i = 0; i < exact.planes[p].size(); ++i) {
            // Half a unit of 11 bits; below 2^-14 of the factor half of 2^-24 of it.
            const float tolerance =
                std::max(std::abs(exact.planes[p][i]) * 0x1p-11F, factor * 0x1p-25F);
            ASSERT_NEAR(half.planes[p][i], exact.planes[p][i], tolerance);
        }
    }
}

// Light is additive and linear in the lamps' intensities: mixed from its parts, the picture is that
// of the whole scene. The tolerance is that of interpolated in-scatter (1e-4 of the mean).
void expect_mixed_from_lamps(std::string text) {
    PictureRenderer renderer(quiet_callbacks());
    const auto picture = final_picture(renderer, scene_of(text));
    text.replace(text.find("[40, 30, 20]"), 12, "[5, 50, 25]");
    const auto brighter = scene_of(text);
    ASSERT_TRUE(is_same_picture(*picture->scene, *brighter));
    const PictureLayers mixed = mixed_layers(*picture, *brighter);
    Renderer whole;
    whole.set_scene(load_scene_text(text, "rig.yaml"));
    const Film& film = whole.render();
    double error = 0, mean = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(96 * 64); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            double sum = 0;
            for (const auto* planes : {&mixed.signal, &mixed.backscatter})
                for (const PicturePlane& plane : *planes)
                    sum += plane.gain[b] * static_cast<double>(plane.values[i * plane.stride + b]);
            const double expected =
                static_cast<double>(film.values()[i * film.channel_names().size() + b]);
            error += (sum - expected) * (sum - expected);
            mean += expected;
        }
    }
    const double count = 3 * 96 * 64;
    EXPECT_LT(std::sqrt(error / count), 3e-4 * mean / count);
}

TEST(Pictures, MixedFromLampsTheyAreTheWhole) {
    expect_mixed_from_lamps(k_edit_scene);
}

TEST(Pictures, ShowMarineSnow) {
    std::string text = k_edit_scene;
    text.insert(text.find("geometry:"),
                "  snow: {number: 3000, diameter: [1 mm, 4 mm], mean: added, seed: 2}\n");
    expect_mixed_from_lamps(text);
}

TEST(Pictures, ShowSurfacesThatEmitLightOnce) {
    const MeshFolder folder;
    folder.write("glow.gltf", gltf_text({{"materials", R"([{"emissiveFactor":[1,0.5,0.2]}])"},
                                         {"meshes", R"([{"primitives":[{"attributes":
                                             {"POSITION":0},"indices":1,"material":0}]}])"}}));
    std::string text = k_edit_scene;
    text.insert(text.find("lamps:"),
                "  - {file: '" + folder.path("glow.gltf").string() +
                    "', material: pbr, transform: {translate: [-0.4, -0.4, 1.5]}}\n");
    expect_mixed_from_lamps(text);
}

TEST(Pictures, ADarkLampIsReadyToBeTurnedUp) {
    std::string text = k_edit_scene;
    text.replace(text.find("[40, 30, 20]"), 12, "[0, 0, 0]");
    PictureRenderer renderer(quiet_callbacks());
    const auto dark = scene_of(text);
    const auto picture = final_picture(renderer, dark);
    const std::size_t rendered = renderer.rendered();
    EXPECT_GT(picture->lamps[0]->brightness[0], 0);
    final_picture(renderer, scene_of(k_edit_scene));
    EXPECT_EQ(renderer.rendered(), rendered);
}

TEST(Pictures, SizesKeepTheProportions) {
    EXPECT_EQ(picture_size(PictureQuality::final, 960, 540), std::pair(960, 540));
    EXPECT_EQ(picture_size(PictureQuality::draft, 960, 540), std::pair(480, 270));
    EXPECT_EQ(picture_size(PictureQuality::small, 960, 540), std::pair(160, 90));
    EXPECT_EQ(picture_size(PictureQuality::small, 80, 60), std::pair(80, 60));
    const auto [width, height] = picture_size(PictureQuality::final, 8000, 4000);
    EXPECT_LE(width * height, 1920 * 1200 + 4000);
    EXPECT_NEAR(static_cast<double>(width) / height, 2, 1e-3);
}

// All light takes its time: before its first picture there is one of the light that is scattered
// once, and none again when a lamp has moved.
TEST(Pictures, BeginWithLightScatteredOnce) {
    std::vector<std::pair<PictureQuality, bool>> made;
    PictureCallbacks callbacks = quiet_callbacks();
    callbacks.done = [&](const Picture& picture) {
        made.emplace_back(picture.quality, picture.lamps[0]->plan.has(Layer::multiple));
    };
    std::string text = k_edit_scene;
    text.replace(text.find("[96, 64]"), 8, "[24, 16]");
    text.replace(text.find("{fx: 70, fy: 70, cx: 48, cy: 32}"), 32,
                 "{fx: 18, fy: 18, cx: 12, cy: 8}");
    text += "  scattering: multiple\n";
    {
        PictureRenderer renderer(callbacks);
        final_picture(renderer, scene_of(text));
        text.replace(text.find("[-0.5, 0, 0.6]"), 14, "[-0.4, 0, 0.6]");
        final_picture(renderer, scene_of(text));
    }
    using enum PictureQuality;
    const std::vector<std::pair<PictureQuality, bool>> expected{
        {first, false}, {full_draft, true}, {final, true}, {full_draft, true}, {final, true}};
    EXPECT_EQ(made, expected);
}

// While a lamp is dragged faster than its picture is rendered, there are pictures all the same, and
// the last one is of the last place.
TEST(Pictures, FollowADrag) {
    std::atomic<int> small = 0;
    PictureCallbacks callbacks = quiet_callbacks();
    callbacks.done = [&](const Picture& picture) {
        if (picture.scene->scene.desc().camera.width > 96 &&
            picture.quality == PictureQuality::small)
            ++small;
    };
    PictureRenderer renderer(callbacks);
    std::string base = k_edit_scene;
    base.replace(base.find("[96, 64]"), 8, "[960, 640]");
    base.replace(base.find("{fx: 70, fy: 70, cx: 48, cy: 32}"), 32,
                 "{fx: 700, fy: 700, cx: 480, cy: 320}");
    std::shared_ptr<const EditedScene> last;
    // As long as it takes: the machine may be slow.
    for (int i = 0; i < 40 || (small < 2 && i < 5000); ++i) {
        std::string text = base;
        text.replace(text.find("[-0.5, 0, 0.6]"), 14,
                     "[-0." + std::to_string(100 + i) + ", 0, 0.6]");
        last = scene_of(text);
        renderer.show(last);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(eventually([&] {
        const auto picture = renderer.picture();
        return picture && picture->scene == last;
    }));
    EXPECT_GE(small, 2);
}

}  // namespace
