#include "render/derivatives/derivative_images.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdint>

#include "core/base/available_memory.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/passes/path_pass.h"
#include "core/passes/pixel_terms.h"

namespace uw {

namespace {

/// Sums the contributions to a pixel, each times its scores, the derivatives of its logarithm.
class ScoreSum final : public ContributionSink {
  public:
    explicit ScoreSum(const ChangedScenes& scenes)
        : bands_(scenes.bands()),
          scores_(scenes),
          score_(scenes.changes() * scenes.bands()),
          sums_(score_.size()) {}

    void begin() {
        scores_.begin();
        sums_.assign(sums_.size(), 0.0);
    }
    int add_vertex(int before, const PathVertex& vertex) override {
        // A new path begins; those before it need not be kept.
        if (before == k_no_vertex) scores_.begin();
        return scores_.add_vertex(before, vertex);
    }
    void add(const PathContribution& contribution) override {
        scores_.find(contribution, {}, score_);
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] += contribution.radiance[i % bands_] * score_[i];
    }
    const std::vector<double>& sums() const { return sums_; }

  private:
    std::size_t bands_;
    PathScores scores_;
    std::vector<double> score_, sums_;
};

/// Calls `render(x, y, sum)`, which returns the factor of the pixel's light, for each pixel, and
/// stores the sums.
template <class Render>
std::vector<float> images_of(const ChangedScenes& scenes, const PixelWindow& window,
                             const ProgressCallback& progress, const Render& render) {
    const auto width = static_cast<std::size_t>(window.width());
    const auto height = static_cast<std::size_t>(window.height());
    const std::size_t bands = scenes.bands(), pixels = width * height;
    require_memory(4.0 * static_cast<double>(scenes.changes() * pixels * bands),
                   fmt::format("the derivatives of {} x {} pixels by {} numbers need", width,
                               height, scenes.changes()),
                   "take fewer numbers at once, or a part of the image");
    std::vector<float> images(scenes.changes() * pixels * bands);
    constexpr std::size_t k_run = 8;  // adjacent pixels that one task renders
    const std::size_t runs = (width + k_run - 1) / k_run;
    std::atomic<std::size_t> done = 0;
    parallel_for(runs * height, [&](std::size_t task) {
        ScoreSum sum(scenes);
        const std::size_t row = task / runs, first = task % runs * k_run;
        for (std::size_t column = first; column < std::min(first + k_run, width); ++column) {
            sum.begin();
            const double factor = render(window.x0 + static_cast<int>(column),
                                         window.y0 + static_cast<int>(row), sum);
            for (std::size_t i = 0; i < scenes.changes(); ++i)
                for (std::size_t b = 0; b < bands; ++b)
                    images[((i * height + row) * width + column) * bands + b] =
                        static_cast<float>(factor * sum.sums()[i * bands + b]);
        }
        progress(static_cast<double>(++done) / static_cast<double>(runs * height));
    });
    return images;
}

PathRound round_of(const Draws& draws) {
    return {draws.seed, draws.samples};
}

}  // namespace

std::vector<float> quadrature_derivatives(const PixelRenderer& pixels,
                                          const VolumeIntegrator& water,
                                          const ChangedScenes& scenes, const PixelWindow& window,
                                          const ProgressCallback& progress) {
    return images_of(scenes, window, progress, [&](int x, int y, ScoreSum& sum) {
        PixelView view;
        SurfaceLight light;
        pixels.trace(x, y, view);
        pixels.light_surfaces(std::span(&view, 1), light);
        add_quadrature_terms(pixels, water, view, light, sum);
        return pixels.pixel_factor(view);
    });
}

std::vector<float> path_derivatives(const PixelRenderer& pixels, const ChangedScenes& scenes,
                                    const PixelWindow& window, const Draws& draws,
                                    const ProgressCallback& progress) {
    PathPixels paths(pixels, 0);
    paths.allocate_paths(draws.samples);
    return images_of(scenes, window, progress, [&](int x, int y, ScoreSum& sum) {
        PixelResult result;
        paths.render(
            x, y, round_of(draws), [](int) {}, result, &sum);
        return result.pixel_factor / draws.samples;
    });
}

namespace {

/// Hands each contribution to a pixel to the gradients of its part, with the derivative of the
/// scalar with respect to the contribution's logarithm, the `weighted` radiance.
class GradientSink final : public ContributionSink {
  public:
    GradientSink(const PartGradients& gradients, std::size_t bands)
        : gradients_(gradients), factors_(bands), weighted_(bands) {}

    /// Uses only a few of the many contributions on a ray of this pixel, without bias: they are
    /// selected by systematic resampling, with probabilities in proportion to the size of their
    /// weighted radiance.
    void thin(int x, int y, int seed) {
        const auto pixel = (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x);
        random_.emplace(PathRandom::seed_of(pixel, static_cast<std::uint64_t>(seed), 0), 0);
    }
    /// Sets the derivative of the scalar with respect to the light of the following contributions,
    /// those of a pixel.
    void begin(std::span<const double> weights, double factor) {
        for (std::size_t b = 0; b < factors_.size(); ++b) factors_[b] = factor * weights[b];
    }
    void finish() {
        use_kept();
        for (const auto& gradient : gradients_) gradient->finish();
    }
    int add_vertex(int before, const PathVertex& vertex) override {
        if (before == k_no_vertex) use_kept();
        int number = k_no_vertex;
        for (const auto& gradient : gradients_) number = gradient->add_vertex(before, vertex);
        return number;
    }
    void add(const PathContribution& contribution) override {
        double size = 0;
        for (std::size_t b = 0; b < factors_.size(); ++b) {
            weighted_[b] = factors_[b] * contribution.radiance[b];
            size += std::abs(weighted_[b]);
        }
        if (random_)
            keep(contribution, size);
        else
            pass_on(contribution);
    }

  private:
    // The number of contributions selected on a ray; if there are no more than these, all are used.
    static constexpr std::size_t k_selected = 8;

    struct Kept {
        PathContribution contribution;
        double size;
        std::size_t columns, concentration;  // numbers of values
    };

    void pass_on(const PathContribution& contribution) {
        for (const auto& gradient : gradients_) gradient->add(contribution, weighted_);
    }

    // Copies what the contribution refers to: the ray's data are gone when it is used.
    void keep(const PathContribution& contribution, double size) {
        kept_.push_back(
            {contribution, size, contribution.columns.size(), contribution.concentration.size()});
        kept_.back().contribution.radiance = {};
        for (const std::span<const double> values :
             {std::span<const double>(weighted_), contribution.columns, contribution.concentration})
            values_.insert(values_.end(), values.begin(), values.end());
        total_ += size;
    }

    void use_kept() {
        const bool is_few = kept_.size() <= k_selected;
        const double step = total_ / static_cast<double>(k_selected);
        double next = is_few || kept_.empty() ? 0 : random_->next() * step, before = 0;
        std::span<const double> values = values_;
        const auto take = [&](std::size_t count) {
            const std::span<const double> first = values.first(count);
            values = values.subspan(count);
            return first;
        };
        for (Kept& kept : kept_) {
            const std::span<const double> weighted = take(weighted_.size());
            kept.contribution.columns = take(kept.columns);
            kept.contribution.concentration = take(kept.concentration);
            before += kept.size;
            int times = 0;
            if (!is_few)
                for (; next < before; next += step) ++times;
            const double weight = is_few ? 1 : times * step / kept.size;
            if (!(weight > 0)) continue;
            for (std::size_t b = 0; b < weighted_.size(); ++b) weighted_[b] = weighted[b] * weight;
            pass_on(kept.contribution);
        }
        kept_.clear();
        values_.clear();
        total_ = 0;
    }

    const PartGradients& gradients_;
    std::vector<double> factors_, weighted_;
    std::optional<PathRandom> random_;  // none: all contributions are used
    std::vector<Kept> kept_;
    // The weighted radiance, columns and concentrations of each kept contribution.
    std::vector<double> values_;
    double total_ = 0;
};

/// Calls `render(x, y, sink)` for each pixel. Each part takes every parts.size()th row.
template <class Render>
void gather(const PixelWeights& weights, std::span<const PartGradients> parts,
            const ProgressCallback& progress, const Render& render) {
    const PixelWindow& window = weights.window;
    std::atomic<int> done = 0;
    parallel_for(parts.size(), [&](std::size_t part) {
        GradientSink sink(parts[part], weights.bands);
        for (int y = window.y0 + static_cast<int>(part); y < window.y1;
             y += static_cast<int>(parts.size())) {
            for (int x = window.x0; x < window.x1; ++x) render(x, y, sink);
            progress(static_cast<double>(++done) / window.height());
        }
    });
}

}  // namespace

void quadrature_gradient(const PixelRenderer& pixels, const VolumeIntegrator& water,
                         const PixelWeights& weights, const std::optional<Draws>& draws,
                         std::span<const PartGradients> parts, const ProgressCallback& progress) {
    gather(weights, parts, progress, [&](int x, int y, GradientSink& sink) {
        PixelView view;
        SurfaceLight light;
        pixels.trace(x, y, view);
        pixels.light_surfaces(std::span(&view, 1), light);
        if (draws) sink.thin(x, y, draws->seed);
        sink.begin(weights.at(x, y), pixels.pixel_factor(view));
        add_quadrature_terms(pixels, water, view, light, sink);
        sink.finish();
    });
}

void path_gradient(const PixelRenderer& pixels, const PixelWeights& weights, const Draws& draws,
                   std::span<const PartGradients> parts, const ProgressCallback& progress) {
    PathPixels paths(pixels, 0);
    paths.allocate_paths(draws.samples);
    gather(weights, parts, progress, [&](int x, int y, GradientSink& sink) {
        PixelResult result;
        PixelView view;
        pixels.trace(x, y, view);
        sink.begin(weights.at(x, y), pixels.pixel_factor(view) / draws.samples);
        paths.render(
            x, y, round_of(draws), [](int) {}, result, &sink);
        sink.finish();
    });
}

}  // namespace uw
