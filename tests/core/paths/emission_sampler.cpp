// ctest labels: unit analytic statistical
// The light of emissive volumes that paths meet: directions have the density that is said of them,
// and segments the line integral of the emission.
#include "core/paths/emission_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/light/emission.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/paths/path_scene.h"

namespace uw::test {
namespace {

constexpr double k_sigma = 0.3;  // of a volume [m]

class Total final : public ContributionSink {
  public:
    void add(const PathContribution& contribution) override {
        for (std::size_t b = 0; b < 2; ++b) sum_[b] += contribution.radiance[b];
        EXPECT_TRUE(contribution.is_met);
    }
    double of(std::size_t band) const { return sum_[band]; }

  private:
    Spectrum sum_;
};

/// Two volumes of Gaussian emission, of which the second is twice as bright, in water that
/// attenuates by 0.3 and 1.1 per metre, with absorbing smoke within the first.
class SampledEmission : public testing::Test {
  protected:
    SampledEmission() : scene_({{0.1, 0.2}, {0.6, 0.5}}, 0.8) {
        scene_.set_field(std::make_unique<GaussianField>(k_centres[0], k_sigma, 1, 0.05),
                         {{2, 1}, {4, 1}}, 0.5);
        EmissionDesc desc;
        desc.per_unit = {3, 1};
        const std::vector<double> bands{540, 450};
        for (std::size_t i = 0; i < 2; ++i) {
            auto volume = std::make_shared<EmissiveVolume>(
                EmissiveVolume{std::make_shared<GaussianField>(k_centres[i], k_sigma,
                                                               1 + static_cast<double>(i), 0.05),
                               Emission(desc, bands),
                               {}});
            emissions_.push_back({i, volume});
            scene_.add_lamp(k_centres[i], 1);
            scene_.lamps.back() = scene_.lamps.back().met_by_paths();
        }
        lit_ = scene_.lit();
        lit_.emissions = &emissions_;
    }

    static inline const std::vector<Point3> k_centres{{0, 0, 2}, {1.5, 0.4, 3}};
    PathScene scene_;
    std::vector<SceneEmission> emissions_;
    LitScene lit_;
};

// Moments over the sphere, by the density in a product rule and by samples: outside of the volumes,
// at the edge of one, and within it.
TEST_F(SampledEmission, DirectionsHaveTheirDensity) {
    const EmissionSampler sampler(lit_);
    const Vector3 axis = glm::normalize(Vector3(0.3, -0.5, 0.8));
    for (const Point3& x : {Point3(0, 0, 0), Point3(0.3, -0.2, 1.8), Point3(1.4, 0.4, 2.9)}) {
        double all = 0, first = 0, second = 0;
        constexpr int k_rows = 1000, k_columns = 2000;
        for (int i = 0; i < k_rows; ++i)
            for (int j = 0; j < k_columns; ++j) {
                const double cosine = 1 - 2 * (i + 0.5) / k_rows;
                const double sine = std::sqrt(1 - cosine * cosine);
                const double azimuth = 2 * std::numbers::pi * (j + 0.5) / k_columns;
                const Vector3 w(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
                const double mass =
                    sampler.towards({x, w}).pdf * 4 * std::numbers::pi / (k_rows * k_columns);
                const double along = glm::dot(w, axis);
                all += mass;
                first += mass * along;
                second += mass * along * along;
            }
        // Cells have sharp edges, which the rule crosses at 0.2 degrees.
        EXPECT_NEAR(all, 1, 2e-3);
        std::mt19937_64 engine(7);
        std::uniform_real_distribution<double> uniform;
        double mean = 0, square = 0;
        constexpr int k_samples = 200000;
        for (int n = 0; n < k_samples; ++n) {
            const double along = glm::dot(
                sampler.sample(x, uniform(engine), uniform(engine), uniform(engine)), axis);
            mean += along / k_samples;
            square += along * along / k_samples;
        }
        // Four standard errors of a mean of what deviates by 0.5 at most.
        EXPECT_NEAR(mean, first, 2e-3 + 4 * 0.5 / std::sqrt(k_samples));
        EXPECT_NEAR(square, second, 2e-3 + 4 * 0.5 / std::sqrt(k_samples));
    }
}

// int emission e^-tau ds along segments through both volumes, through one, and past both.
TEST_F(SampledEmission, SegmentsHaveTheirLineIntegral) {
    const EmissionSampler sampler(lit_);
    const WaterOptics optics(lit_, /*exact=*/true);
    const Point3 origin(0, 0.1, 0.5);
    for (const Point3& to : {Point3(0.1, 0, 2), Point3(1.5, 0.5, 3), Point3(-0.7, 0, 2.2)}) {
        const Vector3 direction = glm::normalize(to - origin);
        WaterSegment segment;
        optics.trace({origin, direction}, segment);
        PathState state;
        state.ray = segment.ray;
        std::ranges::fill(state.throughput.first(2), 1.0);
        Spectrum mean, square;
        constexpr int k_samples = 20000;
        EmissionSampler::Scratch scratch;
        for (std::uint32_t n = 0; n < k_samples; ++n) {
            PathRandom random(PathRandom::seed_of(n), 0);
            Total total;
            sampler.estimate(optics, segment, state, random, total, scratch);
            for (std::size_t b = 0; b < 2; ++b) {
                mean[b] += total.of(b) / k_samples;
                square[b] += total.of(b) * total.of(b) / k_samples;
            }
        }
        for (std::size_t b = 0; b < 2; ++b) {
            const auto integrand = [&](double s) {
                std::vector<double> column(1), value(1);
                scene_.field->column(origin, segment.ray.at(s), column);
                double emission = 0;
                for (const SceneEmission& each : emissions_) {
                    each.volume->field->sample(segment.ray.at(s), value);
                    emission += (b == 0 ? 3 : 1) * value[0];
                }
                return emission * std::exp(-optics.attenuation().optical_depth(b, s, column));
            };
            double truth = 0;
            for (double s = 0; s < 6; s += 0.25)
                truth += AdaptiveQuadrature::integrate(integrand, s, s + 0.25, 1e-9);
            const double error =
                std::sqrt(std::max(0.0, square[b] - mean[b] * mean[b]) / k_samples);
            ASSERT_GT(truth, 1e-4);
            EXPECT_NEAR(mean[b], truth, 4 * error + 1e-3 * truth);  // profiles are linear
            EXPECT_LT(error, 0.01 * truth);                         // one in a hundred
        }
    }
}

// Lamps that paths do not meet are not of its concern.
TEST_F(SampledEmission, IsEmptyWherePointsStandForTheVolumes) {
    scene_.lamps.clear();
    scene_.add_lamp(k_centres[0], 1);
    scene_.add_lamp(k_centres[1], 1);
    EXPECT_TRUE(EmissionSampler(lit_).empty());
}

}  // namespace
}  // namespace uw::test
