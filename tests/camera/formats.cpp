// ctest labels: unit
#include "camera/calibration.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using CameraNames = std::vector<std::string>;

TEST(CalibrationFormats, ValuesOfADocumentHaveTheirPath) {
    const ConfigNode root = parse_yaml("cam0:\n  width: 5\n", "c.yaml");
    const ConfigValue camera = require_value(ConfigValue(root, ""), "cam0", "give one");
    EXPECT_EQ(camera.path(), "cam0");
    EXPECT_EQ(require_value(camera, "width", "give it").location(), "c.yaml:2:10: cam0.width");
    const std::string message =
        test::message_of<InputError>([&] { require_value(camera, "height", "give it"); });
    EXPECT_NE(message.find("cam0: 'height' is missing; give it"), std::string::npos) << message;
}

TEST(CalibrationFormats, NumbersKeepAllOfTheirDigits) {
    EXPECT_EQ(number_list(std::array{1.0, 0.1, -2.5e-7}), "[1, 0.1, -2.5e-07]");
    EXPECT_EQ(number_list({}), "[]");
    EXPECT_EQ(number_list(std::array{1.0 / 3}), "[0.3333333333333333]");
}

TEST(CalibrationFormats, OneCameraIsChosen) {
    EXPECT_EQ(choose_camera({"only"}, "", "c.yaml"), "only");
    EXPECT_EQ(choose_camera({"a", "b"}, "b", "c.yaml"), "b");
    const auto refused = [](const CameraNames& names, const std::string& wanted) {
        return test::message_of<InputError>([&] { choose_camera(names, wanted, "c.yaml"); });
    };
    EXPECT_EQ(refused({}, ""), "c.yaml: contains no camera; give another file");
    EXPECT_NE(refused({"a", "b"}, "").find("c.yaml: has 2 cameras (a, b); choose one"),
              std::string::npos);
    EXPECT_EQ(refused({"a", "b"}, "c"), "c.yaml: has no camera 'c'; it has a, b");
    // Lists of names are short.
    EXPECT_EQ(refused(CameraNames(9, "a"), "c"),
              "c.yaml: has no camera 'c'; it has a, a, a, a, a, a, a, a, ...");
    EXPECT_EQ(refused({std::string(40, 'x') + "\n"}, "c"),
              "c.yaml: has no camera 'c'; it has " + std::string(30, 'x') + "...");
}

TEST(CalibrationFormats, DistortionIsAnyCoefficient) {
    DistortionDesc none;
    EXPECT_FALSE(is_distorted(none));
    for (std::size_t i = 0; i < 6; ++i) {
        DistortionDesc radial;
        radial.k[i] = 1e-9;
        EXPECT_TRUE(is_distorted(radial));
        EXPECT_TRUE(has_radial_above(radial, i));
        EXPECT_FALSE(has_radial_above(radial, i + 1));
    }
    for (std::size_t i = 0; i < 2; ++i) {
        DistortionDesc tangential;
        tangential.p[i] = -1e-9;
        EXPECT_TRUE(is_distorted(tangential));
        EXPECT_FALSE(has_radial_above(tangential, 0));
    }
}

}  // namespace
}  // namespace uw
