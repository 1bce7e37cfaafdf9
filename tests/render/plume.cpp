// ctest labels: analytic
// A Gaussian plume in a VDB, with a box that throws a shadow through it: the volume integrator
// against the reference integrator.
#include <gtest/gtest.h>

#include "camera/camera.h"
#include "core/base/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

constexpr double k_sigma = 0.25;
constexpr double k_peak_ppm = 3;

// A Gaussian of peak 1 around (0, 0, 2.2) in world axes, cut at 4 sigma (3e-4 of the peak).
std::filesystem::path write_gaussian(const TempDir& dir, double voxel) {
    VdbFixture grid;
    const int reach = static_cast<int>(std::lround(4 * k_sigma / voxel));
    grid.min = {-reach, -reach, -reach};
    grid.max = {reach, reach, reach};
    grid.value = [=](int i, int j, int k) {
        const double r2 = voxel * voxel * (i * i + j * j + k * k);
        return r2 > 16 * k_sigma * k_sigma ? 0 : std::exp(-0.5 * r2 / (k_sigma * k_sigma));
    };
    grid.file_from_index = Affine::translation({0.0, 0.0, 2.2}) * Affine::scale(Vector3(voxel));
    const std::filesystem::path file = dir / "gaussian.vdb";
    write_fixture(file, {grid});
    return file;
}

SceneDesc plume_scene(const std::filesystem::path& file) {
    SceneDesc desc = pinhole_scene(32, 24);
    desc.geometry = {plane_at_z(4), box({-0.35, -0.3, 1.0}, {-0.1, -0.05, 1.25})};
    desc.lamps = {isotropic_lamp({-0.9, -0.7, 0.1}, 50), isotropic_lamp({0.8, -0.4, 0.3}, 20)};
    desc.lamps[1].name = "spot";
    desc.lamps[1].profile = SpotProfileDesc{50, 10};
    desc.lamps[1].direction = glm::normalize(Vector3(-0.8, 0.4, 1.9));
    desc.water.scattering.reset();
    desc.water.small_ppm = 0.02;
    desc.water.large_ppm = 0.05;
    VolumeDesc volume;
    volume.file = file;
    volume.where = "test";
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.small_ppm = 0.3 * k_peak_ppm;
    mapping.large_ppm = k_peak_ppm;
    mapping.where = "test";
    volume.grids = {mapping};
    desc.volumes = {volume};
    return desc;
}

struct Difference {
    double rms = 0;  // of the image mean
    double worst = 0;
};

Difference difference(const std::vector<PixelResult>& image, const std::vector<PixelResult>& truth,
                      std::size_t band) {
    double squares = 0, sum = 0, worst = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double t = truth[i].direct[band] + truth[i].backscatter[band];
        const double d = image[i].direct[band] + image[i].backscatter[band] - t;
        squares += d * d;
        sum += t;
        worst = std::max(worst, std::abs(d));
    }
    const auto n = static_cast<double>(image.size());
    return {std::sqrt(squares / n) / (sum / n), worst / (sum / n)};
}

TEST(GaussianPlume, VolumeIntegratorAgreesWithTheReference) {
    const TempDir dir;
    SceneDesc desc = plume_scene(write_gaussian(dir, 0.04));
    const std::vector<PixelResult> image = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::reference;
    const std::vector<PixelResult> truth = TestScene(desc).image();
    for (std::size_t band = 0; band < 3; ++band) {
        const Difference d = difference(image, truth, band);
        std::cout << "band " << band << ": RMS " << 100 * d.rms << " %, worst " << 100 * d.worst
                  << " % of the image mean\n";
        EXPECT_LT(d.rms, 0.003);  // the bound
    }
}

TEST(GaussianPlume, VolumeIntegratorAgreesWithTheReferenceInTheLightOfAPanel) {
    const TempDir dir;
    SceneDesc desc = plume_scene(write_gaussian(dir, 0.05));
    resize_image(desc.camera, 16, 12);
    desc.lamps.pop_back();
    desc.lamps[0].profile = CosineProfileDesc{120};
    desc.lamps[0].extent = LampExtentDesc{LampExtentDesc::Shape::rectangle, 0.5, 0.2, 0, 0, 6};
    const std::vector<PixelResult> image = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::reference;
    const std::vector<PixelResult> truth = TestScene(desc).image();
    for (std::size_t band = 0; band < 3; ++band)
        EXPECT_LT(difference(image, truth, band).rms, 0.003);  // as for point lamps
}

TEST(GaussianPlume, DimsWhatIsBehindItAndScattersLight) {
    const TempDir dir;
    const SceneDesc with = plume_scene(write_gaussian(dir, 0.05));
    SceneDesc without = with;
    without.volumes.clear();
    const PixelResult plume = TestScene(with).pixel(16, 12);
    const PixelResult clear = TestScene(without).pixel(16, 12);
    EXPECT_LT(plume.transmittance[1], 0.8 * clear.transmittance[1]);
    EXPECT_GT(plume.backscatter[1], 1.2 * clear.backscatter[1]);
}

// Voxels of random density in a ball around (0, 0, 2.2), as rough as a grid can be.
std::filesystem::path write_rough_ball(const TempDir& dir) {
    constexpr double k_voxel = 0.05;
    VdbFixture grid;
    grid.min = {-10, -10, -10};
    grid.max = {10, 10, 10};
    grid.value = [](int i, int j, int k) {
        const auto place = static_cast<std::uint64_t>((i + 32) * 4096 + (j + 32) * 64 + k + 32);
        return i * i + j * j + k * k > 100 ? 0
                                           : PathRandom(PathRandom::seed_of(1, place), 0).next();
    };
    grid.file_from_index = Affine::translation({0.0, 0.0, 2.2}) * Affine::scale(Vector3(k_voxel));
    const std::filesystem::path file = dir / "ball.vdb";
    write_fixture(file, {grid});
    return file;
}

// All light that is scattered forwards comes from the lamp the same way: errors of the map of
// columns do not average out along the ray.
TEST(DensePlume, ALampInItOrBehindItIsSeenAsByTheReference) {
    const TempDir dir;
    const std::filesystem::path file = write_rough_ball(dir);
    for (const double lamp_z : {2.2, 3.2})
        for (const double scattering : {3.0, 10.0}) {
            SceneDesc desc = pinhole_scene(16, 12);
            desc.lamps = {isotropic_lamp({0.03, 0.02, lamp_z}, 50)};
            VolumeDesc volume;
            volume.file = file;
            volume.where = "test";
            GridMappingDesc mapping;
            mapping.grid = "density";
            mapping.optics.emplace();
            mapping.optics->absorption = {0.1, 0.1, 0.1};
            mapping.optics->scattering = PerBand(3, 2 * scattering);  // of the mean value, 1/2
            mapping.where = "test";
            volume.grids = {mapping};
            desc.volumes = {volume};
            desc.render.quality = RenderDesc::Quality::exact;
            const std::vector<PixelResult> image = TestScene(desc).image();
            desc.render.integrator = RenderDesc::Integrator::reference;
            const std::vector<PixelResult> truth = TestScene(desc).image();
            const Difference d = difference(image, truth, 1);
            std::cout << "lamp at " << lamp_z << ", " << scattering << "/m: RMS " << 100 * d.rms
                      << " %, worst " << 100 * d.worst << " % of the image mean\n";
            EXPECT_LT(d.rms, 0.003) << lamp_z << " " << scattering;
        }
}

}  // namespace
}  // namespace uw::test
