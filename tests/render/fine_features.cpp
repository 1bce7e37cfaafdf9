// ctest labels: analytic
// What is small in an image, between the rays along which the water's light is integrated.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/image_file.h"
#include "tests/support/temp_dir.h"

namespace uw::test {
namespace {

/// An image without surfaces, by interpolation between rays and by every pixel's own.
class FineFeatures : public testing::Test {
  protected:
    static Film rendered(const std::string& scene, RenderDesc::Quality quality) {
        SceneDesc desc = load_scene_text(scene, "fine.yaml");
        desc.render.quality = quality;
        Renderer renderer;
        renderer.set_scene(std::move(desc));
        renderer.render({.layers = "total"});
        return renderer.release_film();
    }

    // At the brightest pixel: what two nodes of the finest cells allow each other, sqrt(32 / 4)
    // times 0.4 %. Of all: half of it, as the steps along a ray are off by up to 0.5 % in a narrow
    // cosine's beam. Where features are missing, both are near 1.
    static constexpr double k_worst = 0.0113, k_rms = 5e-3;

    static void expect_like_exact(const std::string& scene) {
        const Film mixed = rendered(scene, RenderDesc::Quality::final);
        const Film exact = rendered(scene, RenderDesc::Quality::exact);
        double squares = 0, all = 0, max_difference = 0, greatest = 0;
        for (int y = 0; y < exact.height(); ++y) {
            for (int x = 0; x < exact.width(); ++x) {
                const double is = static_cast<double>(mixed.pixel(x, y)[1]);
                const double expected = static_cast<double>(exact.pixel(x, y)[1]);
                squares += (is - expected) * (is - expected);
                all += expected * expected;
                max_difference = std::max(max_difference, std::abs(is - expected));
                greatest = std::max(greatest, expected);
            }
        }
        EXPECT_GT(all, 0);
        EXPECT_LT(std::sqrt(squares / all), k_rms) << scene;
        EXPECT_LT(max_difference / greatest, k_worst) << scene;
    }

    static std::string scene(const std::string& more) {
        return "uwvdb: 1\n"
               "camera:\n  resolution: [160, 96]\n  intrinsics: {fov_x: 60}\n"
               "water:\n  preset: jerlov-II\n" +
               more;
    }
    static std::string lamp(const std::string& place, const std::string& profile) {
        return "  - {" + place + ", profile: {" + profile + "}, intensity: 10}\n";
    }
};

// A laser's line is two or three pixels wide, less far away, and rays are 16 apart.
TEST_F(FineFeatures, ALaserBesideTheCameraIsALine) {
    for (const char* const direction :
         {"[-0.3, -0.13, 1]", "[-0.6, -0.2, 0.7]", "[-0.2, 0.05, 1]"}) {
        for (const char* const profile :
             {"type: spot, beam: 0.3, edge: 0.05", "type: cosine, fwhm: 0.3"}) {
            expect_like_exact(scene("lamps:\n" + lamp(fmt::format("position: [0.6, 0.2, 0.1], "
                                                                  "direction: {}",
                                                                  direction),
                                                      profile)));
        }
    }
}

// The water that a beam from the pinhole lights is a spot in the image.
TEST_F(FineFeatures, ANarrowBeamFromTheCameraIsASpot) {
    for (const char* const direction : {"[0.1, 0.07, 1]", "[-0.21, 0.1, 1]"})
        expect_like_exact(
            scene("lamps:\n" + lamp(fmt::format("position: [0, 0, 0], direction: {}", direction),
                                    "type: spot, beam: 2, edge: 0.5")));
}

// Two sheets of light whose planes contain the camera, one that it is a centimetre beside, and one
// that it sees from afar.
TEST_F(FineFeatures, ASheetOfLightIsALineAlongItsPlane) {
    for (const auto& [position, rotate] : {std::pair{"[0.4, 0.1, 0]", -14.036243},
                                           {"[-0.3, 0.3, 0.1]", 45.0},
                                           {"[0.4, 0.11, 0]", -14.036243},
                                           {"[0.1, -0.5, 0]", 5.0}})
        expect_like_exact(
            scene("lamps:\n" +
                  lamp(fmt::format("position: {}", position),
                       fmt::format("type: line, angle: 50, width: 0.2, rotate: {}", rotate))));
}

// Dots, whose light is a bundle of lines of two pixels.
TEST_F(FineFeatures, APatternIsEverywhereInItsBeam) {
    const TempDir folder;
    std::vector<int> dots(80 * 80, 0);
    for (const std::size_t at : {17U * 80 + 31, 31U * 80 + 61, 66U * 80 + 12, 45U * 80 + 40})
        dots[at] = 255;
    std::ofstream(folder.path() / "dots.png", std::ios::binary)
        << encoded_image("png", 80, 80, 1, dots);
    const std::string file = (folder.path() / "dots.png").string();
    for (const char* const position : {"[0.5, 0.2, 0]", "[0, 0.3, 0]"})
        expect_like_exact(
            scene("lamps:\n" + lamp(fmt::format("position: {}", position),
                                    fmt::format("type: image, fov: 40, file: {}", file))));
}

// Behind a port, whose rays do not come from one point.
TEST_F(FineFeatures, SoItIsBehindAPort) {
    std::string ported = scene("lamps:\n" + lamp("position: [0.2, 0.2, 0], direction: [-0.2, "
                                                 "-0.1, 1]",
                                                 "type: spot, beam: 0.3, edge: 0.05"));
    ported.insert(ported.find("water:"),
                  "  port: {type: flat, distance: 0.02, thickness: 0.01, normal: [0.05, 0, 1]}\n");
    expect_like_exact(ported);
}

// Clouds of 12 x 4 pixels.
TEST_F(FineFeatures, SmallCloudsAreWhole) {
    std::string volumes = "volumes:\n";
    for (int n = 0; n < 12; ++n)
        volumes += fmt::format(
            "  - {{file: {}/assets/grids/plume128_blosc_half_0030.vdb, grids: {{density: {{small: "
            "100, large: 100}}}}, transform: {{scale: 0.1, translate: [{}, {}, 3]}}}}\n",
            UWVDB_SOURCE_DIR, -1.5 + 0.27 * n, 0.8 * std::sin(2.3 * n));
    expect_like_exact(scene(volumes + "lamps:\n" +
                            lamp("position: [0.6, 0.2, 0], direction: [0, "
                                 "0, 1]",
                                 "type: spot, beam: 90, edge: 10")));
}

}  // namespace
}  // namespace uw::test
