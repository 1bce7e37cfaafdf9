// ctest labels: analytic metamorphic slow
// A port with indices by wavelength: every band is what a port with its numbers shows.
#include "camera/lateral_colour.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/film_rendering.h"

namespace uw::test {
namespace {

/// A ball before a wall, seen through water whose dispersion is ten times that of real water, so
/// that a small image has some.
SceneDesc dispersing_scene() {
    SceneDesc desc = pinhole_scene(32, 24);
    desc.water = hg_water(0.8);
    desc.camera.intrinsics = {19, 19, 16, 12};
    desc.geometry = {plane_at_z(3)};
    GeometryDesc ball;
    ball.type = GeometryDesc::Type::sphere;
    ball.center = {0.5, 0.3, 2};
    ball.radius = 0.5;
    ball.reflectance = {0.9, 0.3, 0.6};
    desc.geometry.push_back(ball);
    desc.lamps = {isotropic_lamp({-0.5, 0, 0}, 10), isotropic_lamp({0.5, 0.2, 0}, 10)};
    desc.lamps[1].name = "other";
    FlatPortDesc port;
    port.distance = 0.02;
    port.thickness = 0.01;
    port.dispersion.glass = DispersionDesc{.material = DispersionDesc::Material::bk7};
    port.dispersion.water = DispersionDesc{.material = DispersionDesc::Material::abbe};
    port.dispersion.water->n_d = 1.334;
    port.dispersion.water->abbe = 10;
    desc.camera.port = port;
    set_wavelength(desc.camera, reference_wavelength(desc.water.bands_nm));
    desc.render.samples = 4;
    return desc;
}

/// The same with the numbers of one wavelength for all bands.
SceneDesc of_wavelength(SceneDesc desc, double nm) {
    set_wavelength(desc.camera, nm);
    std::get<FlatPortDesc>(*desc.camera.port).dispersion = {};
    return desc;
}

/// Every band of the light of an image is, to the bit, what the scene of that band's numbers has,
/// and all else what the reference band's has.
void expect_bands_of_their_own(const SceneDesc& desc) {
    ASSERT_EQ(colour_groups_of(desc).size(), 3U);
    const LayerPlan plan = layer_plan(SceneDesc(desc), "all");
    const RenderedFilm dispersed(desc), reference(of_wavelength(desc, desc.camera.wavelength_nm));
    bool differs = false;
    for (int band = 0; band < 3; ++band) {
        const double nm = desc.water.bands_nm[static_cast<std::size_t>(band)];
        const RenderedFilm own(of_wavelength(desc, nm));
        for (int y = 0; y < desc.camera.height; ++y)
            for (int x = 0; x < desc.camera.width; ++x) {
                EXPECT_EQ(dispersed.total(x, y, band), own.total(x, y, band)) << x << ' ' << y;
                differs = differs || own.total(x, y, band) != reference.total(x, y, band);
                for (std::size_t lamp = 0; lamp < 2; ++lamp)
                    EXPECT_EQ(dispersed.lamp(lamp, x, y, band), own.lamp(lamp, x, y, band));
                for (const LayerKind& kind : k_layers) {
                    if (!plan.has(kind.layer)) continue;
                    const bool of_band = is_of_exposure(kind.content) && kind.suffixes.empty();
                    EXPECT_EQ(
                        dispersed.value(kind.layer, x, y, of_band ? band : 0),
                        (of_band ? own : reference).value(kind.layer, x, y, of_band ? band : 0))
                        << kind.name << ' ' << x << ' ' << y;
                }
            }
    }
    EXPECT_TRUE(differs);
}

TEST(LateralColourOfImages, OfSingleScattering) {
    expect_bands_of_their_own(dispersing_scene());
}

TEST(LateralColourOfImages, WithForwardScatter) {
    SceneDesc desc = dispersing_scene();
    desc.water.forward_scatter.K = 0.5;
    desc.water.forward_scatter.G = 0.05;
    desc.water.forward_scatter.B = 0.2;
    expect_bands_of_their_own(desc);
}

TEST(LateralColourOfImages, OfAllLight) {
    SceneDesc desc = dispersing_scene();
    desc.render.scattering = RenderDesc::Scattering::multiple;
    resize_image(desc.camera, 12, 9);
    expect_bands_of_their_own(desc);
}

TEST(LateralColourOfImages, OfLightPaths) {
    SceneDesc desc = dispersing_scene();
    desc.render.integrator = RenderDesc::Integrator::path;
    expect_bands_of_their_own(desc);
}

// The ball's blue edge lies farther out than its red one, as the index of water is greater there.
TEST(LateralColourOfImages, EnlargesBlueMost) {
    const SceneDesc desc = dispersing_scene();
    const Camera red(of_wavelength(desc, 620).camera), blue(of_wavelength(desc, 450).camera);
    const Point3 edge{1, 0.3, 2};
    EXPECT_GT(blue.project(edge)->x, red.project(edge)->x + 0.2);
}

TEST(LateralColourOfImages, DraftsAndSmallDifferencesShareTheirRays) {
    SceneDesc desc = dispersing_scene();
    desc.render.quality = RenderDesc::Quality::draft;
    EXPECT_LT(colour_groups_of(desc).size(), 3U);
    desc = dispersing_scene();
    auto& port = std::get<FlatPortDesc>(*desc.camera.port);
    port.dispersion.water->abbe = 200;
    set_wavelength(desc.camera, desc.camera.wavelength_nm);
    ASSERT_EQ(colour_groups_of(desc).size(), 1U);
    const RenderedFilm shared(desc), numbers(of_wavelength(desc, desc.camera.wavelength_nm));
    EXPECT_TRUE(std::ranges::equal(shared.film().values(), numbers.film().values(),
                                   [](float a, float b) { return a == b || (a != a && b != b); }));
}

// R, G and B of other numbers of bands are the colour of the bands of all groups together.
TEST(LateralColourOfImages, HasTheColourOfAllItsBands) {
    SceneDesc desc = dispersing_scene();
    desc.water.bands_nm = {450, 500, 550, 600, 650};
    desc.water.absorption = std::vector<double>(5, 0.1);
    desc.water.scattering->b = std::vector<double>(5, 0.2);
    for (LampDesc& lamp : desc.lamps) lamp.intensity = std::vector<double>(5, 10.0);
    for (GeometryDesc& object : desc.geometry) object.reflectance = std::vector<double>(5, 0.5);
    set_wavelength(desc.camera, 550);
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    const Film& film = renderer.render({.layers = "total"});
    EXPECT_EQ(renderer.report().colour_groups, 5U);
    const BandColour colour(desc.water.bands_nm);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            Spectrum total;
            for (std::size_t band = 0; band < 5; ++band)
                total[band] = static_cast<double>(pixel[4 + band]);
            const LinearRgb rgb = colour(total);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(static_cast<double>(pixel[c]), rgb[c], 1e-6 * rgb[1]) << x << ' ' << y;
        }
}

}  // namespace
}  // namespace uw::test
