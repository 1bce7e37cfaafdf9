// ctest labels: statistical slow
// Whether the standard errors of means of light paths are as stated, and whether no single path
// dominates a mean (fireflies).
#include <gtest/gtest.h>

#include "tests/support/paths/path_tables.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/paths/s1_image.h"

namespace uw::test {
namespace {

constexpr std::size_t k_seeds = 200, k_batches_each = 32;  // for each estimate
// A dark pixel needs a thousand paths, as few of them are scattered towards the lit box beside it.
constexpr std::uint32_t k_paths_of_pixel = 1 << 10;
constexpr std::size_t k_seeds_of_pixel = 100;

/// Over many seeds, the deviation of a mean of k_batches_each batches from the truth, in units of
/// its own stated error, follows Student's t with k_batches_each - 1 degrees of freedom.
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
    constexpr double k_nu = k_batches_each - 1;
    const double variance = k_nu / (k_nu - 2), kurtosis = 3 + 6 / (k_nu - 4);
    const double spread = variance * std::sqrt((kurtosis - 1) / static_cast<double>(runs.size()));
    std::cout << what << ": variance of the deviation " << square << ", expected " << variance
              << " +- " << spread << "; mean " << sum << "\n";
    // Three times its own standard error; batches with a long tail make it somewhat larger.
    EXPECT_NEAR(square, variance, 3 * spread) << what;
    EXPECT_NEAR(sum, 0, exact ? 3 * std::sqrt(variance / static_cast<double>(runs.size())) : 0.2)
        << what;
}

TEST(PathErrors, AreStatedCorrectlyAgainstTheTable) {
    for (const TableRow& row : read_path_table("point_lamp_hg09_albedo08_radiance.csv", false)) {
        if (row.r != 1 || (row.psi_degrees != 2 && row.psi_degrees != 30)) continue;
        const PathScene scene = table_scene({0.8}, 0.9);
        const Ray ray = table_ray(row.r, row.psi_degrees * (std::numbers::pi / 180));
        std::vector<BatchMeans> runs;
        for (std::uint64_t seed = 0; seed < k_seeds; ++seed)
            runs.push_back(
                means_of(ray_batches(scene, ray, 1000 + seed, k_batches_each, 1 << 8),
                         [](const TermSums& sums) { return k_to_table * sums.total(0); }));
        expect_honest("psi " + std::to_string(row.psi_degrees), runs, row.total);
    }
}

TEST(PathErrors, AreStatedCorrectlyInTheImage) {
    const PathScene scene = s1_scene();
    struct Pixel {
        const char* what;
        double x, y;
    };
    for (const Pixel& pixel :
         {Pixel{"plane", 60.5, 200.5}, Pixel{"box", 215.5, 110.5},
          Pixel{"its silhouette", 179.5, 100.5}, Pixel{"lamp's side", 310, 60}}) {
        std::vector<std::vector<TermSums>> all;
        for (std::uint64_t seed = 0; seed < k_seeds_of_pixel; ++seed)
            all.push_back(ray_batches(scene, s1_ray(pixel.x, pixel.y), 1000 + seed, k_batches_each,
                                      k_paths_of_pixel));
        for (const std::size_t band : {0U, 2U}) {
            std::vector<BatchMeans> runs;
            for (const auto& batches : all)
                runs.push_back(
                    means_of(batches, [&](const TermSums& sums) { return sums.total(band); }));
            expect_honest(pixel.what + (" band " + std::to_string(band)), runs, std::nullopt);
        }
    }
}

// Image means relative to single scattering, from 12, 12 and 58 million PlainPaths with other seeds
// than in plain_image.cpp, which compares every kind of light with them.
constexpr std::array k_ratios{1.6603, 2.3738, 2.7504}, k_ratio_errors{0.0017, 0.0027, 0.0036};

TEST(PathErrors, NoPathOfFiveMillionOutweighsTheImage) {
    constexpr std::size_t k_parts = 500;
    constexpr int k_rays = 10'000;
    const PathScene scene = s1_scene();
    const PathTracer tracer(scene.lit());
    std::vector<S1Batch> batches(k_parts);
    parallel_for(k_parts, [&](std::size_t n) {
        batches[n] = trace_s1(scene, tracer, PathRandom::seed_of(5, n), k_rays);
    });
    Deviations ratios;
    for (std::size_t band = 0; band < 3; ++band) {
        BatchMeans ratio, more, all;
        double largest = 0;
        for (const S1Batch& batch : batches) {
            ratio.add(batch.total(band) / batch.once(band));
            more.add(batch.total(band) - batch.once(band));
            all.add(batch.total(band));
            largest = std::max(largest, batch.largest[band]);
        }
        std::cout << "band " << band << ": ratio to single scattering " << ratio.mean() << " +- "
                  << ratio.error() << ", largest path " << largest / all.mean()
                  << " image means, kurtosis of batches " << more.kurtosis()
                  << ", RMSE of one path "
                  << more.error() * std::sqrt(double{k_parts} * k_rays) / all.mean() << "\n";
        ratios.add("band " + std::to_string(band), ratio, k_ratios[band], k_ratio_errors[band]);
        // 122 as measured, and some room: bright paths are those of bright pixels, ten times the
        // mean, that meet the lit box again through the water in front of it.
        EXPECT_LT(largest, 200 * all.mean()) << "band " << band;
        // 3 for normally distributed batches, +- sqrt(24 / 500); single paths with long tails would
        // show.
        EXPECT_LT(more.kurtosis(), 3 + 5 * std::sqrt(24.0 / k_parts)) << "band " << band;
    }
    ratios.expect_within_errors();
}

}  // namespace
}  // namespace uw::test
