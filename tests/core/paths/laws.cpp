// ctest labels: analytic statistical metamorphic
// Laws of light that hold whatever the water and the surfaces are.
#include <gtest/gtest.h>

#include "tests/support/geometry_descs.h"
#include "tests/support/paths/lit_box.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {
namespace {

/// A field with the same concentration everywhere.
class ConstantField : public ConcentrationField {
  public:
    explicit ConstantField(double value) : value_(value) {}
    int constituent_count() const override { return 1; }
    Bounds bounds() const override { return {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}}; }
    double finest_voxel() const override { return 0.5; }
    void sample(const Point3&, std::span<double> concentration) const override {
        concentration[0] = value_;
    }
    void column(const Point3& a, const Point3& b, std::span<double> column) const override {
        column[0] = value_ * distance(a, b);
    }
    void profile(const Ray&, double s_end, ConcentrationProfile& profile) const override {
        profile.constituent_count = 1;
        profile.s = {0};
        // Knots as in a grid, as far as light may come from.
        for (double s = 0.5; s < std::min(s_end, 20.0); s += 0.5) profile.s.push_back(s);
        profile.s.push_back(s_end);
        profile.concentration.assign(profile.s.size(), value_);
        profile.column.clear();
        for (const double s : profile.s) profile.column.push_back(value_ * s);
    }

  private:
    double value_;
};

/// Compares two sets of batches, kind by kind, each in one band.
void compare_kinds(const std::vector<TermSums>& a, std::size_t band_a,
                   const std::vector<TermSums>& b, std::size_t band_b, const std::string& what,
                   Deviations& deviations) {
    for (int s = 0; s <= 3; ++s)
        for (int r = 0; r <= 2; ++r)
            for (const bool water : {false, true}) {
                const auto of = [&](const std::vector<TermSums>& batches, std::size_t band) {
                    return means_of(batches, [&](const TermSums& sums) {
                        return sums.sum(band, [&](int m, int n, bool from_water) {
                            return std::min(m, 3) == s && std::min(n, 2) == r &&
                                   from_water == water;
                        });
                    });
                };
                const BatchMeans first = of(a, band_a), second = of(b, band_b);
                // Some kinds do not occur, and rare ones are not normally distributed.
                if (!(first.error() < 0.05 * first.mean() && second.error() < 0.05 * second.mean()))
                    continue;
                deviations.add(what + " scatterings " + std::to_string(s) + " reflections " +
                                   std::to_string(r) + (water ? " from water" : ""),
                               first, second.mean(), second.error());
            }
}

TEST(PathLaws, OrdersGrowAsPowersOfTheScatteringCoefficient) {
    // c = 1/m in all bands, so that one path has the same vertices for each: exact up to rounding.
    PathScene scene({{1 - 1e-6, 1e-6}, {0.98, 0.02}, {0.4, 0.6}}, 0.9);
    scene.add_lamp(k_lamp, 1);
    const auto batches = ray_batches(scene, some_ray(), 1, 4);
    for (int n = 1; n <= 4; ++n)
        for (const TermSums& sums : batches) {
            const double truth = sums.order(2, n) / std::pow(0.6, n);
            EXPECT_GT(truth, 0) << n;
            EXPECT_NEAR(sums.order(0, n) / std::pow(1e-6, n), truth, 1e-7 * truth) << n;
            EXPECT_NEAR(sums.order(1, n) / std::pow(0.02, n), truth, 1e-9 * truth) << n;
        }
}

TEST(PathLaws, WaterWithoutScatteringAddsNoLight) {
    const PathScene scene = lit_scene({{0.3, 0}, {0.1, 0}});
    for (const TermSums& sums : ray_batches(scene, some_ray(), 1, 4))
        for (const std::size_t band : {0U, 1U})
            EXPECT_EQ(sums.sum(band, [](int s, int, bool water) { return s > 0 || water; }), 0);
}

TEST(PathLaws, LightIsTheSumOverLamps) {
    const PathScene one = lit_scene(k_three_bands);
    PathScene two = lit_scene(k_three_bands);
    two.lamps.clear();
    two.add_lamp(k_lamp, 0.25);
    two.add_lamp(k_lamp, 0.75);
    const auto whole = ray_batches(one, some_ray(), 1), halves = ray_batches(two, some_ray(), 2);
    Deviations deviations;
    for (std::size_t b = 0; b < 3; ++b) compare_kinds(whole, b, halves, b, "band", deviations);
    deviations.expect_within_errors();
}

// A path sees one point of an area lamp at a time (LampView): here one of three of the first lamp
// and one of two of the second.
TEST(PathLaws, LightOfAnAreaLampIsTheSumOverItsPoints) {
    const std::vector<Point3> points{
        k_lamp, {0.8, -0.7, 0.1}, {1.2, -0.4, -0.1}, {-0.7, 0.6, 0.5}, {-0.9, 0.5, 0.4}};
    const std::vector<double> intensities{0.3, 0.3, 0.3, 0.2, 0.2};
    PathScene apart = lit_scene(k_three_bands);
    apart.lamps.clear();
    for (std::size_t i = 0; i < points.size(); ++i) apart.add_lamp(points[i], intensities[i]);
    PathScene together = lit_scene(k_three_bands);
    together.lamps.clear();
    for (std::size_t i = 0; i < points.size(); ++i)
        together.lamps.push_back(apart.lamps[i].with_index(i < 3 ? 0 : 1));
    ASSERT_EQ(together.lit().lamp_count(), 2U);
    const auto of_lamps = ray_batches(together, some_ray(), 1);
    const auto of_points = ray_batches(apart, some_ray(), 2);
    Deviations deviations;
    for (std::size_t b = 0; b < 3; ++b)
        compare_kinds(of_lamps, b, of_points, b, "band", deviations);
    deviations.expect_within_errors();
}

TEST(PathLaws, EachLampHasItsOwnLight) {
    struct PerLamp final : ContributionSink {
        void add(const PathContribution& term) override { sums[term.lamp] += term.radiance[0]; }
        std::array<double, 2> sums{};
    };
    PathScene both({{0.1, 0.3}}, 0.9);
    both.set_surfaces(box_and_plane(1));
    both.add_lamp(k_lamp, 1);
    both.add_lamp({-0.7, 0.6, 0.5}, 0.5);
    const PathTracer tracer(both.lit());
    const Ray ray = some_ray();
    SurfaceHit hit;
    ASSERT_TRUE(both.surfaces->closest_hit(ray, k_far, hit));
    CameraSegment segment;
    tracer.begin(ray, &hit, {}, segment);
    std::array<BatchMeans, 2> by_lamp;
    constexpr std::uint32_t k_paths = 1 << 10;
    for (std::uint64_t n = 0; n < 32; ++n) {
        PerLamp terms;
        for (std::uint32_t i = 0; i < k_paths; ++i) {
            PathRandom single(PathRandom::seed_of(n, 1), i), water(PathRandom::seed_of(n, 2), i),
                surface(PathRandom::seed_of(n, 3), i);
            tracer.trace_single(segment, single, terms);
            trace_scattered(tracer, segment, water, terms);
            tracer.trace_surface(segment, surface, terms);
        }
        for (const std::size_t lamp : {0U, 1U}) by_lamp[lamp].add(terms.sums[lamp] / k_paths);
    }
    Deviations deviations;
    for (const std::size_t lamp : {0U, 1U}) {
        PathScene alone({{0.1, 0.3}}, 0.9);
        alone.set_surfaces(box_and_plane(1));
        alone.lamps.push_back(both.lamps[lamp].with_index(0));
        const BatchMeans truth = means_of(ray_batches(alone, ray, 5 + lamp),
                                          [](const TermSums& sums) { return sums.total(0); });
        deviations.add("lamp", by_lamp[lamp], truth.mean(), truth.error());
    }
    deviations.expect_within_errors();
}

TEST(PathLaws, BandsAgreeWithRunsOfASingleBand) {
    // The pdf of distances is a mixture over the bands: clear and turbid water differ most.
    const std::vector<BandOptics> bands{{0.35, 0.20}, {0.08, 0.22}, {0.5, 1.5}};
    // Paths of three bands seldom go where the turbid band has its light.
    const auto together = ray_batches(lit_scene(bands), some_ray(), 1, 32, 1 << 14);
    Deviations deviations;
    for (std::size_t b = 0; b < bands.size(); ++b)
        compare_kinds(together, b,
                      ray_batches(lit_scene({bands[b]}), some_ray(), 2 + b, 32, 1 << 12), 0,
                      "band " + std::to_string(b), deviations);
    deviations.expect_within_errors();
}

TEST(PathLaws, AConstantFieldIsUniformWater) {
    const auto uniform = ray_batches(lit_scene(k_three_bands), some_ray(), 1);
    // All of the water's optical properties come from the field, or half of them.
    for (const double fraction : {1.0, 0.5}) {
        const auto scaled = [&](double factor) {
            std::vector<BandOptics> bands = k_three_bands;
            for (BandOptics& band : bands)
                band = {factor * band.absorption, factor * band.scattering};
            return bands;
        };
        PathScene scene = lit_scene(scaled(1 - fraction));
        scene.set_field(std::make_unique<ConstantField>(0.25), scaled(4 * fraction), 0.9);
        Deviations deviations;
        const auto field = ray_batches(scene, some_ray(), 2);
        for (std::size_t b = 0; b < 3; ++b)
            compare_kinds(uniform, b, field, b, "band " + std::to_string(b), deviations);
        deviations.expect_within_errors();
    }
}

}  // namespace
}  // namespace uw::test
