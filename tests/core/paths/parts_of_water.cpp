// ctest labels: analytic statistical
// The two parts of the light of the water: that of lit surfaces, and that of the water alone.
#include <gtest/gtest.h>

#include "core/paths/irradiance_cache.h"
#include "tests/support/paths/closed_form_surfaces.h"
#include "tests/support/paths/lit_box.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {
namespace {

// Where the radiance is 1 everywhere, the light added along the segment to a surface replaces what
// is scattered out of the ray: 1 - e^-tau.
TEST(LitSurfaces, FillTheWaterOfAWhiteFurnace) {
    PathScene scene({{0, 0.3}, {0, 1.0}, {0, 2.0}}, 0.8);
    ClosedFormSurfaces::Material emissive{{0.5, 0.5, 0.2}, {}};
    emissive.more.emission = Spectrum{0.5, 0.5, 0.8};
    auto room = std::make_unique<ClosedFormSurfaces>();
    room->add_box({-1, -1.5, -1}, {1, 1, 2}, emissive);
    room->add_sphere({0.4, 0.3, 1}, 0.4, emissive);
    scene.surfaces = std::move(room);
    const PathTracer tracer(scene.lit());
    // The radiance that a white surface reflects.
    const IrradianceCache indirect({{{0, 0, 0}, {0, 0, 1}},
                                    {{0, 0, 0}, {0, 0, -1}},
                                    {{0, 0, 0}, {0, 1, 0}},
                                    {{0, 0, 0}, {0, -1, 0}},
                                    {{0, 0, 0}, {1, 0, 0}},
                                    {{0, 0, 0}, {-1, 0, 0}}},
                                   std::vector<float>(18, 1.0F), 3);
    Deviations deviations;
    for (const Vector3& direction : {Vector3(0.4, 0.3, 1), Vector3(-0.6, -0.6, 0.5)}) {
        const Ray ray{{0, 0, 0}, glm::normalize(direction)};
        SurfaceHit hit;
        ASSERT_TRUE(scene.surfaces->closest_hit(ray, k_far, hit));
        const auto batches = run_batches(32, 3, 5, [&](std::uint64_t seed, TermSums& sums) {
            CameraSegment segment;
            tracer.begin(ray, &hit, {}, segment);
            constexpr std::uint32_t k_paths = 1 << 10;
            sums.set_weight(1.0 / k_paths);
            for (std::uint32_t i = 0; i < k_paths; ++i) {
                PathRandom random(seed, i);
                tracer.trace_lit_surfaces(segment, indirect, random, sums);
            }
        });
        for (std::size_t b = 0; b < 3; ++b)
            deviations.add("band " + std::to_string(b),
                           means_of(batches, [&](const TermSums& sums) { return sums.total(b); }),
                           1 - std::exp(-scene.medium.uniform.attenuation(b) * hit.distance));
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.01);
}

// A small sphere far away in water that absorbs nothing: most paths never meet it, and all must
// end.
TEST(LitSurfaces, AreSoughtByPathsThatEnd) {
    PathScene scene({{0, 1}}, 0);
    auto thing = std::make_unique<ClosedFormSurfaces>();
    thing->add_sphere({0, 0, 30}, 0.1, {{0.5}, {.emission = {1}}});
    scene.surfaces = std::move(thing);
    const PathTracer tracer(scene.lit());
    const IrradianceCache indirect({}, {}, 1);
    CameraSegment segment;
    tracer.begin({{0, 0, 0}, {0, 0, -1}}, nullptr, {}, segment);
    TermSums sums(1);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        PathRandom random(1, i);
        tracer.trace_lit_surfaces(segment, indirect, random, sums);
    }
    // The radiance is at most that of the sphere, which each path may meet once.
    EXPECT_GE(sums.total(0), 0);
    EXPECT_LT(sums.total(0), 2000);
}

// The rest of the water's light has no reflection in its path.
TEST(WaterAlone, IsWhatNoSurfaceReflects) {
    const PathScene scene = lit_scene(k_three_bands);
    const PathTracer tracer(scene.lit());
    const Ray ray = some_ray();
    SurfaceHit hit;
    const bool has_hit = scene.surfaces->closest_hit(ray, k_far, hit);
    const auto batches_of = [&](std::uint64_t seed, auto trace) {
        return run_batches(32, scene.band_count(), seed,
                           [&](std::uint64_t batch_seed, TermSums& sums) {
                               CameraSegment segment;
                               tracer.begin(ray, has_hit ? &hit : nullptr, {}, segment);
                               constexpr std::uint32_t k_paths = 1 << 11;
                               sums.set_weight(1.0 / k_paths);
                               for (std::uint32_t i = 0; i < k_paths; ++i) {
                                   PathRandom random(batch_seed, i);
                                   trace(segment, random, sums);
                               }
                           });
    };
    const auto alone =
        batches_of(1, [&](CameraSegment& segment, PathRandom& random, TermSums& sums) {
            tracer.trace_water(segment, random, sums);
        });
    const auto all = batches_of(2, [&](CameraSegment& segment, PathRandom& random, TermSums& sums) {
        trace_scattered(tracer, segment, random, sums);
    });
    Deviations deviations;
    for (std::size_t b = 0; b < scene.band_count(); ++b) {
        const auto untouched = [&](const TermSums& sums) {
            return sums.sum(b, [](int, int reflections, bool) { return reflections == 0; });
        };
        deviations.add("band " + std::to_string(b), means_of(alone, untouched),
                       means_of(all, untouched).mean(), means_of(all, untouched).error());
        EXPECT_EQ(means_of(alone, untouched).mean(),
                  means_of(alone, [&](const TermSums& sums) { return sums.total(b); }).mean());
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.05);
}

}  // namespace
}  // namespace uw::test
