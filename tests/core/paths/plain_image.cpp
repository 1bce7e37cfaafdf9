// ctest labels: statistical slow
// The image means of S1 by kind of light, against a textbook path tracer.
#include <gtest/gtest.h>

#include "tests/support/paths/s1_image.h"

namespace uw::test {
namespace {

TEST(PlainImage, MeansOfAllKindsOfLightAgree) {
    constexpr std::size_t k_batches = 128;
    constexpr int k_rays = 64'000, k_plain_rays = 96'000;
    const PathScene scene = s1_scene();
    const PathTracer tracer(scene.lit());
    std::vector<S1Batch> batches(k_batches);
    parallel_for(k_batches, [&](std::size_t n) {
        batches[n] = trace_s1(scene, tracer, PathRandom::seed_of(31, n), k_rays);
    });
    Deviations kinds, ratios;
    for (std::size_t band = 0; band < 3; ++band) {
        std::vector<PlainPaths::Kinds> plain(k_batches);
        parallel_for(k_batches, [&](std::size_t n) {
            plain[n] = trace_plain_s1(band, 1000 * band + n, k_plain_rays);
        });
        const std::string where = "band " + std::to_string(band);
        double once = 0;
        for (const S1Batch& batch : batches) once += batch.once(band) / k_batches;
        BatchMeans ratio, plain_ratio;
        for (const S1Batch& batch : batches)
            ratio.add((batch.total(band) - batch.once(band)) / once + 1);
        // Single scattering is known better from `batches`; sums without it have less variance.
        for (const PlainPaths::Kinds& batch : plain) {
            double more = 0;
            for (const LightKind& kind : LightKind::all())
                if (!kind.is_once()) more += plain_sum(batch, kind);
            plain_ratio.add(more / once + 1);
        }
        ratios.add(where + " ratio to single scattering", ratio, plain_ratio.mean(),
                   plain_ratio.error());
        for (const LightKind& kind : LightKind::all()) {
            BatchMeans traced, truth;
            for (const S1Batch& batch : batches)
                traced.add(batch.sums.sum(
                    band, [&](int s, int r, bool water) { return kind.matches(s, r, water); }));
            for (const PlainPaths::Kinds& batch : plain) truth.add(plain_sum(batch, kind));
            // Rare kinds are not normally distributed.
            if (!(truth.error() < 0.05 * truth.mean())) continue;
            kinds.add(where + " scatterings " + std::to_string(kind.scatterings) + " reflections " +
                          std::to_string(kind.reflections) + (kind.from_water ? " from water" : ""),
                      traced, truth.mean(), truth.error());
        }
    }
    kinds.expect_within_errors();
    ratios.expect_within_errors();
    ratios.expect_errors_below(0.005);
}

}  // namespace
}  // namespace uw::test
