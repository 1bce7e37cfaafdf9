// ctest labels: unit statistical metamorphic
// Images of light paths: what they hold, and how sure they are of it.
#include "core/passes/path_pass.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/image_laws.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A box before a wall, in hazy water, and two lamps.
class PathFilms : public testing::Test {
  protected:
    PathFilms() {
        desc_ = pinhole_scene(12, 9);
        desc_.geometry = {plane_at_z(3), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
        desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40), isotropic_lamp({0.6, 0.3, 0.1}, 30)};
        desc_.lamps[1].name = "second";
        desc_.render.integrator = RenderDesc::Integrator::path;
        desc_.render.samples = 8;
    }

    Film render(const RenderOptions& options = {.layers = "all"}) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc_));
        plan_ = layer_plan(renderer.scene(), options.layers, options.paths);
        Film film = renderer.render(options);
        report_ = renderer.report();
        return film;
    }
    double at(const Film& film, Layer layer, int x, int y, std::size_t band) const {
        const auto channel = static_cast<std::size_t>(plan_->first_channel(layer)) + band;
        return static_cast<double>(film.pixel(x, y)[channel]);
    }
    /// Over the pixels and bands.
    double mean(const Film& film, Layer layer) const {
        double sum = 0;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                for (std::size_t b = 0; b < 3; ++b) sum += at(film, layer, x, y, b);
        return sum / (3 * film.width() * film.height());
    }

    SceneDesc desc_;
    std::optional<LayerPlan> plan_;
    RenderReport report_;
};

TEST_F(PathFilms, DependNeitherOnThreadsNorOnTheWindow) {
    const RenderOptions all{.layers = "all", .paths = {.orders = 2}};
    const Film film = expect_same_for_threads_and_windows(desc_, all, {3, 2, 10, 7});
    EXPECT_GT(expect_components_add_up(film), 0);
}

TEST_F(PathFilms, AddUpToTheBitAndByLampAndByOrder) {
    for (const std::optional<double> error : {std::optional<double>(), std::optional(0.2)}) {
        const Film film = render({.layers = "all", .paths = {.error = error, .orders = 2}});
        for (int y = 0; y < film.height(); ++y) {
            for (int x = 0; x < film.width(); ++x) {
                std::vector<float> pixel(film.pixel(x, y).begin(), film.pixel(x, y).end());
                for (std::size_t b = 0; b < 3; ++b) {
                    const auto of = [&](Layer layer) { return plan_->channels(layer, pixel)[b]; };
                    const float multiple = of(Layer::multiple_volume) + of(Layer::multiple_surface);
                    EXPECT_EQ(of(Layer::multiple), multiple);
                    EXPECT_EQ(pixel[b], of(Layer::direct) + of(Layer::forward) +
                                            of(Layer::backscatter) + multiple);
                    float lamps = 0, orders = 0, reflections = 0;
                    for (const std::size_t lamp : {0U, 1U})
                        lamps += plan_->lamp_channels(lamp, pixel)[b];
                    for (std::size_t i = 0; i < plan_->order_count(); ++i) {
                        orders += plan_->order_channels(i, pixel)[b];
                        reflections += plan_->reflection_channels(i, pixel)[b];
                    }
                    const float rounding = 2e-6F * pixel[b];
                    EXPECT_NEAR(lamps, pixel[b], rounding);
                    EXPECT_NEAR(orders, pixel[b], rounding);
                    EXPECT_NEAR(reflections, pixel[b], rounding);
                    // What no water scatters is direct, or goes from surface to surface.
                    EXPECT_GE(plan_->order_channels(0, pixel)[b], of(Layer::direct) - rounding);
                }
            }
        }
        EXPECT_GT(mean(film, Layer::multiple_volume), 0);
        EXPECT_GT(mean(film, Layer::multiple_surface), 0);
    }
}

TEST_F(PathFilms, HoldTheSingleScatteringOfOtherIntegrators) {
    desc_.render.samples = 512;
    desc_.render.planes.count = 3;
    const Film paths = render();
    const double direct = mean(paths, Layer::direct);
    const double backscatter = mean(paths, Layer::backscatter);
    const double first = mean(paths, Layer::backscatter_first);
    const double depth = mean(paths, Layer::depth);
    desc_.render.integrator = RenderDesc::Integrator::volume;
    const Film volume = render();
    EXPECT_NEAR(direct / mean(volume, Layer::direct), 1, 0.01);
    EXPECT_NEAR(backscatter / mean(volume, Layer::backscatter), 1, 0.01);
    // A path's point is in the first slab or not: 55 296 paths tell the fraction to 0.4 % if it is
    // a half; four times that.
    EXPECT_NEAR(first / mean(volume, Layer::backscatter_first), 1, 0.016);
    EXPECT_LT(first, 0.95 * backscatter);
    EXPECT_EQ(depth, mean(volume, Layer::depth));
}

TEST_F(PathFilms, HaveAnErrorThatFallsWithThePaths) {
    desc_.render.samples = 64;
    const Film few = render();
    const double before = *report_.paths.error;
    EXPECT_EQ(report_.paths.samples, 64);
    double squares = 0;
    for (int y = 0; y < few.height(); ++y)
        for (int x = 0; x < few.width(); ++x)
            for (std::size_t b = 0; b < 3; ++b)
                squares += std::pow(at(few, Layer::error, x, y, b), 2);
    const double values = 3.0 * few.width() * few.height();
    const double light =
        mean(few, Layer::direct) + mean(few, Layer::backscatter) + mean(few, Layer::multiple);
    EXPECT_NEAR(std::sqrt(squares / values) / light / before, 1, 1e-5);
    desc_.render.samples = 1024;
    render();
    // As 1 / sqrt(paths), or better where they cover their dimensions evenly.
    EXPECT_GT(before / *report_.paths.error, 2.8);
    EXPECT_LT(before / *report_.paths.error, 9);
}

TEST_F(PathFilms, GoOnUntilTheErrorIsSmall) {
    std::vector<PathAccuracy> rounds;
    double last = 0;
    std::mutex mutex;
    Renderer renderer([&](Stage stage, double fraction) {
        const std::lock_guard lock(mutex);
        if (stage == Stage::render) last = fraction;
        const PathAccuracy& now = renderer.report().paths;
        if (rounds.empty() || rounds.back().samples != now.samples) rounds.push_back(now);
    });
    renderer.set_scene(SceneDesc(desc_));
    renderer.render({.layers = "error", .paths = {.error = 0.05}});
    EXPECT_LE(*renderer.report().paths.error, 0.05);
    EXPECT_GT(*renderer.report().paths.error, 0.025);  // and no longer
    EXPECT_TRUE(renderer.report().warnings.empty());
    EXPECT_EQ(renderer.report().camera_rays,
              108U * static_cast<unsigned>(renderer.report().paths.samples));
    EXPECT_EQ(last, 1);
    EXPECT_GT(rounds.size(), 2U);
}

TEST_F(PathFilms, SpendPathsWhereTheErrorIs) {
    desc_.camera.width = 24;
    desc_.camera.height = 18;
    const RenderOptions by_error{.layers = "error", .paths = {.error = 0.03}};
    const Film film = render(by_error);
    const PathAccuracy reached = report_.paths;
    {
        const ThreadLimit one(1);
        EXPECT_TRUE(std::ranges::equal(render(by_error).values(), film.values()));
    }
    desc_.render.samples = reached.samples;
    const Film even = render({.layers = "error"});
    EXPECT_LT(*reached.error, *report_.paths.error);
    // Both have the same mean: four times what is stated of their difference.
    double sum = 0, difference = 0, variance = 0;
    for (int y = 0; y < film.height(); ++y) {
        for (int x = 0; x < film.width(); ++x) {
            for (std::size_t b = 0; b < 3; ++b) {
                const auto of = [&](const Film& each) {
                    return static_cast<double>(each.pixel(x, y)[b]);
                };
                sum += of(even);
                difference += of(film) - of(even);
            }
            // Bands share their paths.
            double deviation = 0, deviation_even = 0;
            for (std::size_t b = 0; b < 3; ++b) {
                deviation += at(film, Layer::error, x, y, b);
                deviation_even += at(even, Layer::error, x, y, b);
            }
            variance += deviation * deviation + deviation_even * deviation_even;
        }
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(std::abs(difference), 4 * std::sqrt(variance));
}

TEST_F(PathFilms, SayWhatTheyReachedIfTheErrorIsTooSmall) {
    render({.window = PixelWindow{2, 3, 3, 4}, .paths = {.error = 1e-6}});
    EXPECT_EQ(report_.paths.samples, 65536);
    ASSERT_EQ(report_.warnings.size(), 1U);
    EXPECT_TRUE(report_.warnings[0].starts_with("--error 1e-06: 65536 samples per pixel, the most"))
        << report_.warnings[0];
}

TEST_F(PathFilms, CanBeStopped) {
    std::atomic<bool> stop = false;
    const StopScope scope(stop);
    Renderer renderer([&](Stage stage, double fraction) {
        if (stage == Stage::render && fraction > 0) stop = true;
    });
    desc_.render.samples = 4096;
    renderer.set_scene(SceneDesc(desc_));
    EXPECT_THROW(renderer.render(), Interrupted);
}

TEST_F(PathFilms, TellOfTheirProgressEvery64Paths) {
    int reports = 0;
    std::mutex mutex;
    Renderer renderer([&](Stage stage, double) {
        const std::lock_guard lock(mutex);
        reports += stage == Stage::render ? 1 : 0;
    });
    desc_.render.samples = 32;
    renderer.set_scene(SceneDesc(desc_));
    renderer.render();
    EXPECT_GE(reports, 12 * 9 * 32 / 64);
}

TEST_F(PathFilms, OfOnePathHaveNoError) {
    desc_.render.samples = 1;
    render();
    EXPECT_FALSE(plan_->has(Layer::error));
    EXPECT_FALSE(report_.paths.error);
    EXPECT_THROW(render({.layers = "error"}), UsageError);
}

TEST_F(PathFilms, OfOtherIntegratorsAreRefused) {
    desc_.render.integrator = RenderDesc::Integrator::reference;
    EXPECT_THROW(render({.paths = {.error = 0.1}}), UsageError);
    EXPECT_THROW(render({.paths = {.orders = 2}}), UsageError);
}

// The spread of a round's batches, against that of many rounds.
TEST_F(PathFilms, StateTheErrorThatTheyHave) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    const LightTransport transport = renderer.make_transport();
    const PixelRenderer rest =
        pixel_renderer(renderer.assembled(), transport, {.lamps = false, .first_slab = false});
    const PathPixels pixels(rest, 0);
    constexpr int k_rounds = 400;
    constexpr std::array<std::pair<int, int>, 3> k_places{{{2, 3}, {6, 4}, {9, 7}}};
    double deviations = 0, stated = 0;
    for (const auto& [x, y] : k_places) {
        double sum = 0, squares = 0, errors = 0;
        PixelResult result;
        for (int number = 0; number < k_rounds; ++number) {
            pixels.render(
                x, y, {number, 40}, [](int) {}, result);
            const double total = result.direct[1] + result.backscatter[1] +
                                 result.multiple_volume[1] + result.multiple_surface[1];
            sum += total;
            squares += total * total;
            errors += result.error[1] * result.error[1];
        }
        const double mean = sum / k_rounds;
        deviations += (squares / k_rounds - mean * mean) / (mean * mean);
        stated += errors / k_rounds / (mean * mean);
    }
    EXPECT_NEAR(stated / deviations, 1, 0.25);
}

TEST(PathRounds, FollowFromTheErrorSoFar) {
    EXPECT_EQ(samples_of_next_round({.samples = 100}, {}), 100);
    EXPECT_EQ(samples_of_next_round({.samples = 100}, {100, 0.5}), 0);
    const PathGoal goal{.error = 0.01};
    EXPECT_EQ(samples_of_next_round(goal, {}), 16);
    EXPECT_EQ(samples_of_next_round(goal, {16, 0.009}), 0);
    EXPECT_EQ(samples_of_next_round(goal, {16, 0.0101}), 16);
    EXPECT_EQ(samples_of_next_round(goal, {16, 1.0}), 32);  // no more than twice as many
    EXPECT_EQ(samples_of_next_round(goal, {1024, 0.012}), 512);
    EXPECT_EQ(samples_of_next_round(goal, {1024, 0.0101}), 128);
    EXPECT_EQ(samples_of_next_round(goal, {65536 - 16, 0.5}), 16);
    EXPECT_EQ(samples_of_next_round(goal, {65536, 0.5}), 0);
}

}  // namespace
}  // namespace uw::test
