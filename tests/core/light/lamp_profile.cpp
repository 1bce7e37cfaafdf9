// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/ies_files.h"
#include "tests/support/lamp_profile_laws.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

template <class Profile>
bool makes(const LampProfileDesc& desc) {
    std::vector<std::string> warnings;
    return std::holds_alternative<Profile>(make_lamp_profile(desc, {}, warnings)) &&
           warnings.empty();
}

TEST(LampProfile, IsThatOfItsDescription) {
    const SceneFolder folder;
    IesWriter writer;
    writer.polar = {0, 180};
    writer.candelas = [](double, double) { return 500.0; };
    EXPECT_TRUE(makes<IsotropicProfile>(IsotropicProfileDesc{}));
    EXPECT_TRUE(makes<SpotProfile>(SpotProfileDesc{60, 5}));
    EXPECT_TRUE(makes<CosineProfile>(CosineProfileDesc{60}));
    EXPECT_TRUE(makes<TableProfile>(TableProfileDesc{{0, 60}, {1, 0}}));
    EXPECT_TRUE(makes<IesProfile>(IesProfileDesc{folder.write("lamp.ies", writer.text())}));
}

TEST(LampProfile, OnlyAbsoluteOnesHaveCandelas) {
    const SceneFolder folder;
    IesWriter writer;
    writer.polar = {0, 180};
    writer.candelas = [](double, double) { return 500.0; };
    for (const LampProfileDesc& desc :
         {LampProfileDesc(IsotropicProfileDesc{}), LampProfileDesc(SpotProfileDesc{60, 5}),
          LampProfileDesc(CosineProfileDesc{60}),
          LampProfileDesc(TableProfileDesc{{0, 60}, {1, 0}}),
          LampProfileDesc(IesProfileDesc{folder.write("lamp.ies", writer.text())})}) {
        std::vector<std::string> warnings;
        const LampProfile profile = make_lamp_profile(desc, {}, warnings);
        const bool has_candelas =
            std::visit([](const auto& made) { return made.peak_candelas().has_value(); }, profile);
        EXPECT_EQ(has_candelas,
                  std::visit([](const auto& described) { return described.k_is_absolute; }, desc));
    }
}

TEST(IsotropicProfile, IsOneAllAround) {
    const IsotropicProfile profile;
    expect_lamp_profile_laws(profile);
    EXPECT_EQ(profile.relative_intensity({-3, 1, 0.2}), 1);
    EXPECT_NEAR(profile.solid_angle(), 4 * std::numbers::pi, 1e-12);
    EXPECT_TRUE(profile.cone().has_all());
}

}  // namespace
}  // namespace uw::test
