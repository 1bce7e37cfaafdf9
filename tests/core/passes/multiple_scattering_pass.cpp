// ctest labels: unit statistical metamorphic
// The fast form of multiple scattering against light paths.
#include "core/passes/multiple_scattering_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/image_laws.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A box before a wall, in hazy water, and two lamps.
class MultipleLights : public testing::Test {
  protected:
    MultipleLights() {
        desc_.geometry = {plane_at_z(3), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
        desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40), isotropic_lamp({0.6, 0.3, 0.1}, 30)};
        desc_.lamps[1].name = "second";
        desc_.render.scattering = RenderDesc::Scattering::multiple;
        desc_.render.quality = RenderDesc::Quality::draft;
    }

    Film render(const SceneDesc& desc, const RenderOptions& options = {.layers = "all"}) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc));
        plan_ = layer_plan(renderer.scene(), options.layers, options.paths);
        Film film = renderer.render(options);
        const RenderReport& report = renderer.report();
        error_ = report.multiple_error.value_or(report.paths.error.value_or(0));
        return film;
    }
    double mean(const Film& film, Layer layer) const {
        double sum = 0;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                for (std::size_t b = 0; b < 3; ++b)
                    sum += static_cast<double>(film.pixel(
                        x, y)[static_cast<std::size_t>(plan_->first_channel(layer)) + b]);
        return sum / (3.0 * film.width() * film.height());
    }

    SceneDesc desc_ = pinhole_scene(48, 36);
    std::optional<LayerPlan> plan_;
    double error_ = 0;
};

TEST_F(MultipleLights, DependNeitherOnThreadsNorOnTheWindow) {
    const Film film = expect_same_for_threads_and_windows(desc_, {.layers = "all"}, {9, 5, 20, 16});
    EXPECT_GT(expect_components_add_up(film), 0);
}

TEST_F(MultipleLights, AgreeWithLightPathsInTheMean) {
    const Film fast = render(desc_);
    const double fast_error = error_;
    const double water = mean(fast, Layer::multiple_volume);
    const double surfaces = mean(fast, Layer::multiple_surface);
    const double direct = mean(fast, Layer::direct) + mean(fast, Layer::backscatter);
    SceneDesc paths = desc_;
    paths.render.integrator = RenderDesc::Integrator::path;
    paths.render.samples = 64;
    const Film truth = render(paths);
    const double all =
        mean(truth, Layer::multiple) + mean(truth, Layer::direct) + mean(truth, Layer::backscatter);
    ASSERT_GT(fast_error, 0);
    ASSERT_LT(fast_error, 0.1);  // a draft
    // Four standard errors of the two means, of errors that are independent between pixels of the
    // one and some hundred nodes of the other, and 0.5 % for what is between the nodes of a draft.
    const double allowed =
        all *
        (4 * std::hypot(error_ / std::sqrt(48.0 * 36), fast_error / std::sqrt(100.0)) + 0.005);
    EXPECT_NEAR(water, mean(truth, Layer::multiple_volume), allowed);
    EXPECT_NEAR(surfaces, mean(truth, Layer::multiple_surface), allowed);
    // And it is not little that is compared.
    EXPECT_GT(water + surfaces, 0.2 * direct);
}

// Across the edge of a bright box the water's light has a step, which is narrower than the nodes
// are apart: what is scattered just before the box.
TEST_F(MultipleLights, AreAsSharpAsTheSurfacesThatEmit) {
    desc_.camera = pinhole_scene(192, 144).camera;
    desc_.geometry = {plane_at_z(3), box({0, -0.3, 1.2}, {0.5, 0.3, 1.5})};
    desc_.geometry[0].reflectance = PerBand{0.05, 0.05, 0.05};
    desc_.geometry[1].reflectance = PerBand{0.9, 0.9, 0.9};
    desc_.lamps = {isotropic_lamp({0.2, -0.6, 0}, 40)};
    const PixelWindow window{94, 60, 98, 84};  // the edge is at x = 96
    const auto step = [&](const SceneDesc& desc) {
        const Film film = render(desc, {.layers = "all", .window = window});
        const auto channel = static_cast<std::size_t>(plan_->first_channel(Layer::multiple_volume));
        double inside = 0, outside = 0;
        for (int y = window.y0; y < window.y1; ++y) {
            for (std::size_t b = 0; b < 3; ++b) {
                outside += static_cast<double>(film.pixel(95, y)[channel + b]);
                inside += static_cast<double>(film.pixel(96, y)[channel + b]);
            }
        }
        return (inside - outside) / inside;
    };
    const double fast = step(desc_);
    SceneDesc paths = desc_;
    paths.render.integrator = RenderDesc::Integrator::path;
    paths.render.samples = 2048;
    const double truth = step(paths);
    EXPECT_GT(truth, 0.1);
    // 3 % of the light inside: the standard error of the paths is less than 1 %, and the halo is
    // that of small angles.
    EXPECT_NEAR(fast, truth, 0.03);
}

// A wall of steps, each narrower than the nodes are apart and at another distance, so that most
// pixels see one that no node sees: the light on it is that of steps near by.
TEST_F(MultipleLights, ReachSurfacesThatNoNodeSees) {
    desc_ = pinhole_scene(96, 72);
    desc_.geometry.clear();
    for (int i = 0; i < 300; ++i) {
        const double x = -1.8 + 0.012 * i, z = 2 + 0.02 * (i * 37 % 10);
        desc_.geometry.push_back(box({x, -1.5, z}, {x + 0.012, 1.5, 3}));
    }
    desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40)};
    desc_.render.scattering = RenderDesc::Scattering::multiple;
    desc_.render.quality = RenderDesc::Quality::draft;
    const Film fast = render(desc_);
    const double fast_error = error_, surfaces = mean(fast, Layer::multiple_surface);
    SceneDesc paths = desc_;
    paths.render.integrator = RenderDesc::Integrator::path;
    paths.render.samples = 32;
    const Film truth = render(paths);
    const double all =
        mean(truth, Layer::multiple) + mean(truth, Layer::direct) + mean(truth, Layer::backscatter);
    // As in AgreeWithLightPathsInTheMean.
    const double allowed =
        all *
        (4 * std::hypot(error_ / std::sqrt(96.0 * 72), fast_error / std::sqrt(100.0)) + 0.005);
    EXPECT_NEAR(surfaces, mean(truth, Layer::multiple_surface), allowed);
    EXPECT_GT(surfaces, 5 * allowed);
}

TEST_F(MultipleLights, AreDividedAmongTheLamps) {
    const Film film = render(desc_);
    for (int y = 0; y < film.height(); y += 5) {
        for (int x = 0; x < film.width(); x += 5) {
            for (std::size_t b = 0; b < 3; ++b) {
                const auto pixel = film.pixel(x, y);
                double lamps = 0;
                for (const std::size_t lamp : {0U, 1U})
                    lamps += static_cast<double>(
                        pixel[static_cast<std::size_t>(plan_->first_channel_of_lamp(lamp)) + b]);
                // Rounding to float of some terms.
                EXPECT_NEAR(lamps, static_cast<double>(pixel[b]),
                            1e-5 * static_cast<double>(pixel[b]));
            }
        }
    }
}

TEST_F(MultipleLights, LeaveTheRestAsItIs) {
    const Film multiple = render(desc_);
    const auto layers = {Layer::direct, Layer::backscatter, Layer::clean};
    std::vector<double> before;
    for (const Layer layer : layers) before.push_back(mean(multiple, layer));
    SceneDesc single = desc_;
    single.render.scattering = RenderDesc::Scattering::single;
    const Film film = render(single);
    std::size_t i = 0;
    for (const Layer layer : layers) EXPECT_EQ(mean(film, layer), before[i++]);
}

}  // namespace
}  // namespace uw::test
