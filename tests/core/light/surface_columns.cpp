// ctest labels: analytic
// Columns of a tile's surfaces, mixed from every fourth one, against the closed form.
#include "core/light/surface_lighting.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "media/light/deep_shadow_map.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/sphere_surface.h"

namespace uw::test {
namespace {

constexpr int k_tile = 32;
constexpr double k_tolerance = 1e-3;

/// Counts how many columns are integrated.
class CountedField : public GaussianField {
  public:
    using GaussianField::GaussianField;
    void column(const Point3& a, const Point3& b, std::span<double> column) const override {
        ++count;
        GaussianField::column(a, b, column);
    }
    mutable std::atomic<int> count = 0;
};

/// A tile of a camera at the origin before a surface, and a lamp beside it.
class SurfaceColumnsTest : public ::testing::Test {
  protected:
    SurfaceColumnsTest() {
        medium_.wavelengths_nm = {620, 540};
        medium_.uniform.absorption = {0.2, 0.05};
        medium_.constituents.push_back({"small", "ppm", {{1.0, 0.4}, {}}});
        lamps_.emplace_back("lamp", Point3{-0.8, -0.5, 0.1}, IsotropicProfile(), Spectrum{1, 1});
        deep_shadows_.push_back(std::make_shared<DeepShadowMap>(
            field_, nothing_, lamps_.front().position(), DeepShadowOptions{16, 2, 1 << 24}));
    }

    /// `depth(x, y)`: where the surface is, camera z [m]. The tile's first pixel is (x0, y0).
    template <typename Depth>
    void look(const Depth& depth, int x0 = 0, int y0 = 0) {
        for (int y = 0; y < k_tile; ++y)
            for (int x = 0; x < k_tile; ++x) {
                const Vector3 v((x + 0.5 - 16) / 300, (y + 0.5 - 16) / 300, 1);
                SurfaceSample sample{
                    {{0, 0, 0}, glm::normalize(v)}, {}, x0 + x + 0.5, y0 + y + 0.5};
                sample.hit.position = Point3{} + depth(x, y) * v;
                sample.hit.distance = depth(x, y) * glm::length(v);
                samples_.push_back(sample);
            }
        for (const SurfaceSample& sample : samples_) seen_.push_back(&sample);
    }

    struct Outcome {
        double worst = 0;  // error of what a path lets through
        int integrated = 0;
    };
    Outcome run(bool from_lamp) {
        const LitScene scene{&medium_, &field_, &nothing_, &lamps_};
        const AttenuationTable attenuation(medium_);
        SurfaceColumns columns;
        field_.count = 0;
        columns.begin(scene, attenuation, {&deep_shadows_, k_tolerance}, seen_);
        from_lamp ? columns.take_emitter(0) : columns.take_camera();
        std::vector<double> mixed(samples_.size());
        for (std::size_t i = 0; i < mixed.size(); ++i) columns.column(i, {&mixed[i], 1});
        Outcome outcome{0, field_.count};
        for (std::size_t i = 0; i < mixed.size(); ++i) {
            const Point3& from = from_lamp ? lamps_.front().position() : samples_[i].ray.origin;
            double exact = 0;
            field_.column(from, samples_[i].hit.position, {&exact, 1});
            const double length = distance(from, samples_[i].hit.position);
            for (int band = 0; band < 2; ++band) {
                const auto lets_through = [&](const double& column) {
                    return std::exp(-attenuation.optical_depth(band, length, {&column, 1}));
                };
                outcome.worst =
                    std::max(outcome.worst, std::abs(lets_through(mixed[i]) - lets_through(exact)));
            }
        }
        return outcome;
    }

    // Within the cloud, so that columns depend on where the surface is.
    CountedField field_{{0.1, 0, 1.8}, 0.25, 3.0, 0.05};
    SphereSurface nothing_{{0, 0, -5}, 0.1};
    Medium medium_;
    std::vector<Lamp> lamps_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<SurfaceSample> samples_;
    std::vector<const SurfaceSample*> seen_;
};

// What is confirmed halfway between its nodes is no farther off elsewhere, but for the curvature of
// what is mixed bilinearly: half as much again.
constexpr double k_allowed = 1.5 * k_tolerance;
constexpr int k_samples = k_tile * k_tile;

TEST_F(SurfaceColumnsTest, ASmoothSurfaceTakesFewIntegrals) {
    look([](int x, int y) { return 2.0 + 0.004 * x - 0.003 * y; });
    for (const bool from_lamp : {false, true}) {
        const Outcome outcome = run(from_lamp);
        EXPECT_LT(outcome.worst, k_allowed) << from_lamp;
        EXPECT_GT(outcome.worst, 0) << from_lamp;
        EXPECT_LT(outcome.integrated, k_samples / 4) << from_lamp;
    }
}

TEST_F(SurfaceColumnsTest, ATileTakesAsFewWhereverItLiesInTheImage) {
    const auto depth = [](int x, int y) { return 2.0 + 0.004 * x - 0.003 * y; };
    look(depth);
    const Outcome first = run(true);
    samples_.clear();
    seen_.clear();
    look(depth, 32, 96);
    const Outcome other = run(true);
    EXPECT_EQ(other.integrated, first.integrated);
    EXPECT_NEAR(other.worst, first.worst, 1e-12);  // of positions' rounding
}

TEST_F(SurfaceColumnsTest, ARoughSurfaceIsWithinTheTolerance) {
    look([](int x, int y) { return 2.0 + 0.01 * std::sin(0.9 * x) * std::cos(0.7 * y); });
    for (const bool from_lamp : {false, true}) EXPECT_LT(run(from_lamp).worst, k_allowed);
}

TEST_F(SurfaceColumnsTest, NothingIsMixedAcrossAnEdge) {
    // The edge runs between nodes; what lies before the cloud sees none of it.
    look([](int x, int y) { return x + y < 31 ? 1.2 : 2.4; });
    for (const bool from_lamp : {false, true}) EXPECT_LT(run(from_lamp).worst, k_allowed);
}

TEST_F(SurfaceColumnsTest, WithoutAToleranceEveryColumnIsExact) {
    look([](int, int) { return 2.0; });
    const LitScene scene{&medium_, &field_, &nothing_, &lamps_};
    const AttenuationTable attenuation(medium_);
    SurfaceColumns columns;
    field_.count = 0;
    columns.begin(scene, attenuation, {}, seen_);
    columns.take_camera();
    double column = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) columns.column(i, {&column, 1});
    EXPECT_EQ(field_.count, k_samples);
}

}  // namespace
}  // namespace uw::test
