// ctest labels: analytic
#include "core/passes/in_scatter_lattice.h"

// Water mixed from a lattice of rays, as images are rendered, against every pixel's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/passes/pixel_pass.h"
#include "render/scene_loading.h"
#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

// Twice what InScatterLattice allows halfway between the nodes of its finest cells, which is eight
// times what it is given, the tolerance of the coarsest.
constexpr double k_tolerance = 1e-3;
constexpr double k_coarsest_tolerance = k_tolerance / 16;

/// The backscatter of a scene's image, mixed and by itself.
class MixedImage {
  public:
    explicit MixedImage(const SceneDesc& desc, const InScatterParts& parts = {})
        : renderer_(with_scene(desc)),
          transport_(renderer_.make_transport()),
          pixels_(pixel_renderer(renderer_.assembled(), transport_, parts)) {}

    std::vector<PixelResult> render(double tolerance) const {
        const CameraDesc& camera = renderer_.scene().desc().camera;
        return render(tolerance, {0, 0, camera.width, camera.height});
    }
    std::vector<PixelResult> render(double tolerance, const PixelWindow& window) const {
        std::vector<PixelResult> pixels(static_cast<std::size_t>(window.width()) *
                                        static_cast<std::size_t>(window.height()));
        render_tiles(
            pixels_, tolerance, {}, window, [](double) {},
            [&](int x, int y, const PixelResult& pixel) {
                pixels[static_cast<std::size_t>((y - window.y0) * window.width() + x - window.x0)] =
                    pixel;
            });
        return pixels;
    }

  private:
    static Renderer with_scene(const SceneDesc& desc) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc));
        return renderer;
    }

    Renderer renderer_;
    LightTransport transport_;
    PixelRenderer pixels_;
};

/// A box before a wall throws the shadows of two lamps; a sphere's distance changes over it.
SceneDesc shadows(int width, int height) {
    SceneDesc desc = pinhole_scene(width, height);
    desc.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    GeometryDesc sphere;
    sphere.type = GeometryDesc::Type::sphere;
    sphere.center = {-0.8, 0.4, 2.5};
    sphere.radius = 0.5;
    desc.geometry.push_back(sphere);
    desc.lamps = {isotropic_lamp({1, -0.5, 0}, 50), isotropic_lamp({-0.8, -0.6, 0.2}, 30)};
    desc.lamps[1].name = "second";
    return desc;
}

void expect_like_exact(const MixedImage& image) {
    const std::vector<PixelResult> mixed = image.render(k_coarsest_tolerance);
    const std::vector<PixelResult> exact = image.render(0);
    double mean = 0, worst = 0, squares = 0;
    for (const PixelResult& pixel : exact) mean += pixel.backscatter[1];
    mean /= static_cast<double>(exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double difference = mixed[i].backscatter[1] - exact[i].backscatter[1];
        worst = std::max(worst, std::abs(difference) / std::max(exact[i].backscatter[1], mean));
        squares += difference * difference;
        // Surfaces are every pixel's own in both.
        for (std::size_t b = 0; b < 3; ++b) ASSERT_EQ(mixed[i].direct[b], exact[i].direct[b]);
    }
    // A smooth function is four times nearer than what was confirmed halfway between nodes. Past
    // the kink at a shadow's edge it may be twice as far off along each axis.
    EXPECT_LT(worst, 2 * k_tolerance);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(exact.size())) / mean, 0.1 * k_tolerance);
}

TEST(InScatterLattice, ShadowsAndSurfacesAreLikeEveryPixelByItself) {
    expect_like_exact(MixedImage(shadows(150, 110)));
}

TEST(InScatterLattice, SoAreManySamplesBehindATiltedPort) {
    SceneDesc desc = ported(shadows(90, 70));
    desc.render.samples = 4;
    expect_like_exact(MixedImage(desc));
}

TEST(InScatterLattice, SoIsALampInView) {
    SceneDesc desc = shadows(120, 90);
    desc.lamps[0].position = {0.3, 0.2, 2};
    expect_like_exact(MixedImage(desc));
}

TEST(InScatterLattice, SoIsAViewWithoutSurfaces) {
    SceneDesc desc = shadows(70, 50);
    desc.geometry.clear();
    expect_like_exact(MixedImage(desc));
}

TEST(InScatterLattice, LampsApartAddUpAndTheFirstSlabIsTheSlabs) {
    SceneDesc desc = shadows(64, 48);
    desc.render.planes.count = 4;
    desc.render.planes.near = 0.5;
    desc.render.planes.far = 4;
    const MixedImage apart(desc);
    const std::vector<PixelResult> mixed = apart.render(k_coarsest_tolerance),
                                   exact = apart.render(0);
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        for (std::size_t b = 0; b < 3; ++b) {
            ASSERT_NEAR(mixed[i].lamps[0][b] + mixed[i].lamps[1][b],
                        mixed[i].direct[b] + mixed[i].backscatter[b],
                        1e-12 * mixed[i].lamps[0][b]);  // rounding
            ASSERT_NEAR(mixed[i].backscatter_first[b], exact[i].backscatter_first[b],
                        10 * k_tolerance * mixed[i].backscatter[b]);
        }
    }
    const std::vector<PixelResult> together =
        MixedImage(desc, {false, false}).render(k_coarsest_tolerance);
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        EXPECT_TRUE(together[i].lamps.empty());
        ASSERT_NEAR(together[i].backscatter[1], mixed[i].backscatter[1],
                    k_tolerance * mixed[i].backscatter[1]);
    }
}

// Rays from which the water is interpolated go on behind a wall that others see farther away: what
// they meet there must not make less than nothing of a lamp's light before it.
TEST(InScatterLattice, NoLampBehindAWallTakesLightAway) {
    const SceneDesc desc = load_scene_text(
        "uwvdb: 1\n"
        "camera:\n"
        "  {resolution: [6, 9], intrinsics: {fx: 20000}, pose: {position: [0, 0, 0], look_at: [0, "
        "0, 1]}}\n"
        "water:\n"
        "  absorption: [0.1, 0.1, 0.1]\n"
        "  scattering: {b: [1, 1, 1], phase: {type: hg, g: 0.5}}\n"
        "geometry: [{type: plane, point: [0, 0, 0.1], normal: [0.5, 0.2, -1]}]\n"
        "lamps:\n"
        "  - {position: [0.05, 0, 0], intensity: [7000, 7000, 7000]}\n"
        "  - {name: behind, position: [0.05, 0.02, 0.12], intensity: [300, 300, 300]}\n",
        "scene.yaml");
    constexpr double k_of_images = 4e-3;
    for (const PixelResult& pixel : MixedImage(desc, {.lamps = true}).render(k_of_images))
        for (std::size_t b = 0; b < 3; ++b) {
            ASSERT_GT(pixel.lamps[0][b], 0);
            ASSERT_GE(pixel.lamps[1][b], 0);
        }
}

TEST(InScatterLattice, AWindowHoldsTheSamePixels) {
    const MixedImage image(shadows(100, 80));
    const std::vector<PixelResult> whole = image.render(k_coarsest_tolerance);
    const PixelWindow window{37, 21, 71, 66};
    const std::vector<PixelResult> part = image.render(k_coarsest_tolerance, window);
    std::size_t i = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x, ++i)
            ASSERT_EQ(part[i].backscatter[0],
                      whole[static_cast<std::size_t>(y * 100 + x)].backscatter[0]);
}

}  // namespace
}  // namespace uw::test
