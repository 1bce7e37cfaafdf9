#include "core/frame/path_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/grid2d.h"
#include "core/base/parallel.h"
#include "core/scene/render_desc.h"

namespace uw {

namespace {

// Pixels that one task renders, in a row.
constexpr int k_run = 8;
// Paths between two reports of progress, at which an image can be stopped: milliseconds of work.
constexpr std::uint64_t k_report = 64;
// The error of so many paths is no more than a guess: more of them than it says are traced.
constexpr double k_margin = 1.05;
// Paths per pixel that an image is taken to need before anything is known of it.
constexpr int k_guess = 64;

// Rounds are at least this fraction of the paths before them.
constexpr double k_least_growth = 0.125;

constexpr int k_batches = PathRound::k_batches;

// Paths per pixel that will reach the error, all in all.
double samples_needed(double error, const PathAccuracy& so_far) {
    const double ratio = so_far.error.value_or(0.0) / error;
    return k_margin * so_far.samples * ratio * ratio;
}

/// What is known of the total of every pixel: the variance of its estimate, by band, and its mean
/// over the bands.
class Spread {
  public:
    Spread(const PixelWindow& window, std::size_t bands) : window_(window), bands_(bands) {
        const double bytes =
            4.0 * static_cast<double>(bands_ + 1) * window.width() * window.height();
        require_memory(bytes,
                       fmt::format("camera.resolution: the standard error of {} x {} pixels needs",
                                   window.width(), window.height()),
                       "render it in parts, with --crop, or make it smaller, with --size");
        values_.assign(window.width() * static_cast<int>(bands_ + 1), window.height());
    }

    /// Includes a pixel's further paths, with their share of all.
    void merge(int x, int y, const PixelResult& result, double share) {
        const std::span<float> own = pixel(x, y);
        double light = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double before = (1 - share) * (1 - share) * static_cast<double>(own[b]);
            const double more = share * result.error[b];
            own[b] = static_cast<float>(before + more * more);
            light += result.direct[b] + result.backscatter[b] + result.multiple_volume[b] +
                     result.multiple_surface[b];
        }
        const double mean = result.pixel_factor * light / static_cast<double>(bands_);
        own[bands_] =
            static_cast<float>((1 - share) * static_cast<double>(own[bands_]) + share * mean);
    }

    /// Of the whole image, relative to its mean.
    double error() const {
        double variance = 0, mean = 0;
        for (int y = window_.y0; y < window_.y1; ++y) {
            for (int x = window_.x0; x < window_.x1; ++x) {
                const std::span<const float> own = pixel(x, y);
                for (std::size_t b = 0; b < bands_; ++b) variance += static_cast<double>(own[b]);
                mean += static_cast<double>(own[bands_]);
            }
        }
        if (variance == 0) return 0;
        const double pixels = static_cast<double>(window_.width()) * window_.height();
        return std::sqrt(variance / (pixels * static_cast<double>(bands_))) / (mean / pixels);
    }

    /// The standard error of a pixel, by band.
    void store_error(int x, int y, std::span<float> channels) const {
        const std::span<const float> own = pixel(x, y);
        for (std::size_t b = 0; b < bands_; ++b)
            channels[b] = static_cast<float>(std::sqrt(static_cast<double>(own[b])));
    }

  private:
    std::size_t first(int x) const {
        return static_cast<std::size_t>(x - window_.x0) * (bands_ + 1);
    }
    std::span<float> pixel(int x, int y) {
        return values_.row(y - window_.y0).subspan(first(x), bands_ + 1);
    }
    std::span<const float> pixel(int x, int y) const {
        return values_.row(y - window_.y0).subspan(first(x), bands_ + 1);
    }

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<float> values_;
};

/// Tells how far an image has got, whose number of paths may not be known yet.
class RoundProgress {
  public:
    RoundProgress(const ProgressCallback& progress, const PixelWindow& window)
        : progress_(progress), pixels_(static_cast<double>(window.width()) * window.height()) {}

    void begin_round(double samples_in_all) { all_ = pixels_ * samples_in_all; }

    /// From any thread.
    void add(int paths) {
        const auto more = static_cast<std::uint64_t>(paths);
        const std::uint64_t before = done_.fetch_add(more);
        if (before / k_report == (before + more) / k_report) return;
        // The rest may take longer than foreseen.
        constexpr double k_almost = 0.99;
        if (!progress_(std::min(k_almost, static_cast<double>(before + more) / all_)))
            throw Interrupted();
    }

  private:
    const ProgressCallback& progress_;
    double pixels_;
    double all_ = 1;  // paths
    std::atomic<std::uint64_t> done_ = 0;
};

}  // namespace

int samples_of_next_round(const PathGoal& goal, const PathAccuracy& so_far) {
    if (!goal.error) return so_far.samples == 0 ? goal.samples : 0;
    if (so_far.samples == 0) return k_batches;
    const int possible = k_most_paths - so_far.samples;
    if (possible <= 0 || so_far.error.value_or(0.0) <= *goal.error) return 0;
    // Batches of 2^k paths cover their dimensions best. The next round may correct a round too few.
    const double missing = samples_needed(*goal.error, so_far) - so_far.samples;
    const double most = std::min({missing, 2.0 * so_far.samples, static_cast<double>(possible)});
    const double wanted = std::max(most, k_least_growth * so_far.samples);
    int samples = k_batches;
    while (2 * samples <= wanted) samples *= 2;
    return std::min(samples, possible);
}

PathAccuracy render_path_film(const PixelRenderer& renderer, const PathGoal& goal,
                              const LayerPlan& plan, const BandColour& colour, Film& film,
                              const ProgressCallback& progress, const AccuracyCallback& reached) {
    const PathPixels pixels(renderer, plan.order_count());
    const PixelWindow& window = film.window();
    Spread spread(window, plan.band_count());
    RoundProgress so_far(progress, window);
    const int runs = (window.width() + k_run - 1) / k_run;  // in a row
    const auto tasks = static_cast<std::size_t>(runs) * static_cast<std::size_t>(window.height());
    PathAccuracy accuracy;
    PathRound round;
    for (; (round.samples = samples_of_next_round(goal, accuracy)) > 0; ++round.number) {
        const int samples = accuracy.samples + round.samples;
        const double share = static_cast<double>(round.samples) / samples;
        double in_all = samples;
        if (goal.error)
            in_all = std::clamp(round.number == 0 ? k_guess : samples_needed(*goal.error, accuracy),
                                in_all, static_cast<double>(k_most_paths));
        so_far.begin_round(in_all);
        parallel_for(tasks, [&](std::size_t task) {
            thread_local PixelResult result;
            const int y = window.y0 + static_cast<int>(task) / runs;
            const int begin = window.x0 + static_cast<int>(task) % runs * k_run;
            for (int x = begin; x < std::min(begin + k_run, window.x1); ++x) {
                pixels.render(
                    x, y, round, [&](int paths) { so_far.add(paths); }, result);
                if (round.number == 0)
                    store_pixel(result, plan, colour, film.pixel(x, y));
                else
                    merge_paths(result, share, plan, colour, film.pixel(x, y));
                spread.merge(x, y, result, share);
            }
        });
        accuracy.samples = samples;
        if (samples > 1) accuracy.error = spread.error();
        if (reached) reached(accuracy);
    }
    if (plan.has(Layer::error))
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                spread.store_error(x, y, plan.channels(Layer::error, film.pixel(x, y)));
    if (!progress(1)) throw Interrupted();
    return accuracy;
}

}  // namespace uw
