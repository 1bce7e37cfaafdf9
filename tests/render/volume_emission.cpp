// ctest labels: analytic
// Volumes that give off light: closed forms for a slab, a ball and equilibrium in a furnace,
// Planck's law, and the light that they scatter and throw on surfaces.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/light/emission.h"
#include "tests/support/film_rendering.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

/// A grid of the value 1 in a box or a ball of voxels, in the world.
struct EmissiveFixture {
    TempDir folder;

    VolumeDesc volume(const VdbFixture& grid) const {
        write_fixture(folder / "emission.vdb", {grid});
        VolumeDesc desc;
        desc.file = folder / "emission.vdb";
        desc.where = "test";
        return desc;
    }
    /// From `z` to `z` + 1, 2 m wide, of voxels of 5 cm.
    VolumeDesc slab(double z) const {
        VdbFixture grid;
        grid.name = "flame";
        grid.min = {-20, -20, 0};
        grid.max = {20, 20, 19};
        grid.value = [](int, int, int) { return 1.0; };
        grid.file_from_index =
            Affine::translation({0.0, 0.0, z + 0.025}) * Affine::scale(Vector3(0.05));
        return volume(grid);
    }
    /// Around (0, 0, z).
    VolumeDesc ball(double radius, double z, double value = 1) const {
        const double voxel = radius / 10;
        VdbFixture grid;
        grid.name = "flame";
        grid.min = {-11, -11, -11};
        grid.max = {11, 11, 11};
        grid.value = [=](int i, int j, int k) { return i * i + j * j + k * k <= 100 ? value : 0; };
        grid.file_from_index = Affine::translation({0.0, 0.0, z}) * Affine::scale(Vector3(voxel));
        return volume(grid);
    }
};

EmissionDesc flame(const PerBand& per_unit) {
    EmissionDesc emission;
    emission.name = "flame";
    emission.grid = "flame";
    emission.per_unit = per_unit;
    emission.where = "test";
    return emission;
}

/// The scene with the volume's light.
SceneDesc emissive(VolumeDesc volume, const EmissionDesc& emission, int width = 8, int height = 6) {
    SceneDesc desc = pinhole_scene(width, height);
    volume.emission = {emission};
    desc.volumes = {std::move(volume)};
    append_emissions(desc.volumes, desc.lamps);
    return desc;
}

double planck_band(double temperature, double begin_nm, double end_nm) {
    // [W/(sr m^2)], Simpson's rule: smooth, so that 200 steps are exact to 1e-8.
    constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
    const auto radiance = [&](double nm) {
        const double x = nm * 1e-9;
        return 2 * h * c * c / std::pow(x, 5) / std::expm1(h * c / (x * k * temperature)) * 1e-9;
    };
    constexpr int k_simpson = 200;
    double sum = 0;
    for (int i = 0; i <= k_simpson; ++i) {
        const double weight = i == 0 || i == k_simpson ? 1 : i % 2 == 1 ? 4 : 2;
        sum += weight * radiance(begin_nm + (end_nm - begin_nm) * i / k_simpson);
    }
    return sum * (end_nm - begin_nm) / (3 * k_simpson);
}

class EmissionOf : public testing::TestWithParam<RenderDesc::Integrator> {
  protected:
    EmissiveFixture fixture_;
};

// A slab of thickness L, behind d of water: int e^-cs ds = (e^-cd - e^-c(d + L)) / c.
TEST_P(EmissionOf, OfASlabIsDimmedByWhatIsBeforeEachPartOfIt) {
    SceneDesc desc = emissive(fixture_.slab(1.5), flame({3, 2, 1}));
    desc.render.integrator = GetParam();
    const TestScene scene(desc);
    const Medium& medium = scene.assembled().water.medium;
    for (const auto& [x, y] : {std::pair{4, 3}, {3, 2}}) {
        const Ray ray = scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5).value();
        const PixelResult pixel = scene.pixel(x, y);
        const double slant = 1 / ray.direction.z;
        for (std::size_t band = 0; band < 3; ++band) {
            const double emission = 3 - static_cast<double>(band);
            const double c = medium.uniform.attenuation(band);
            const double truth =
                emission * (std::exp(-c * 1.5 * slant) - std::exp(-c * 2.5 * slant)) / c;
            // The slab fades over a voxel around its faces, and the knots of the profile, a quarter
            // of a voxel apart, do not meet the ramp's four corners: each is off by 1/128 of a
            // voxel at most, 4e-4 m.
            EXPECT_NEAR(pixel.direct[band], truth, 4e-4 * truth);
            EXPECT_NEAR(pixel.clean[band], emission * slant, 4e-4 * emission);
            EXPECT_NEAR(pixel.lamps[0][band], pixel.direct[band] + pixel.backscatter[band],
                        1e-12 * pixel.lamps[0][band]);
        }
        EXPECT_FALSE(pixel.shows_lamp);  // pictures are exposed for it
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, EmissionOf,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::reference));

// A surface hides what emits light behind it, and what emits before it hides nothing.
TEST(Emission, EndAtSurfaces) {
    const EmissiveFixture fixture;
    SceneDesc desc = emissive(fixture.slab(1.5), flame({3, 2, 1}));
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.geometry = {plane_at_z(2)};
    desc.geometry[0].reflectance = {0, 0, 0};
    const TestScene scene(desc);
    const Ray ray = scene.assembled().camera->refracted_ray(4.5, 3.5).value();
    EXPECT_NEAR(scene.pixel(4, 3).direct[0], 3 * 0.5 / ray.direction.z, 1e-6);
}

// Outside of a ball the irradiance is that of all its light at its centre, as the parts of it lie
// around each other as evenly as their number allows.
TEST(Emission, LightSurfacesAsABallDoes) {
    const EmissiveFixture fixture;
    EmissionDesc emission = flame({3, 2, 1});
    emission.samples = 64;
    SceneDesc desc = emissive(fixture.ball(0.3, 1), emission);
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.geometry = {plane_at_z(2)};
    int voxels = 0;
    for (int i = -10; i <= 10; ++i)
        for (int j = -10; j <= 10; ++j)
            for (int k = -10; k <= 10; ++k) voxels += i * i + j * j + k * k <= 100 ? 1 : 0;
    const double intensity = 3 * voxels * std::pow(0.03, 3);
    const TestScene scene(desc);
    ASSERT_EQ(scene.assembled().lamps.size(), 1U);
    EXPECT_EQ(scene.assembled().emitters.size(), 64U);
    EXPECT_NEAR(scene.assembled().lamps[0].axis_intensity()[0], intensity, 1e-3 * intensity);
    EXPECT_NEAR(scene.assembled().lamps[0].position().z, 1, 1e-3);
    double fraction = 0;
    for (const Lamp& emitter : scene.assembled().emitters) {
        fraction += emitter.fraction();
        EXPECT_NEAR(emitter.fraction(), 1.0 / 64, 0.25 / 64);  // of 60 or so voxels each
    }
    EXPECT_NEAR(fraction, 1, 1e-12);
    for (const auto& [x, y] : {std::pair{4, 3}, {0, 0}, {7, 2}}) {
        const PixelResult pixel = scene.pixel(x, y);
        const Vector3 way = pixel.hit.position - Point3(0, 0, 1);
        const double r = glm::length(way);
        EXPECT_NEAR(pixel.irradiance[0], intensity / (r * r) * way.z / r,
                    4e-3 * pixel.irradiance[0]);
    }
}

// What the water scatters of a small emissive volume is what it scatters of a lamp as bright.
TEST(Emission, AreScatteredAsALampIs) {
    const EmissiveFixture fixture;
    EmissionDesc emission = flame({3e5, 2e5, 1e5});
    SceneDesc desc = emissive(fixture.ball(0.02, 1), emission, 16, 12);
    desc.volumes[0].world_from_upright = Affine::translation({1.5, 0.2, 0.0});
    const TestScene scene(desc);
    const Lamp& whole = scene.assembled().lamps[0];
    SceneDesc lit = pinhole_scene(16, 12);
    lit.lamps = {isotropic_lamp(whole.position(), whole.axis_intensity()[0])};
    const TestScene lamp(lit);
    for (const auto& [x, y] : {std::pair{4, 3}, {8, 6}, {14, 2}}) {
        const double truth = lamp.pixel(x, y).backscatter[0];
        EXPECT_GT(truth, 0);
        EXPECT_NEAR(scene.pixel(x, y).backscatter[0], truth, 2e-3 * truth);
    }
}

TEST(Emission, OfABlackbodyFollowPlancksLaw) {
    EmissionDesc emission = flame({0.5, 0.5, 0.5});
    emission.blackbody = EmissionDesc::Blackbody{1000, 273.15};
    const std::vector<double> bands{620, 540, 450};
    const Emission light(emission, bands);
    // The bands' intervals end in the middle between them (core/image/spectral_bands).
    const std::vector<std::array<double, 2>> intervals{{580, 660}, {495, 580}, {405, 495}};
    const double mean_width = (80 + 85 + 90) / 3.0;
    for (const double value : {0.4, 1.0, 2.3, 5.0, 20.0}) {
        const Spectrum found = light.of(value);
        for (std::size_t band = 0; band < 3; ++band) {
            const auto [begin, end] = intervals[band];
            const double truth =
                0.5 * planck_band(1000 * value + 273.15, begin, end) * mean_width / (end - begin);
            EXPECT_NEAR(found[band], truth, 2e-3 * truth) << value << " " << band;
        }
    }
    EXPECT_EQ(light.of(0.2), Spectrum{});  // below 500 K
    const std::vector<double> one{540};
    EXPECT_THROW(Emission(emission, one), InputError);
}

TEST(Emission, OfATableAreLinearBetweenItsRows) {
    EmissionDesc emission = flame({4, 3, 0});
    emission.table = {{0.5, {1, 0, 0}}, {1, {2, 3, 0}}, {3, {4, 1, 0}}};
    const std::vector<double> bands{620, 540, 450};
    const Emission light(emission, bands);
    EXPECT_EQ(light.of(0.499), Spectrum{});
    const std::vector<std::pair<double, std::array<double, 2>>> expected{
        {0.5, {1, 0}},     {0.75, {1.5, 1.5}}, {1, {2, 3}},
        {2.5, {3.5, 1.5}}, {3, {4, 1}},        {9, {4, 1}}};
    for (const auto& [value, truth] : expected) {
        EXPECT_NEAR(light.of(value)[0], truth[0], 1e-12) << value;
        EXPECT_NEAR(light.of(value)[1], truth[1], 1e-12) << value;
        EXPECT_EQ(light.of(value)[2], 0) << value;
    }
}

// Light that the water's speed sets off, in a flow across the view whose speed grows along it: of v
// = z / (1 s) from 1.5 to 2.5 m/s, the emission at depth z is z - 1.5 m, int (z - 1.5) e^-cz dz.
TEST(Emission, AreSetOffByTheWatersSpeed) {
    const EmissiveFixture fixture;
    VdbFixture grid;
    grid.name = "flame";
    grid.min = {-20, -20, 0};
    grid.max = {20, 20, 19};
    grid.value = [](int, int, int) { return 1.0; };
    grid.file_from_index = Affine::translation({0.0, 0.0, 1.525}) * Affine::scale(Vector3(0.05));
    VdbFixture velocity = grid;
    velocity.name = "v.x";
    velocity.value = [](int, int, int k) { return 1.525 + 0.05 * k; };
    VdbFixture still = grid;
    still.name = "v.y";
    still.value = [](int, int, int) { return 0.0; };
    VdbFixture still_too = still;
    still_too.name = "v.z";
    write_fixture(fixture.folder / "flow.vdb", {grid, velocity, still, still_too});
    VolumeDesc volume;
    volume.file = fixture.folder / "flow.vdb";
    volume.where = "test";
    volume.motion = MotionDesc{{"v.x", "v.y", "v.z"}, volume.file, false, {}, 0, "test.velocity"};
    EmissionDesc emission = flame({3, 2, 1});
    emission.stimulus = EmissionDesc::Stimulus{EmissionDesc::Stimulus::Quantity::speed, 1.5, 2.5};
    const TestScene scene(emissive(volume, emission));
    const Medium& medium = scene.assembled().water.medium;
    const Ray ray = scene.assembled().camera->refracted_ray(4.5, 3.5).value();
    const double slant = 1 / ray.direction.z;
    const PixelResult pixel = scene.pixel(4, 3);
    for (std::size_t band = 0; band < 3; ++band) {
        const double c = medium.uniform.attenuation(band) * slant;
        const double truth = (3 - static_cast<double>(band)) * slant *
                             (std::exp(-c * 1.5) - (1 + c) * std::exp(-c * 2.5)) / (c * c);
        // The light fades over a voxel around its far face, where it is brightest, and the voxels
        // next to the faces have the fractions at their centres: of a voxel's third moment, 1e-3 of
        // it.
        EXPECT_NEAR(pixel.direct[band], truth, 2e-3 * truth) << band;
    }
}

// Within a gas that absorbs as much as it emits, and is as hot everywhere, one sees a blackbody.
TEST(Emission, AreInEquilibriumInAFurnace) {
    const EmissiveFixture fixture;
    EmissionDesc emission = flame({30, 20, 40});
    emission.blackbody = EmissionDesc::Blackbody{1, 1999};
    SceneDesc desc = emissive(fixture.slab(-0.5), emission);  // around the camera
    desc.water.absorption = {30, 20, 40};
    desc.water.scattering->b = {0, 0, 0};
    emission.per_unit = {1, 1, 1};
    const Spectrum truth = Emission(emission, desc.water.bands_nm).of(1);
    const PixelResult pixel = TestScene(desc).pixel(4, 3);
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_GT(truth[band], 0);
        // e^-10 is left at the slab's face.
        EXPECT_NEAR(pixel.direct[band], truth[band], 1e-4 * truth[band]) << band;
    }
}

// Where such a gas scatters, too, a = 2 and b = 1 per metre, what is not scattered is a / c = 2/3
// of the blackbody, and what is scattered once, isotropically, b / c of that. In single scattering
// points bring less of the latter, the fewer they are, as docs/scene-file.md says.
TEST(Emission, AreTooDarkInAFurnaceThatScattersOnce) {
    const EmissiveFixture fixture;
    VdbFixture grid;
    grid.name = "flame";
    grid.min = {0, 0, 0};
    grid.max = {19, 19, 19};
    grid.value = [](int, int, int) { return 1.0; };
    grid.file_from_index = Affine::translation({-1.9, -1.9, -1.9}) * Affine::scale(Vector3(0.2));
    EmissionDesc emission = flame({2, 2, 2});
    VolumeDesc volume = fixture.volume(grid);
    GridMappingDesc& gas = volume.grids.emplace_back();
    gas.grid = "flame";
    gas.optics =
        GridMappingDesc::Optics{{2, 2, 2}, {1, 1, 1}, PhaseDesc{HenyeyGreensteinDesc{0}, "test"}};
    SceneDesc desc = emissive(volume, emission);
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    double direct = 0, scattered = 0;
    const std::vector<PixelResult> image = TestScene(desc).image();
    for (const PixelResult& pixel : image) {
        direct += pixel.direct[0] / static_cast<double>(image.size());
        scattered += pixel.backscatter[0] / static_cast<double>(image.size());
    }
    // e^-6 is left at the faces, where the grid fades within a voxel.
    EXPECT_NEAR(direct, 2.0 / 3, 3e-3);
    EXPECT_NEAR(scattered, 0.017, 0.001);
    EXPECT_LT(scattered, 2.0 / 9);
}

/// The mean over an image of what is not direct, in one band, and its standard error.
struct MeanLight {
    double light = 0, error = 0;
};

MeanLight scattered_light(SceneDesc desc, RenderDesc::Integrator integrator, int samples) {
    desc.render.scattering = RenderDesc::Scattering::multiple;
    desc.render.integrator = integrator;
    desc.render.samples = samples;
    const RenderedFilm image(desc);
    const int width = image.film().width(), height = image.film().height();
    MeanLight mean;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double error = image.value(Layer::error, x, y, 0) / (width * height);
            mean.error += error * error;
        }
    mean.error = std::sqrt(mean.error);
    mean.light =
        (image.sum(Layer::backscatter, 0) + image.sum(Layer::multiple, 0)) / (width * height);
    return mean;
}

/// A furnace of voxels around the camera: a gas that absorbs, emits and scatters, 24 optical depths
/// wide, in clear water. Its radiance is 1, of which a / c = 2/3 is direct.
SceneDesc scattering_furnace(const EmissiveFixture& fixture) {
    VdbFixture grid;
    grid.name = "flame";
    grid.min = {0, 0, 0};
    grid.max = {19, 19, 19};
    grid.value = [](int, int, int) { return 1.0; };
    grid.file_from_index = Affine::translation({-1.9, -1.9, -1.9}) * Affine::scale(Vector3(0.2));
    VolumeDesc volume = fixture.volume(grid);
    GridMappingDesc& gas = volume.grids.emplace_back();
    gas.grid = "flame";
    gas.optics =
        GridMappingDesc::Optics{{4, 4, 4}, {2, 2, 2}, PhaseDesc{HenyeyGreensteinDesc{0}, "test"}};
    SceneDesc desc = emissive(volume, flame({4, 4, 4}));
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    return desc;
}

// In all light paths meet the volume itself, so that nothing is missing.
TEST(Emission, AreInEquilibriumInAFurnaceThatScatters) {
    const EmissiveFixture fixture;
    const SceneDesc desc = scattering_furnace(fixture);
    const MeanLight paths = scattered_light(desc, RenderDesc::Integrator::path, 1024);
    EXPECT_NEAR(paths.light, 1.0 / 3, 4 * paths.error);
    EXPECT_LT(paths.error, 1e-3);
    const MeanLight fast = scattered_light(desc, RenderDesc::Integrator::volume, 1);
    // Its nodes' paths are few beside those; what is interpolated is the same everywhere.
    EXPECT_NEAR(fast.light, 1.0 / 3, 0.01);
}

// Far from a small ball its light is that of a lamp as bright, however often it is scattered.
TEST(Emission, AreScatteredManyTimesAsALampIs) {
    const EmissiveFixture fixture;
    SceneDesc desc = emissive(fixture.ball(0.05, 3), flame({3e5, 2e5, 1e5}));
    desc.volumes[0].world_from_upright = Affine::translation({2.5, 0.2, 0.0});
    desc.water = hg_water(0.7);
    desc.water.absorption = {0.1, 0.1, 0.1};
    desc.water.scattering->b = {0.5, 0.5, 0.5};
    desc.geometry = {plane_at_z(5)};
    const Lamp whole = TestScene(desc).assembled().lamps[0];
    SceneDesc lit = desc;
    lit.volumes.clear();
    lit.lamps = {isotropic_lamp(whole.position(), whole.axis_intensity()[0])};
    const MeanLight ball = scattered_light(desc, RenderDesc::Integrator::path, 4096),
                    lamp = scattered_light(lit, RenderDesc::Integrator::path, 1024);
    const double error = std::hypot(ball.error, lamp.error);
    EXPECT_NEAR(ball.light, lamp.light, 4 * error);
    EXPECT_LT(error, 0.01 * lamp.light);
    EXPECT_GT(lamp.error, 0);
}

TEST(Emission, HaveANameOfTheirOwn) {
    SceneDesc desc = pinhole_scene(4, 3);
    VolumeDesc volume;
    volume.emission = {flame({1, 1, 1})};
    desc.volumes = {volume};
    desc.lamps = {isotropic_lamp({}, 1)};
    desc.lamps[0].name = "flame";
    EXPECT_THROW(append_emissions(desc.volumes, desc.lamps), InputError);
}

}  // namespace
}  // namespace uw::test
