// ctest labels: unit
#include "camera/lens_model.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(LensModel, IsOfTheKindDescribed) {
    DistortionDesc desc;
    EXPECT_TRUE(std::holds_alternative<Distortion>(make_lens_model(desc)));
    desc.model = DistortionDesc::Model::fisheye;
    EXPECT_TRUE(std::holds_alternative<Fisheye>(make_lens_model(desc)));
}

TEST(LensModel, HasTheCoefficientsDescribed) {
    DistortionDesc desc;
    desc.k[0] = 0.1;
    const auto lens = std::get<Distortion>(make_lens_model(desc));
    EXPECT_NEAR(lens.distort({0.5, 0}).x, 0.5 * (1 + 0.1 * 0.25), 1e-15);
}

}  // namespace
}  // namespace uw
