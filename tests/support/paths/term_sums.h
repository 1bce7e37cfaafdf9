#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/spectrum.h"
#include "core/light/integrator.h"
#include "core/paths/path_tracer.h"
#include "tests/support/paths/batch_means.h"

namespace uw::test {

/// Adds up the terms of paths by their kind.
class TermSums final : public ContributionSink {
  public:
    /// The last of each stands for all beyond.
    static constexpr int k_scatterings = 8, k_reflections = 5;

    explicit TermSums(std::size_t bands)
        : bands_(bands), sums_(k_scatterings * k_reflections * 2 * bands) {}

    /// What each term counts from here on.
    void set_weight(double weight) { weight_ = weight; }

    void add(const PathContribution& term) override {
        const std::size_t row =
            row_of(std::min(term.scatterings, k_scatterings - 1),
                   std::min(term.reflections, k_reflections - 1), term.from_water);
        for (std::size_t b = 0; b < bands_; ++b)
            sums_[row * bands_ + b] += weight_ * term.radiance[b];
    }

    /// The sum of all terms of which `selects(scatterings, reflections, from_water)`.
    template <class Selects>
    double sum(std::size_t band, const Selects& selects) const {
        double total = 0;
        for (int s = 0; s < k_scatterings; ++s)
            for (int r = 0; r < k_reflections; ++r)
                for (const bool from_water : {false, true})
                    if (selects(s, r, from_water))
                        total += sums_[row_of(s, r, from_water) * bands_ + band];
        return total;
    }
    double total(std::size_t band) const {
        return sum(band, [](int, int, bool) { return true; });
    }
    /// The sum of light that was scattered `scatterings` times, whatever else happened to it.
    double order(std::size_t band, int scatterings) const {
        return sum(band, [&](int s, int, bool) { return s == scatterings; });
    }

  private:
    static std::size_t row_of(int scatterings, int reflections, bool from_water) {
        return static_cast<std::size_t>((scatterings * k_reflections + reflections) * 2 +
                                        (from_water ? 1 : 0));
    }

    std::size_t bands_;
    double weight_ = 1;
    std::vector<double> sums_;
};

/// One path of either kind that begins with a scattering; `tracer` gives the segment one of each.
inline void trace_scattered(const PathTracer& tracer, CameraSegment& segment, PathRandom& random,
                            ContributionSink& terms) {
    tracer.trace_water(segment, random, terms);
    tracer.trace_lit_surfaces(segment, random, terms);
}

/// All terms of `paths` paths of one camera ray, each counted `weight / paths` times.
inline void trace_ray(const PathTracer& tracer, const Surfaces& surfaces, const Ray& ray,
                      std::uint64_t seed, std::uint32_t paths, TermSums& sums, double weight = 1) {
    SurfaceHit hit;
    const bool has_hit = surfaces.closest_hit(ray, k_far, hit);
    CameraSegment segment;
    tracer.begin(ray, has_hit ? &hit : nullptr, {}, segment);
    sums.set_weight(weight / paths);
    // Seeds of their own, so that none of the three has random numbers in common with another.
    for (std::uint32_t i = 0; i < paths; ++i) {
        PathRandom single(PathRandom::seed_of(seed, 1), i), water(PathRandom::seed_of(seed, 2), i),
            surface(PathRandom::seed_of(seed, 3), i);
        tracer.trace_single(segment, single, sums);
        trace_scattered(tracer, segment, water, sums);
        tracer.trace_surface(segment, surface, sums);
    }
}

/// Independent batches, on all threads: `body(seed, sums)` makes one of them.
template <class Body>
std::vector<TermSums> run_batches(std::size_t count, std::size_t bands, std::uint64_t seed,
                                  const Body& body) {
    std::vector<TermSums> batches(count, TermSums(bands));
    parallel_for(count, [&](std::size_t n) { body(PathRandom::seed_of(seed, n), batches[n]); });
    return batches;
}

/// `value` of each batch.
template <class Value>
BatchMeans means_of(const std::vector<TermSums>& batches, const Value& value) {
    BatchMeans means;
    for (const TermSums& batch : batches) means.add(value(batch));
    return means;
}

}  // namespace uw::test
