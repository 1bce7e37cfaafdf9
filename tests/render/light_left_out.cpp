// ctest labels: unit statistical
#include "render/light_left_out.h"

#include <gtest/gtest.h>

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
    /// The share of the layer `multiple` in an image of many paths.
    double share_in_image() {
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

TEST_F(LeftOut, IsTheShareOfMultipleInTheImage) {
    const LightLeftOut left_out = estimate().value();
    const double share = share_in_image();
    EXPECT_GT(share, 0.2);
    EXPECT_GT(left_out.error, 0);
    // Three errors, and 0.03 for the places between those that are looked at.
    EXPECT_NEAR(left_out.share, share, 3 * left_out.error + 0.03);
    EXPECT_LT(left_out.error, 0.1);
}

TEST_F(LeftOut, IsNothingWhereALoneSurfaceReflectsInClearWater) {
    desc_.water.scattering->b = {0, 0, 0};
    desc_.geometry = {plane_at_z(5)};
    EXPECT_EQ(estimate().value().share, 0);
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

}  // namespace
}  // namespace uw::test
