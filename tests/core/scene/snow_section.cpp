// ctest labels: unit
#include <gtest/gtest.h>

#include "tests/support/scene_errors.h"

namespace uw::test {
namespace {

const std::string k_camera = "uwvdb: 1\ncamera: {resolution: [4, 4], intrinsics: {fov_x: 60}}\n";

SnowDesc snow_from(const std::string& snow) {
    return read_scene_text(k_camera + "water:\n  snow: " + snow + "\n", "scene.yaml", {})
        .water.snow.value();
}

TEST(SnowSection, IsReadInTheUnitsThatItIsWrittenIn) {
    const SnowDesc snow = snow_from(
        "{number: 2000, diameter: [50 um, 1.5cm], exponent: 3.5, reflectance: [0.1, 0.2, 0.3],"
        " drift: [0.1, 0, -0.2], seed: 9, mean: added, ground_truth: held, most: 5000}");
    EXPECT_EQ(snow.number, 2000);
    EXPECT_DOUBLE_EQ(snow.least, 50e-6);
    EXPECT_DOUBLE_EQ(snow.greatest, 0.015);
    EXPECT_EQ(snow.exponent, 3.5);
    EXPECT_EQ(snow.reflectance, (PerBand{0.1, 0.2, 0.3}));
    EXPECT_EQ(snow.drift, Vector3(0.1, 0, -0.2));
    EXPECT_EQ(snow.seed, 9U);
    EXPECT_EQ(snow.mean, SnowDesc::Mean::added);
    EXPECT_TRUE(snow.in_ground_truth);
    EXPECT_EQ(snow.most, 5000);
}

TEST(SnowSection, HasDefaults) {
    const SnowDesc snow = snow_from("{number: 1, diameter: [0.0002, 5 mm]}");
    EXPECT_DOUBLE_EQ(snow.least, 2e-4);
    EXPECT_EQ(snow.exponent, 4);
    EXPECT_EQ(snow.reflectance, (PerBand{0.4, 0.4, 0.4}));
    EXPECT_EQ(snow.drift, Vector3(0));
    EXPECT_EQ(snow.mean, SnowDesc::Mean::included);
    EXPECT_FALSE(snow.in_ground_truth);
    EXPECT_EQ(snow.most, 1'000'000);
    EXPECT_DOUBLE_EQ(snow_from("{number: 1, diameter: [80 µm, 5 mm]}").least, 80e-6);
}

using SnowErrors = SceneErrors;

TEST_F(SnowErrors, AreOneLineWithAHint) {
    check(
        k_camera + "water:\n  snow: ",
        {
            {"{diameter: [1 mm, 2 mm]}\n", "scene.yaml:4:9: water.snow: 'number' is missing"},
            {"{number: 5}\n", "water.snow: 'diameter' is missing"},
            {"{number: 0, diameter: [1 mm, 2 mm]}\n",
             "water.snow.number: must be greater than 0, found 0; give the particles per m^3"},
            {"{number: 1e18, diameter: [1 mm, 2 mm]}\n",
             "water.snow.number: 1e+18 is larger than anything in a scene"},
            {"{number: 5, diameter: 3 mm}\n",
             "give the least and the greatest diameter, such as [0.2 mm, 5 mm]"},
            {"{number: 5, diameter: [1 mm, 2 inch]}\n",
             "water.snow.diameter[1]: expected a diameter, found the text '2 inch'; give a length "
             "with its unit, such as 0.2 mm"},
            {"{number: 5, diameter: [0.2, 5]}\n", "must be from 1 um to 10 cm, found 0.2 m"},
            {"{number: 5, diameter: [2 mm, 1 mm]}\n", "the first must be less than the second"},
            {"{number: 5, diameter: [1 mm, 2 mm], reflectence: 1}\n",
             "water.snow.reflectence: unknown key; did you mean 'reflectance'?"},
            {"{number: 5, diameter: [1 mm, 2 mm], reflectance: 1.2}\n",
             "water.snow.reflectance: must be from 0 to 1, found 1.2"},
            {"{number: 5, diameter: [1 mm, 2 mm], mean: add}\n", "did you mean 'added'?"},
            {"{number: 5, diameter: [1 mm, 2 mm], ground_truth: hold}\n", "did you mean 'held'?"},
            {"{number: 5, diameter: [1 mm, 2 mm], most: 1000000000}\n",
             "water.snow.most: must be from 1 to 20000000, found 1000000000"},
        });
}

}  // namespace
}  // namespace uw::test
