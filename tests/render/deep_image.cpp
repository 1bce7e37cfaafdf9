// ctest labels: unit metamorphic
// Deep images: flattened they are the image; and what is put into them is dimmed and veiled as in a
// render of the same thing.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "tests/support/image_of.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

struct FlatPixel {
    std::array<double, 3> colour{};
    double alpha = 0;
};

/// OpenEXR, "Interpreting Deep Pixels": over, front to back; up to `z` a sample that it cuts is
/// split as that page says.
FlatPixel flattened(const std::vector<DeepSample>& samples, double z = 1e30) {
    FlatPixel flat;
    for (const DeepSample& sample : samples) {
        if (static_cast<double>(sample.z) >= z) break;
        const auto alpha = static_cast<double>(sample.alpha);
        double part = 1;
        if (static_cast<double>(sample.z_back) > z)
            part = (z - static_cast<double>(sample.z)) /
                   (static_cast<double>(sample.z_back) - static_cast<double>(sample.z));
        const double own = alpha < 1 ? 1 - std::pow(1 - alpha, part) : 1;
        const double of_colour = alpha > 0 ? own / alpha : part;
        for (std::size_t c = 0; c < 3; ++c)
            flat.colour[c] += (1 - flat.alpha) * of_colour * static_cast<double>(sample.colour[c]);
        flat.alpha += (1 - flat.alpha) * own;
    }
    return flat;
}

struct DeepRender {
    Film film;
    DeepImage deep;
};

DeepRender render_deep(const SceneDesc& desc, int most = 32) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    renderer.render({.layers = "depth,direct,backscatter", .deep = most});
    return {renderer.release_film(), renderer.release_deep().value()};
}

/// A blob of particles between two lamps and a wall, with a box whose edges cross pixels.
SceneDesc scene_with_blob(const TempDir& dir) {
    constexpr double k_deep_voxel = 0.1, k_deep_sigma = 0.3;
    VdbFixture grid;
    grid.min = {-12, -12, -12};
    grid.max = {12, 12, 12};
    grid.value = [](int i, int j, int k) {
        return std::exp(-0.5 * k_deep_voxel * k_deep_voxel * (i * i + j * j + k * k) /
                        (k_deep_sigma * k_deep_sigma));
    };
    grid.file_from_index =
        Affine::translation({0.1, 0.0, 2.2}) * Affine::scale(Vector3(k_deep_voxel));
    write_fixture(dir / "blob.vdb", {grid});
    SceneDesc desc = pinhole_scene(24, 16);
    desc.water = hg_water(0.8);
    desc.geometry = {plane_at_z(4), box({-0.5, -0.4, 1.4}, {-0.1, 0.1, 1.8})};
    desc.lamps = {isotropic_lamp({-0.9, -0.7, 0.1}, 50), isotropic_lamp({0.6, 0.5, 1.2}, 10)};
    VolumeDesc volume;
    volume.file = dir / "blob.vdb";
    volume.where = "test";
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.where = "test";
    mapping.optics = {{0.2, 0.3, 0.4}, {2.0, 2.5, 3.0}, {}};
    volume.grids = {mapping};
    desc.volumes = {volume};
    return desc;
}

// Alphas and colours are rounded to 32-bit floats, whose errors add up over some thirty samples;
// half of a half float's step is 2^-11.
void expect_flattens_to_the_image(const DeepRender& render) {
    std::size_t most = 0;
    for (int y = 0; y < render.film.height(); ++y)
        for (int x = 0; x < render.film.width(); ++x) {
            const std::vector<DeepSample>& samples = render.deep.pixel(x, y);
            const std::span<const float> pixel = render.film.pixel(x, y);
            const FlatPixel flat = flattened(samples);
            for (std::size_t c = 0; c < 3; ++c) {
                const auto truth = static_cast<double>(pixel[c]);
                ASSERT_NEAR(flat.colour[c], truth, 2e-6 * truth) << x << ", " << y;
            }
            ASSERT_NEAR(flat.alpha, static_cast<double>(pixel[k_alpha]), 1e-6);
            float end = 0;
            for (const DeepSample& sample : samples) {
                ASSERT_GE(sample.z, end);
                ASSERT_GE(sample.z_back, sample.z);
                ASSERT_GE(sample.alpha, 0);
                ASSERT_LE(sample.alpha, 1);
                end = sample.z_back;
            }
            most = std::max(most, samples.size());
        }
    EXPECT_GT(most, 8U);
    EXPECT_LE(most, 32U);
}

TEST(DeepImages, FlattenToTheImage) {
    const TempDir dir;
    SceneDesc desc = scene_with_blob(dir);
    desc.render.samples = 4;
    expect_flattens_to_the_image(render_deep(desc));
    desc.geometry.clear();  // open water, whose last sample hides everything
    expect_flattens_to_the_image(render_deep(desc));
}

TEST(DeepImages, FlattenToTheImageInAllLight) {
    const TempDir dir;
    SceneDesc desc = scene_with_blob(dir);
    desc.render.scattering = RenderDesc::Scattering::multiple;
    desc.render.quality = RenderDesc::Quality::draft;
    expect_flattens_to_the_image(render_deep(desc));
}

TEST(DeepImages, HaveASurfaceWhereItIs) {
    const TempDir dir;
    SceneDesc desc = scene_with_blob(dir);
    desc.render.samples = 1;
    const DeepRender render = render_deep(desc);
    const LayerPlan plan = layer_plan(SceneDesc(desc), "depth,direct,backscatter");
    const auto depth = static_cast<std::size_t>(plan.first_channel(Layer::depth));
    const auto direct = static_cast<std::size_t>(plan.first_channel(Layer::direct));
    for (const auto& [x, y] : {std::pair{12, 8}, {8, 6}, {1, 1}, {22, 14}}) {
        const std::vector<DeepSample>& samples = render.deep.pixel(x, y);
        const std::span<const float> pixel = render.film.pixel(x, y);
        ASSERT_EQ(samples.back().z, samples.back().z_back);
        EXPECT_EQ(samples.back().alpha, 1);
        EXPECT_NEAR(samples.back().z, pixel[depth], 1e-5);
        double before = 1;
        for (std::size_t i = 0; i + 1 < samples.size(); ++i)
            before *= 1 - static_cast<double>(samples[i].alpha);
        for (std::size_t b = 0; b < 3; ++b) {
            const auto truth = static_cast<double>(pixel[direct + b]);
            EXPECT_NEAR(before * static_cast<double>(samples.back().colour[b]), truth,
                        1e-5 * truth);
        }
    }
}

// A black wall in the blob leaves the light of the water before it: what the deep image holds up to
// there. It casts no shadow on that, since the lamps are in front of it or nearer to the camera.
// A wall cuts samples, within which light and opacity are taken to be uniform: a fraction of 1/32
// of the light is misplaced; images are within 0.4 % (interpolation between rays).
TEST(DeepImages, HoldTheLightOfTheWaterBeforeEachDistance) {
    const TempDir dir;
    SceneDesc desc = scene_with_blob(dir);
    desc.geometry.clear();
    desc.render.samples = 1;
    const DeepRender all = render_deep(desc, 64);
    for (const double z : {1.5, 2.4}) {
        GeometryDesc wall = plane_at_z(z);
        wall.reflectance = PerBand{0.0, 0.0, 0.0};
        desc.geometry = {wall};
        const Film cut = image_of(desc, {});
        double worst = 0, mean = 0;
        for (int y = 0; y < cut.height(); ++y)
            for (int x = 0; x < cut.width(); ++x) {
                const FlatPixel flat = flattened(all.deep.pixel(x, y), z);
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto truth = static_cast<double>(cut.pixel(x, y)[c]);
                    const double error = flat.colour[c] / truth - 1;
                    worst = std::max(worst, std::abs(error));
                    mean += error / (3 * 24 * 16);
                }
            }
        std::cout << "up to " << z << " m: mean " << 100 * mean << " %, worst " << 100 * worst
                  << " %\n";
        EXPECT_LT(worst, 0.02);
        EXPECT_LT(std::abs(mean), 0.004);
    }
}

// In grey water a surface is dimmed as the deep image's alpha says: a wall in front of another, by
// deep pixels of it alone, is a render of it.
TEST(DeepImages, DimWhatIsPutIntoThem) {
    const TempDir dir;
    SceneDesc desc = scene_with_blob(dir);
    desc.water.absorption = {0.1, 0.1, 0.1};
    desc.water.scattering->b = {0.2, 0.2, 0.2};
    desc.volumes[0].grids[0].optics->absorption = {0.3, 0.3, 0.3};
    desc.volumes[0].grids[0].optics->scattering = {2.5, 2.5, 2.5};
    desc.geometry.clear();
    desc.render.samples = 1;
    const DeepRender all = render_deep(desc, 64);
    constexpr double k_deep_wall = 2.3;
    desc.geometry = {plane_at_z(k_deep_wall)};
    const std::string layers = "transmittance";
    const Film wall = image_of(desc, {.layers = layers});
    const auto first = static_cast<std::size_t>(
        layer_plan(SceneDesc(desc), layers).first_channel(Layer::transmittance));
    for (int y = 0; y < wall.height(); ++y)
        for (int x = 0; x < wall.width(); ++x) {
            const auto truth = static_cast<double>(wall.pixel(x, y)[first]);
            // Within a sample, opacity is uniform.
            EXPECT_NEAR(1 - flattened(all.deep.pixel(x, y), k_deep_wall).alpha, truth, 0.01)
                << x << "," << y;
        }
}

TEST(DeepImages, AreRefusedWhereLightHasNoDistance) {
    SceneDesc desc = pinhole_scene(8, 6);
    desc.geometry = {plane_at_z(2)};
    desc.lamps = {isotropic_lamp({0.5, 0, 0}, 1)};
    const auto refusal = [&](const auto& change) {
        SceneDesc changed = desc;
        change(changed);
        return message_of<UsageError>([&] { render_deep(changed); });
    };
    EXPECT_NE(refusal([](SceneDesc& scene) {
                  scene.render.integrator = RenderDesc::Integrator::path;
              }).find("--integrator volume"),
              std::string::npos);
    EXPECT_NE(refusal([](SceneDesc& scene) {
                  scene.water.forward_scatter.K = 1;
              }).find("water.forward_scatter"),
              std::string::npos);
    EXPECT_NE(refusal([](SceneDesc& scene) {
                  scene.render.output = RenderDesc::Output::paper;
              }).find("render.output"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
