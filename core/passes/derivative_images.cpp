#include "core/passes/derivative_images.h"

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

/// Sums the terms of a pixel, each times its scores.
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
        // A pixel's many paths need not be kept.
        if (before == k_no_vertex) scores_.begin();
        return scores_.add_vertex(before, vertex);
    }
    void add(const PathContribution& term) override {
        scores_.find(term, {}, score_);
        for (std::size_t i = 0; i < sums_.size(); ++i)
            sums_[i] += term.radiance[i % bands_] * score_[i];
    }
    const std::vector<double>& sums() const { return sums_; }

  private:
    std::size_t bands_;
    PathScores scores_;
    std::vector<double> score_, sums_;
};

/// Calls `render(x, y, sum)` for each pixel, which returns its light's factor, and stores the sums.
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
    constexpr std::size_t k_run = 8;  // pixels that one task renders, in a row
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
        thread_local PixelView view;
        thread_local SurfaceLight light;
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
    paths.share_out(draws.samples);
    return images_of(scenes, window, progress, [&](int x, int y, ScoreSum& sum) {
        thread_local PixelResult result;
        paths.render(
            x, y, round_of(draws), [](int) {}, result, &sum);
        return result.pixel_factor / draws.samples;
    });
}

namespace {

/// Hands the worth of each term of a pixel to all that gather derivatives from it.
class WorthOfTerms final : public ContributionSink {
  public:
    WorthOfTerms(const PartGradients& gradients, std::size_t bands)
        : gradients_(gradients), factors_(bands), worth_(bands) {}

    /// Of the many terms on a ray of this pixel, a few stand for all, without bias: drawn evenly
    /// along the sum of what they are worth.
    void thin(int x, int y, int seed) {
        const auto pixel = (static_cast<std::uint64_t>(y) << 32) | static_cast<std::uint64_t>(x);
        random_.emplace(PathRandom::seed_of(pixel, static_cast<std::uint64_t>(seed), 0), 0);
    }
    /// The number's derivative by the light of the terms that follow, those of a pixel.
    void begin(std::span<const double> weights, double factor) {
        for (std::size_t b = 0; b < factors_.size(); ++b) factors_[b] = factor * weights[b];
    }
    void finish() {
        take_kept();
        for (const auto& gradient : gradients_) gradient->finish();
    }
    int add_vertex(int before, const PathVertex& vertex) override {
        if (before == k_no_vertex) take_kept();
        int number = k_no_vertex;
        for (const auto& gradient : gradients_) number = gradient->add_vertex(before, vertex);
        return number;
    }
    void add(const PathContribution& term) override {
        double size = 0;
        for (std::size_t b = 0; b < factors_.size(); ++b) {
            worth_[b] = factors_[b] * term.radiance[b];
            size += std::abs(worth_[b]);
        }
        if (random_)
            keep(term, size);
        else
            hand_on(term);
    }

  private:
    // Terms on a ray that stand for all; fewer are all taken.
    static constexpr std::size_t k_of_ray = 8;

    struct Kept {
        PathContribution term;
        double size;
        std::size_t columns, concentration;  // how many
    };

    void hand_on(const PathContribution& term) {
        for (const auto& gradient : gradients_) gradient->add(term, worth_);
    }

    // What the term refers to of the ray is not there any more when it is taken.
    void keep(const PathContribution& term, double size) {
        kept_.push_back({term, size, term.columns.size(), term.concentration.size()});
        kept_.back().term.radiance = {};
        for (const std::span<const double> values :
             {std::span<const double>(worth_), term.columns, term.concentration})
            values_.insert(values_.end(), values.begin(), values.end());
        total_ += size;
    }

    void take_kept() {
        const bool is_few = kept_.size() <= k_of_ray;
        const double step = total_ / static_cast<double>(k_of_ray);
        double next = is_few || kept_.empty() ? 0 : random_->next() * step, before = 0;
        std::span<const double> values = values_;
        const auto take = [&](std::size_t count) {
            const std::span<const double> first = values.first(count);
            values = values.subspan(count);
            return first;
        };
        for (Kept& kept : kept_) {
            const std::span<const double> worth = take(worth_.size());
            kept.term.columns = take(kept.columns);
            kept.term.concentration = take(kept.concentration);
            before += kept.size;
            int times = 0;
            if (!is_few)
                for (; next < before; next += step) ++times;
            const double stands_for = is_few ? 1 : times * step / kept.size;
            if (!(stands_for > 0)) continue;
            for (std::size_t b = 0; b < worth_.size(); ++b) worth_[b] = worth[b] * stands_for;
            hand_on(kept.term);
        }
        kept_.clear();
        values_.clear();
        total_ = 0;
    }

    const PartGradients& gradients_;
    std::vector<double> factors_, worth_;
    std::optional<PathRandom> random_;  // none: all terms are taken
    std::vector<Kept> kept_;
    std::vector<double> values_;  // of each kept term: its worth, columns and concentrations
    double total_ = 0;
};

/// Calls `render(x, y, terms)` for each pixel, row by row, in as many parts as there are.
template <class Render>
void gather(const PixelWeights& weights, std::span<const PartGradients> parts,
            const ProgressCallback& progress, const Render& render) {
    const PixelWindow& window = weights.window;
    std::atomic<int> done = 0;
    parallel_for(parts.size(), [&](std::size_t part) {
        WorthOfTerms terms(parts[part], weights.bands);
        for (int y = window.y0 + static_cast<int>(part); y < window.y1;
             y += static_cast<int>(parts.size())) {
            for (int x = window.x0; x < window.x1; ++x) render(x, y, terms);
            progress(static_cast<double>(++done) / window.height());
        }
    });
}

}  // namespace

void quadrature_gradient(const PixelRenderer& pixels, const VolumeIntegrator& water,
                         const PixelWeights& weights, const std::optional<Draws>& draws,
                         std::span<const PartGradients> parts, const ProgressCallback& progress) {
    gather(weights, parts, progress, [&](int x, int y, WorthOfTerms& terms) {
        thread_local PixelView view;
        thread_local SurfaceLight light;
        pixels.trace(x, y, view);
        pixels.light_surfaces(std::span(&view, 1), light);
        if (draws) terms.thin(x, y, draws->seed);
        terms.begin(weights.at(x, y), pixels.pixel_factor(view));
        add_quadrature_terms(pixels, water, view, light, terms);
        terms.finish();
    });
}

void path_gradient(const PixelRenderer& pixels, const PixelWeights& weights, const Draws& draws,
                   std::span<const PartGradients> parts, const ProgressCallback& progress) {
    PathPixels paths(pixels, 0);
    paths.share_out(draws.samples);
    gather(weights, parts, progress, [&](int x, int y, WorthOfTerms& terms) {
        thread_local PixelResult result;
        thread_local PixelView view;
        pixels.trace(x, y, view);
        terms.begin(weights.at(x, y), pixels.pixel_factor(view) / draws.samples);
        paths.render(
            x, y, round_of(draws), [](int) {}, result, &terms);
        terms.finish();
    });
}

}  // namespace uw
