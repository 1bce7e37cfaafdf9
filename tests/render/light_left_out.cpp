// ctest labels: unit statistical
#include "render/light_left_out.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <utility>

#include "core/base/parallel.h"
#include "render/renderer.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

class LeftOut : public testing::Test {
  protected:
    LeftOut() {
        desc_ = pinhole_scene(24, 18);
        desc_.lamps = {isotropic_lamp({1, -0.5, 0}, 40)};
        desc_.water.absorption = PerBand{0.1, 0.1, 0.2};
        desc_.water.scattering = ScatteringDesc{{0.4, 0.4, 0.4}, {}};
        desc_.water.scattering->phase.function = HenyeyGreensteinDesc{0.8};
    }
    std::optional<LightLeftOut> estimate() {
        renderer_.set_scene(SceneDesc(desc_));
        return renderer_.light_left_out();
    }
    std::optional<std::string> warning() {
        const std::optional<LightLeftOut> left_out = estimate();
        return left_out_note(renderer_.assembled(), left_out);
    }
    /// The fraction of the layer `multiple` in an image of many paths.
    double fraction_in_image() {
        SceneDesc all = desc_;
        all.render.integrator = RenderDesc::Integrator::path;
        all.render.scattering = RenderDesc::Scattering::multiple;
        all.render.samples = 512;
        renderer_.set_scene(std::move(all));
        const Film& film = renderer_.render({.layers = "multiple,direct,backscatter"});
        double multiple = 0, sum = 0;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                for (std::size_t c = 0; c < film.channel_names().size(); ++c) {
                    const std::string& name = film.channel_names()[c];
                    if (name.find('.') == std::string::npos) continue;  // of the total
                    const double value = film.pixel(x, y)[c];
                    sum += value;
                    if (name.starts_with("multiple")) multiple += value;
                }
        return multiple / sum;
    }

    SceneDesc desc_;
    Renderer renderer_;
};

TEST_F(LeftOut, IsTheFractionOfMultipleInTheImage) {
    const LightLeftOut left_out = estimate().value();
    const double fraction = fraction_in_image();
    EXPECT_GT(fraction, 0.2);
    EXPECT_GT(left_out.error, 0);
    // Three errors, and 0.03 for the places between those that are looked at.
    EXPECT_NEAR(left_out.fraction, fraction, 3 * left_out.error + 0.03);
    EXPECT_LT(left_out.error, 0.1);
}

TEST_F(LeftOut, IsNothingWhereALoneSurfaceReflectsInClearWater) {
    desc_.water.scattering->b = {0, 0, 0};
    desc_.geometry = {plane_at_z(5)};
    EXPECT_EQ(estimate().value().fraction, 0);
    EXPECT_FALSE(warning());
}

TEST_F(LeftOut, IsNotAskedWhereAllLightIsRendered) {
    desc_.render.scattering = RenderDesc::Scattering::multiple;
    EXPECT_FALSE(estimate());
    EXPECT_FALSE(warning());
}

TEST_F(LeftOut, IsWarnedOfWithTheSettingsThatRenderIt) {
    EXPECT_NE(warning().value().find("; render.scattering: multiple renders it"),
              std::string::npos);
    desc_.render.integrator = RenderDesc::Integrator::reference;
    EXPECT_NE(warning().value().find("multiple and render.integrator: volume renders it"),
              std::string::npos);
    desc_.render.integrator = RenderDesc::Integrator::volume;
    desc_.water.forward_scatter.K = 0.3;
    EXPECT_NE(warning().value().find("and water.forward_scatter.K: 0 renders it"),
              std::string::npos);
}

/// Counts what is traced through other surfaces.
class CountedSurfaces final : public Surfaces {
  public:
    explicit CountedSurfaces(std::shared_ptr<const Surfaces> traced) : traced_(std::move(traced)) {}

    std::size_t rays() const { return rays_; }
    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        ++rays_;
        return traced_->closest_hit(ray, s_end, hit);
    }
    double hit_distance(const Ray& ray) const override {
        ++rays_;
        return traced_->hit_distance(ray);
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        ++rays_;
        return traced_->occluded(from, to);
    }
    const SurfaceNames& names() const override { return traced_->names(); }
    Bounds bounds() const override { return traced_->bounds(); }
    std::uint64_t triangle_count() const override { return traced_->triangle_count(); }
    bool empty() const override { return traced_->empty(); }

  private:
    std::shared_ptr<const Surfaces> traced_;
    mutable std::atomic<std::size_t> rays_{0};
};

// However turbid the water is, and however large the image. A vertex takes some rays, to lamps and
// onwards, and a place's paths are traced to their end: where the water absorbs a thousandth of
// what it scatters they are followed for 13 000 rays each, of which there were 1152.
TEST_F(LeftOut, IsBoundedWork) {
    const auto rays_of = [&](int width, int height, int threads) {
        desc_.camera.width = width;
        desc_.camera.height = height;
        std::size_t rays = 0;
        with_threads(threads, [&] {
            renderer_.set_scene(SceneDesc(desc_));
            AssembledScene scene = renderer_.assemble();
            const auto counted = std::make_shared<const CountedSurfaces>(scene.surfaces);
            scene.surfaces = counted;
            estimate_light_left_out(scene);  // none where all is dark
            rays = counted->rays();
        });
        return rays;
    };
    desc_.geometry = {plane_at_z(5)};
    for (const double b : {0.0, 0.4, 10.0, 100.0}) {
        desc_.water.scattering->b = {b, b, b};
        const std::size_t small = rays_of(24, 18, 1), large = rays_of(2400, 1800, 1);
        EXPECT_LT(small, 100'000U) << b;
        EXPECT_LT(large, 400'000U) << b;
        EXPECT_EQ(small, rays_of(24, 18, 2)) << b;  // the same work in every run
    }
}

}  // namespace
}  // namespace uw::test
