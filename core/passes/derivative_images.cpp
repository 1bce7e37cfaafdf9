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
class ScoreSum final : public PathTerms {
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
    int turn(int before, const PathTurn& turn) override {
        // A pixel's many paths need not be kept.
        if (before == k_no_turn) scores_.begin();
        return scores_.turn(before, turn);
    }
    void add(const PathTerm& term) override {
        scores_.find(term, score_);
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
                             const ShareCallback& progress, const Render& render) {
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
                                          const ShareCallback& progress) {
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
                                    const ShareCallback& progress) {
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

/// Hands the worth of each term of a pixel back to the field.
class WorthOfTerms final : public PathTerms {
  public:
    WorthOfTerms(const GradientTables& tables, FieldGradient& gradient, std::size_t bands)
        : gradient_(tables, gradient), factors_(bands), worth_(bands) {}

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
        gradient_.finish();
    }
    int turn(int before, const PathTurn& turn) override {
        if (before == k_no_turn) take_kept();
        return gradient_.turn(before, turn);
    }
    void add(const PathTerm& term) override {
        double size = 0;
        for (std::size_t b = 0; b < factors_.size(); ++b) {
            worth_[b] = factors_[b] * term.radiance[b];
            size += std::abs(worth_[b]);
        }
        if (!random_) {
            gradient_.add(term, worth_);
            return;
        }
        // What the term refers to of the ray is not there any more when it is taken.
        PathTerm kept = term;
        kept.radiance = kept.columns = kept.concentration = {};
        kept_.push_back({kept, size});
        kept_worth_.insert(kept_worth_.end(), worth_.begin(), worth_.end());
        total_ += size;
    }

  private:
    struct Kept {
        PathTerm term;
        double size;
    };

    void take_kept() {
        constexpr double k_of_ray = 8;
        const double step = total_ / k_of_ray;
        double next = kept_.empty() ? 0 : random_->next() * step, before = 0;
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            before += kept_[i].size;
            int times = 0;
            for (; next < before; next += step) ++times;
            if (times == 0) continue;
            for (std::size_t b = 0; b < worth_.size(); ++b)
                worth_[b] = kept_worth_[i * worth_.size() + b] * (times * step / kept_[i].size);
            gradient_.add(kept_[i].term, worth_);
        }
        kept_.clear();
        kept_worth_.clear();
        total_ = 0;
    }

    PathGradient gradient_;
    std::vector<double> factors_, worth_;
    std::optional<PathRandom> random_;  // none: all terms are taken
    std::vector<Kept> kept_;
    std::vector<double> kept_worth_;  // [kept * bands + band]
    double total_ = 0;
};

/// Calls `render(x, y, terms)` for each pixel, row by row, in as many parts as there are gradients.
template <class Render>
void gather(const LitScene& scene, const PixelWeights& weights, FieldGradients gradients,
            const ShareCallback& progress, const Render& render) {
    const GradientTables tables(scene);
    const PixelWindow& window = weights.window;
    std::atomic<int> done = 0;
    parallel_for(gradients.size(), [&](std::size_t part) {
        WorthOfTerms terms(tables, *gradients[part], weights.bands);
        for (int y = window.y0 + static_cast<int>(part); y < window.y1;
             y += static_cast<int>(gradients.size())) {
            for (int x = window.x0; x < window.x1; ++x) render(x, y, terms);
            progress(static_cast<double>(++done) / window.height());
        }
    });
}

}  // namespace

void quadrature_gradient(const PixelRenderer& pixels, const VolumeIntegrator& water,
                         const PixelWeights& weights, const std::optional<Draws>& draws,
                         FieldGradients gradients, const ShareCallback& progress) {
    gather(pixels.scene(), weights, gradients, progress, [&](int x, int y, WorthOfTerms& terms) {
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
                   FieldGradients gradients, const ShareCallback& progress) {
    PathPixels paths(pixels, 0);
    paths.share_out(draws.samples);
    gather(pixels.scene(), weights, gradients, progress, [&](int x, int y, WorthOfTerms& terms) {
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
