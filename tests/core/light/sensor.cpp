// ctest labels: unit analytic
#include "core/image/image_quantity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

constexpr double k_rounding = 1e-14;
// pi/4 * 0.95 / 2.8^2, by hand: an image at infinity on the axis, per radiance.
constexpr double k_on_axis = 0.09516942031;
constexpr double k_digits = 1e-11;  // of the constant above

SensorModel sensor(RenderDesc::Output output) {
    SceneDesc desc;
    desc.render.output = output;
    desc.camera.lens = LensDesc{2.8, 0.0085, 0.95};
    return SensorModel(desc);
}

TEST(FocusFactor, ClosedForm) {
    EXPECT_NEAR(focus_factor(0.085, 0.0085), 0.81, k_rounding);
    EXPECT_EQ(focus_factor(k_infinitely_far, 0.0085), 1);
    EXPECT_EQ(focus_factor(0.0085, 0.0085), 0);
    EXPECT_EQ(focus_factor(0.001, 0.0085), 0);
    EXPECT_EQ(focus_factor(0, 0.0085), 0);
}

TEST(SensorModel, RadianceIsLeftAlone) {
    EXPECT_EQ(SensorModel().pixel_factor({0.5, 1}, 0.1), 1);
    EXPECT_EQ(SensorModel().pixel_factor({0.5, 0.96}, 0.1), 0.96);
    EXPECT_EQ(SensorModel().surface_factor(0.1), 1);
    EXPECT_EQ(SensorModel().description(), "radiance W m^-2 sr^-1");
}

TEST(SensorModel, IrradianceHasTheSquareOfTheFNumber) {
    const SensorModel model = sensor(RenderDesc::Output::sensor_irradiance);
    EXPECT_NEAR(model.pixel_factor({1, 1}, k_infinitely_far), k_on_axis, k_digits);
    EXPECT_NEAR(model.pixel_factor({1, 1}, 0.085), 0.81 * k_on_axis, k_digits);
    EXPECT_NEAR(model.pixel_factor({1.0 / 16, 1}, k_infinitely_far), k_on_axis / 16, k_digits);
    EXPECT_NEAR(model.pixel_factor({1, 0.9}, k_infinitely_far), 0.9 * k_on_axis, k_digits);
    EXPECT_EQ(model.surface_factor(0.085), 1);
    EXPECT_EQ(model.description(), "sensor irradiance W m^-2");
}

TEST(SensorModel, PaperIsNTimesOurs) {
    const SensorModel ours = sensor(RenderDesc::Output::sensor_irradiance);
    const SensorModel paper = sensor(RenderDesc::Output::paper);
    const LensRay ray{0.8, 0.95};
    EXPECT_NEAR(paper.pixel_factor(ray, 0.3) * paper.surface_factor(0.3),
                2.8 * ours.pixel_factor(ray, 0.3), k_rounding);
    // Its distance is that of each bit of light, not of the pixel.
    EXPECT_EQ(paper.pixel_factor(ray, 0.3), paper.pixel_factor(ray, 3));
    EXPECT_NEAR(paper.surface_factor(0.085), 0.81, k_rounding);
}

TEST(SensorModel, MeanOverAStretchIsThatOfManyPoints) {
    const SensorModel paper = sensor(RenderDesc::Output::paper);
    constexpr int k_points = 100000;
    for (const auto& [begin, end] :
         {std::pair{0.0, 0.02}, {0.002, 0.004}, {0.0085, 0.009}, {0.03, 0.05}, {2.0, 5.0}}) {
        double sum = 0;
        for (int i = 0; i < k_points; ++i)
            sum += paper.surface_factor(begin + (end - begin) * (i + 0.5) / k_points);
        // The midpoint rule's error falls as 1e-10.
        EXPECT_NEAR(paper.mean_surface_factor(begin, end), sum / k_points, 1e-8) << begin;
    }
    EXPECT_EQ(SensorModel().mean_surface_factor(0, 1), 1);
    EXPECT_EQ(sensor(RenderDesc::Output::sensor_irradiance).mean_surface_factor(0.001, 0.02), 1);
}

}  // namespace
}  // namespace uw
