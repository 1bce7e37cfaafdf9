// ctest labels: metamorphic slow
// Random scenes with a lamp in a plume, or behind it, that the camera looks at: where errors of
// what is known of the way from the lamp do not average out along a ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/base/random.h"
#include "tests/support/random/random_draw.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

// Around (0, 0, 2), of `edge` voxels across 1 m: smooth, or as rough as a grid can be.
void write_plume(const std::filesystem::path& file, int edge, double roughness,
                 std::uint64_t seed) {
    VdbFixture grid;
    const int half = edge / 2;
    grid.min = {-half, -half, -half};
    grid.max = {half, half, half};
    grid.value = [=](int i, int j, int k) {
        const double r2 = (i * i + j * j + k * k) / static_cast<double>(half * half);
        const auto place = static_cast<std::uint64_t>((i + 64) * 16384 + (j + 64) * 128 + k + 64);
        const double noise = PathRandom(PathRandom::seed_of(seed, place), 0).next();
        return r2 > 1 ? 0 : (1 - r2) * (1 - roughness + 2 * roughness * noise);
    };
    grid.file_from_index =
        Affine::translation({0.0, 0.0, 2.0}) * Affine::scale(Vector3(1.0 / edge));
    write_fixture(file, {grid});
}

struct Off {
    // Relative to the image's RMS, for a lamp is far brighter than all the rest, and to the larger
    // of a pixel and the mean.
    double rms = 0, worst = 0;
};

Off difference_of(const std::vector<PixelResult>& image, const std::vector<PixelResult>& truth) {
    double sum = 0, of_all = 0, squares = 0;
    for (const PixelResult& pixel : truth) {
        sum += pixel.backscatter[0];
        of_all += pixel.backscatter[0] * pixel.backscatter[0];
    }
    const double mean = sum / static_cast<double>(truth.size());
    Off off;
    for (std::size_t i = 0; i < image.size(); ++i) {
        const double d = image[i].backscatter[0] - truth[i].backscatter[0];
        squares += d * d;
        off.worst = std::max(off.worst, std::abs(d) / std::max(mean, truth[i].backscatter[0]));
    }
    off.rms = std::sqrt(squares / of_all);
    return off;
}

class LampsInPlumes : public testing::TestWithParam<RenderDesc::Quality> {};

TEST_P(LampsInPlumes, AreSeenAsByTheReference) {
    const TempDir dir;
    Off most;
    for (std::uint64_t seed = 0; seed < 16; ++seed) {
        SCOPED_TRACE(seed);
        RandomDraw draw(seed);
        SceneDesc desc = pinhole_scene(14, 10);
        desc.water = hg_water(draw.uniform(0, 0.95));
        const double reach = draw.chance(0.5) ? 0.45 : 1.5;  // in it, or anywhere around it
        desc.lamps = {isotropic_lamp(
            {draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3), 2 + draw.uniform(-0.3, 1) * reach},
            10)};
        if (draw.chance(0.3)) desc.geometry = {plane_at_z(draw.uniform(2.8, 5))};
        VolumeDesc volume;
        volume.file = dir / "plume.vdb";
        volume.where = "test";
        write_plume(volume.file, draw.whole(16, 48), draw.uniform(0, 1), seed);
        GridMappingDesc mapping;
        mapping.grid = "density";
        mapping.where = "test";
        mapping.optics.emplace();
        mapping.optics->absorption = PerBand(3, draw.log_uniform(0.01, 1));
        mapping.optics->scattering = PerBand(3, draw.log_uniform(0.3, 12));
        volume.grids = {mapping};
        desc.volumes = {volume};
        desc.render.quality = GetParam();
        const std::vector<PixelResult> image = TestScene(desc).image();
        desc.render.integrator = RenderDesc::Integrator::reference;
        const Off off = difference_of(image, TestScene(desc).image());
        most.rms = std::max(most.rms, off.rms);
        most.worst = std::max(most.worst, off.worst);
        std::printf("seed %d: scattering %.3g/m, lamp at z %.3g: RMS %.3f %%, worst %.3f %%\n",
                    static_cast<int>(seed), mapping.optics->scattering.front(),
                    desc.lamps[0].position.z, 100 * off.rms, 100 * off.worst);
        // What `validate` allows.
        EXPECT_LT(off.rms, 0.003);
        EXPECT_LT(off.worst, 0.005);
    }
    std::printf("most: RMS %.3f %%, worst %.3f %%\n", 100 * most.rms, 100 * most.worst);
}

INSTANTIATE_TEST_SUITE_P(Qualities, LampsInPlumes,
                         testing::Values(RenderDesc::Quality::final, RenderDesc::Quality::exact));

}  // namespace
}  // namespace uw::test
