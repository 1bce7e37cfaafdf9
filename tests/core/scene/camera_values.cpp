// ctest labels: unit
#include "core/scene/camera_desc.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

CameraDesc camera_of_resolution(const std::string& yaml) {
    const ConfigNode root = parse_yaml(yaml, "s.yaml");
    const ConfigValue both(root, "resolution");
    const auto sides = both.list_of(2, "");
    CameraDesc camera;
    read_resolution(both, sides[0], sides[1], camera);
    return camera;
}

std::string resolution_error(const std::string& yaml) {
    return test::message_of<InputError>([&] { camera_of_resolution(yaml); });
}

TEST(CameraValues, ResolutionsOfAnyImageThatFits) {
    const CameraDesc camera = camera_of_resolution("[640, 480]");
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    EXPECT_EQ(camera_of_resolution("[1, 32768]").height, 32768);
    EXPECT_EQ(camera_of_resolution("[16384, 16384]").width, 16384);  // 2^28 pixels
    EXPECT_NE(resolution_error("[16384, 16385]").find("resolution: 16384 x 16385 are more than"),
              std::string::npos);
    EXPECT_NE(resolution_error("[0, 480]").find("resolution[0]: must be from 1 to 32768"),
              std::string::npos);
    EXPECT_NE(resolution_error("[640, 32769]").find("resolution[1]: must be from 1 to 32768"),
              std::string::npos);
    EXPECT_NE(resolution_error("[640.5, 480]").find("whole number"), std::string::npos);
}

TEST(CameraValues, RefractiveIndicesAreThoseOfMatter) {
    for (const char* yaml : {"1", "1.334", "3"}) {
        const ConfigNode root = parse_yaml(yaml, "s.yaml");
        EXPECT_EQ(read_refractive_index(ConfigValue(root, "n")), std::stod(yaml));
    }
    for (const char* yaml : {"0.99", "3.01", "-1.3", "water"}) {
        const ConfigNode root = parse_yaml(yaml, "s.yaml");
        EXPECT_THROW(read_refractive_index(ConfigValue(root, "n")), InputError) << yaml;
    }
}

TEST(CameraValues, GlassLiesBeforeTheCamera) {
    const ConfigNode root = parse_yaml("[0, 0, 1]", "s.yaml");
    const ConfigValue at(root, "normal");
    EXPECT_NO_THROW(check_port_normal(at, {0, 0.9, 0.1}));
    for (const double z : {0.0, -0.1})
        EXPECT_NE(test::message_of<InputError>([&] {
                      check_port_normal(at, {1, 0, z});
                  }).find("normal: must point away from the camera"),
                  std::string::npos);
}

TEST(CameraValues, TheCameraStandsInItsDome) {
    const ConfigNode root = parse_yaml("{}", "s.yaml");
    const ConfigValue at(root, "port");
    DomePortDesc dome;
    dome.radius = 0.05;
    dome.center = {0, 0.03, 0.039};  // 0.0492 m away
    EXPECT_NO_THROW(check_dome(at, dome));
    dome.center = {0, 0.03, 0.04};  // on the glass
    EXPECT_NE(test::message_of<InputError>([&] {
                  check_dome(at, dome);
              }).find("port: the camera is outside its dome: it is 0.05 m from the centre"),
              std::string::npos);
}

}  // namespace
}  // namespace uw
