// ctest labels: statistical slow
// Standard errors of means of light paths: whether they are what they state, and whether no single
// path upsets them.
#include <gtest/gtest.h>

#include "tests/support/paths/mean_fluence.h"
#include "tests/support/paths/path_tables.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/paths/s1_scene.h"

namespace uw::test {
namespace {

constexpr std::size_t k_seeds = 200, k_batches = 32;

/// Over many seeds, the deviation of a mean of k_batches batches from the truth in units of its own
/// stated error follows Student's t with k_batches - 1 degrees of freedom.
void expect_honest(const std::string& what, const std::vector<BatchMeans>& runs,
                   std::optional<double> exact) {
    double truth = 0;
    for (const BatchMeans& run : runs) truth += run.mean() / static_cast<double>(runs.size());
    const double degrees =
        exact ? static_cast<double>(runs.size()) : static_cast<double>(runs.size()) - 1;
    if (exact) truth = *exact;
    double square = 0, sum = 0;
    for (const BatchMeans& run : runs) {
        const double z = run.deviation(truth);
        square += z * z / degrees;
        sum += z / static_cast<double>(runs.size());
    }
    constexpr double k_nu = k_batches - 1;
    const double variance = k_nu / (k_nu - 2), kurtosis = 3 + 6 / (k_nu - 4);
    const double spread = variance * std::sqrt((kurtosis - 1) / static_cast<double>(runs.size()));
    std::cout << what << ": variance of the deviation " << square << ", expected " << variance
              << " +- " << spread << "; mean " << sum << "\n";
    // Three of its own standard errors; batches with a long tail make it somewhat larger.
    EXPECT_NEAR(square, variance, 3 * spread) << what;
    EXPECT_NEAR(sum, 0, exact ? 3 * std::sqrt(variance / static_cast<double>(runs.size())) : 0.2)
        << what;
}

TEST(PathErrors, AreStatedRightAgainstTheTable) {
    for (const TableRow& row : read_path_table("point_lamp_hg09_albedo08_radiance.csv", false)) {
        if (row.r != 1 || (row.psi_degrees != 2 && row.psi_degrees != 30)) continue;
        const PathScene scene = table_scene({0.8}, 0.9);
        const Ray ray = table_ray(row.r, row.psi_degrees * (std::numbers::pi / 180));
        std::vector<BatchMeans> runs;
        for (std::uint64_t seed = 0; seed < k_seeds; ++seed)
            runs.push_back(
                means_of(ray_batches(scene, ray, 1000 + seed, k_batches, 1 << 8),
                         [](const TermSums& sums) { return k_to_table * sums.total(0); }));
        expect_honest("psi " + std::to_string(row.psi_degrees), runs, row.total);
    }
}

TEST(PathErrors, AreStatedRightInTheImage) {
    const PathScene scene = s1_scene();
    struct Pixel {
        const char* what;
        double x, y;
    };
    for (const Pixel& pixel :
         {Pixel{"plane", 60.5, 200.5}, Pixel{"box", 215.5, 110.5},
          Pixel{"its silhouette", 179.5, 100.5}, Pixel{"lamp's side", 310, 60}}) {
        std::vector<std::vector<TermSums>> all;
        for (std::uint64_t seed = 0; seed < k_seeds; ++seed)
            all.push_back(
                ray_batches(scene, s1_ray(pixel.x, pixel.y), 1000 + seed, k_batches, 1 << 8));
        for (const std::size_t band : {0U, 2U}) {
            std::vector<BatchMeans> runs;
            for (const auto& batches : all)
                runs.push_back(
                    means_of(batches, [&](const TermSums& sums) { return sums.total(band); }));
            expect_honest(pixel.what + (" band " + std::to_string(band)), runs, std::nullopt);
        }
    }
}

/// Sums over random rays of S1.
struct ImageSums {
    std::array<double, 3> single{}, direct{}, more{};  // by band
    std::array<double, 3> largest{};                   // more, of one path
    // Of `more`: camera, particle, lit surface; surface lit by scattered light; other light from
    // the water; all else.
    std::array<double, 4> kinds{};  // of the last band
};

void add_kinds(const TermSums& sums, std::array<double, 4>& kinds) {
    constexpr std::size_t k_band = 2;
    const auto of = [&](const auto& selects) { return sums.sum(k_band, selects); };
    kinds[0] += of([](int s, int r, bool water) { return water && s == 1 && r == 1; });
    kinds[1] += of([](int s, int, bool water) { return !water && s > 0; });
    kinds[2] +=
        of([](int s, int r, bool water) { return water && s + r > 1 && !(s == 1 && r == 1); });
    kinds[3] += of([](int s, int r, bool water) { return !water && s == 0 && r > 1; });
}

ImageSums trace_image(const PathScene& scene, const PathTracer& tracer, std::uint64_t seed,
                      int rays) {
    ImageSums image;
    CameraSegment segment;
    for (int i = 0; i < rays; ++i) {
        const std::uint64_t ray_seed = PathRandom::seed_of(seed, static_cast<std::uint64_t>(i));
        PathRandom position(ray_seed, 0);
        const double x = 320 * position.next(), y = 240 * position.next();
        const Ray ray = s1_ray(x, y);
        SurfaceHit hit;
        if (!scene.surfaces->closest_hit(ray, k_far, hit)) continue;
        TermSums direct(3), single(3), more(3);
        add_direct_light(scene.lit(), ray, hit, 1, direct);
        std::array<double, 3> surface_light{};
        for (std::size_t b = 0; b < 3; ++b) surface_light[b] = direct.total(b);
        tracer.begin(ray, &hit, surface_light, segment);
        PathRandom a(PathRandom::seed_of(ray_seed, 1), 0), b(PathRandom::seed_of(ray_seed, 2), 0),
            c(PathRandom::seed_of(ray_seed, 3), 0);
        tracer.trace_single(segment, a, single);
        tracer.trace_water(segment, b, more);
        tracer.trace_surface(segment, c, more);
        add_kinds(more, image.kinds);
        for (std::size_t band = 0; band < 3; ++band) {
            image.direct[band] += direct.total(band) / rays;
            image.single[band] += single.total(band) / rays;
            image.more[band] += more.total(band) / rays;
            image.largest[band] = std::max(image.largest[band], more.total(band));
        }
    }
    for (double& kind : image.kinds) kind /= rays;
    return image;
}

// Two estimators of others and pbrt-v4 agree on S1: its image has 1.647, 2.334 and 2.695 times the
// light of single scattering. Of the third band's, 15 % is the lit surface as seen by particles,
// 20 % lights surfaces after being scattered and 28 % is the rest that comes from the water.
TEST(PathErrors, NoPathOfFiveMillionOutweighsTheImage) {
    constexpr std::size_t k_parts = 500;
    constexpr int k_rays = 10'000;
    const PathScene scene = s1_scene();
    const PathTracer tracer(scene.lit());
    std::vector<ImageSums> parts(k_parts);
    parallel_for(k_parts, [&](std::size_t n) {
        parts[n] = trace_image(scene, tracer, PathRandom::seed_of(5, n), k_rays);
    });
    constexpr std::array k_ratios{1.647, 2.334, 2.695};
    for (std::size_t band = 0; band < 3; ++band) {
        BatchMeans ratio, more, all;
        double largest = 0;
        for (const ImageSums& part : parts) {
            const double once = part.single[band] + part.direct[band];
            ratio.add((once + part.more[band]) / once);
            more.add(part.more[band]);
            all.add(once + part.more[band]);
            largest = std::max(largest, part.largest[band]);
        }
        std::cout << "band " << band << ": ratio to single scattering " << ratio.mean() << " +- "
                  << ratio.error() << ", largest path " << largest / all.mean()
                  << " image means, kurtosis of parts " << more.kurtosis() << ", RMSE of one path "
                  << more.error() * std::sqrt(5e6) / all.mean() << "\n";
        // The ratios are known to some 0.1 %.
        EXPECT_NEAR(ratio.mean(), k_ratios[band], 2e-3 * k_ratios[band] + 3 * ratio.error());
        EXPECT_LT(largest, 50 * all.mean());
        // 3 for normal parts, +- sqrt(24 / 500); single paths with long tails would show.
        EXPECT_LT(more.kurtosis(), 3 + 5 * std::sqrt(24.0 / k_parts));
    }
    constexpr std::array k_shares{0.15, 0.20, 0.28};
    for (std::size_t kind = 0; kind < 3; ++kind) {
        BatchMeans share;
        for (const ImageSums& part : parts)
            share.add(part.kinds[kind] / (part.single[2] + part.direct[2] + part.more[2]));
        // Given in whole per cent.
        EXPECT_NEAR(share.mean(), k_shares[kind], 0.005 + 3 * share.error()) << kind;
    }
}

}  // namespace
}  // namespace uw::test
