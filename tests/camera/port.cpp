// ctest labels: unit
#include "camera/port.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(Port, HasTheNumbersDescribed) {
    FlatPortDesc flat;
    flat.distance = 0.1;
    flat.thickness = 0.02;
    const auto ray = make_port(flat)->refracted_ray({0, 0, 1});
    EXPECT_NEAR(ray.value().origin.z, 0.12, 1e-15);
    DomePortDesc dome;
    dome.center = {0, 0, 0.01};
    dome.radius = 0.05;
    dome.thickness = 0.007;
    const auto through = make_port(dome)->refracted_ray({0, 0, 1});
    EXPECT_NEAR(through.value().origin.z, 0.067, 1e-15);
}

}  // namespace
}  // namespace uw
