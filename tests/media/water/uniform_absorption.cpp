// ctest labels: unit analytic
#include "media/water/water_types.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/water_descs.h"

namespace uw {
namespace {

using test::basic_water;

class UniformAbsorption : public testing::Test {
  protected:
    Spectrum absorption(const WaterDesc& water, const JerlovPreset* preset = nullptr) {
        warnings_.clear();
        return uniform_absorption(water, preset, warnings_);
    }
    std::vector<std::string> warnings_;
};

TEST_F(UniformAbsorption, IsPureWatersAndWhatIsDissolved) {
    WaterDesc water = basic_water();
    water.bands_nm = {440, 540};
    const Spectrum pure = absorption(water);
    EXPECT_EQ(pure[0], pure_water_absorption(440, 20, 35));
    EXPECT_EQ(pure[2], 0);
    water.temperature = 10;
    water.salinity = 5;
    EXPECT_EQ(absorption(water)[1], pure_water_absorption(540, 10, 5));
    water = basic_water();
    water.bands_nm = {440, 540};
    water.cdom = 0.2;
    water.chlorophyll = 1;
    const Spectrum dissolved = absorption(water);
    // At 440 nm by the definition of cdom and by Bricaud's table.
    EXPECT_NEAR(dissolved[0] - pure[0], 0.2 + 0.0403, 1e-15);
    water.chlorophyll = 0;
    EXPECT_NEAR(absorption(water)[1] - pure[1], 0.2 * std::exp(-1.4), 1e-15);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(UniformAbsorption, AsGivenStandsAlone) {
    WaterDesc water = basic_water();
    water.bands_nm = {10000, 20000};  // known to nobody else
    water.absorption = PerBand{0.5, 7};
    const Spectrum given = absorption(water);
    EXPECT_EQ(given[0], 0.5);
    EXPECT_EQ(given[1], 7);
    EXPECT_TRUE(warnings_.empty());
    water.cdom = 0.1;
    EXPECT_EQ(absorption(water)[0], 0.5);
    EXPECT_EQ(warnings_, (std::vector<std::string>{water.where +
                                                   ": absorption is given, so cdom and chlorophyll "
                                                   "are not used; remove one or the other"}));
}

TEST_F(UniformAbsorption, OfAPresetIsItsOwn) {
    const JerlovPreset& preset = jerlov_preset("jerlov-IB");  // measured from 412 to 555 nm
    WaterDesc water = basic_water();
    water.bands_nm = {620, 540, 450};
    EXPECT_EQ(absorption(water, &preset)[1], jerlov_absorption(preset, 540, 20, 35));
    // At 620 nm it exceeds pure water by 0.011 1/m, which a metre of water does not show.
    EXPECT_TRUE(warnings_.empty());
    water.bands_nm = {400, 540};
    absorption(water, &preset);
    ASSERT_EQ(warnings_.size(), 1U);
    // At 412 nm by 0.0434 less pure water's 0.0027 1/m: 4.0 % of the light per metre.
    EXPECT_NE(warnings_[0].find("at 400 nm the picture may be too dark or too bright by up to 4 % "
                                "per metre of water: jerlov-IB was measured from 412 to 555 nm"),
              std::string::npos)
        << warnings_[0];
}

TEST_F(UniformAbsorption, SaysWhereItsTablesEnd) {
    WaterDesc water = basic_water();
    water.bands_nm = {380, 540, 720};
    water.chlorophyll = 1;
    absorption(water);
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("bands 380, 720 nm: chlorophyll's absorption is known from 400"),
              std::string::npos)
        << warnings_[0];
    water.bands_nm = {550, 1064, 200};
    EXPECT_EQ(test::message_of<InputError>([&] { absorption(water); }),
              water.where +
                  ": bands 1064, 200 nm: the absorption of pure water is known from 300 to 900 nm; "
                  "choose bands within that range, or give the absorption");
}

}  // namespace
}  // namespace uw
