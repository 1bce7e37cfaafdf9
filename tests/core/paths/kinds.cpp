// ctest labels: analytic statistical
// Whether contributions state their kind correctly.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/support/paths/lit_box.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {
namespace {

/// Checks what each contribution states of its kind.
class KindCheck final : public ContributionSink {
  public:
    enum class Source { single, water, surface };
    KindCheck(Source source, double distance) : source_(source), distance_(distance) {}
    void add(const PathContribution& contribution) override {
        ++count;
        EXPECT_EQ(contribution.lamp, 0);
        EXPECT_EQ(contribution.from_water, source_ != Source::surface);
        if (source_ == Source::single) {
            EXPECT_EQ(contribution.scatterings, 1);
            EXPECT_EQ(contribution.reflections, 0);
        } else {
            EXPECT_GE(contribution.scatterings + contribution.reflections, 2);
            EXPECT_GE(
                source_ == Source::water ? contribution.scatterings : contribution.reflections, 1);
        }
        if (source_ == Source::surface)
            EXPECT_DOUBLE_EQ(contribution.distance, distance_);
        else
            EXPECT_LT(contribution.distance, distance_);
        EXPECT_GT(contribution.distance, 0);
        for (const double radiance : contribution.radiance) EXPECT_GE(radiance, 0);
    }
    int count = 0;

  private:
    Source source_;
    double distance_;
};

TEST(PathLaws, ContributionsAreOfTheKindThatTheyClaim) {
    const PathScene scene = lit_scene(k_three_bands);
    const PathTracer tracer(scene.lit());
    CameraSegment segment;
    SurfaceHit hit;
    ASSERT_TRUE(scene.surfaces->closest_hit(some_ray(), k_far, hit));
    tracer.begin(some_ray(), &hit, {}, segment);
    KindCheck single(KindCheck::Source::single, hit.distance),
        water(KindCheck::Source::water, hit.distance),
        surface(KindCheck::Source::surface, hit.distance);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        PathRandom random(PathRandom::seed_of(1), i);
        tracer.trace_single(segment, random, single);
        trace_scattered(tracer, segment, random, water);
        tracer.trace_surface(segment, random, surface);
    }
    for (const KindCheck* check : {&single, &water, &surface}) EXPECT_GT(check->count, 100);
}

/// Passes on mirrored contributions, times a factor for each band.
class MirroredPart final : public ContributionSink {
  public:
    MirroredPart(ContributionSink& sums, std::span<const double> factors)
        : sums_(sums), factors_(factors) {}
    void add(const PathContribution& contribution) override {
        if (!PathTracer::is_mirrored(contribution)) {
            ++others;
            return;
        }
        PathContribution scaled = contribution;
        radiance_.assign(contribution.radiance.begin(), contribution.radiance.end());
        for (std::size_t b = 0; b < radiance_.size(); ++b) radiance_[b] *= factors_[b];
        scaled.radiance = radiance_;
        sums_.add(scaled);
    }
    int others = 0;

  private:
    ContributionSink& sums_;
    std::span<const double> factors_;
    std::vector<double> radiance_;
};

// The mirrored light is estimated with random numbers of its own, and the transmittance of the
// water in front of the surface is applied afterwards.
TEST(PathLaws, MirroredLightIsPartOfTheSurfacesLight) {
    const PathScene scene = lit_scene(k_three_bands);
    const PathTracer tracer(scene.lit());
    SurfaceSample sample{some_ray(), {}, 0, 0};
    ASSERT_TRUE(scene.surfaces->closest_hit(sample.ray, k_far, sample.hit));
    CameraSegment segment;
    tracer.begin(sample.ray, &sample.hit, {}, segment);
    constexpr std::uint32_t k_paths = 1 << 11;
    const std::vector<double> ones(3, 1.0);
    std::atomic<int> others = 0;
    const auto parts = run_batches(32, 3, 1, [&](std::uint64_t seed, TermSums& sums) {
        MirroredPart part(sums, ones);
        CameraSegment of_batch = segment;
        for (std::uint32_t i = 0; i < k_paths; ++i) {
            PathRandom random(seed, i);
            tracer.trace_surface(of_batch, random, part);
        }
        others += part.others;
    });
    const auto mirrored = run_batches(32, 3, 2, [&](std::uint64_t seed, TermSums& sums) {
        MirroredPart part(sums, segment.transmittance.first(3));
        PathScratch scratch;
        for (std::uint32_t i = 0; i < k_paths; ++i) {
            PathRandom random(seed, i);
            tracer.trace_mirrored(sample, random, part, scratch);
        }
        EXPECT_EQ(part.others, 0);
    });
    EXPECT_GT(others, 0);
    Deviations deviations;
    for (std::size_t b = 0; b < 3; ++b) {
        const auto all = [&](const TermSums& sums) {
            return sums.sum(b, [](int, int, bool) { return true; });
        };
        const BatchMeans part = means_of(parts, all), own = means_of(mirrored, all);
        deviations.add("mirrored", part, own.mean(), own.error());
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.02);
}

}  // namespace
}  // namespace uw::test
