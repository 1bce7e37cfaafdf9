// ctest labels: unit
#include "cli/tools/water_command.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using Wavelengths = std::vector<double>;

TEST(BandList, KeepsItsOrder) {
    EXPECT_EQ(parse_bands("620,540.5,450"), (Wavelengths{620, 540.5, 450}));
    EXPECT_EQ(parse_bands("532"), Wavelengths{532});
    EXPECT_EQ(parse_bands("10,1e5"), (Wavelengths{10, 1e5}));
}

TEST(BandList, RangesEndAtOrBeforeTheirLast) {
    EXPECT_EQ(parse_bands("400:420:10"), (Wavelengths{400, 410, 420}));
    EXPECT_EQ(parse_bands("400:429.9:10"), (Wavelengths{400, 410, 420}));
    EXPECT_EQ(parse_bands("500:500:1"), Wavelengths{500});
    // A step that is no binary fraction still reaches the end.
    const Wavelengths tenths = parse_bands("400:401:0.1");
    EXPECT_EQ(tenths.size(), 11U);
    EXPECT_NEAR(tenths.back(), 401, 1e-9);
}

TEST(BandList, HasAtMostTwoThousand) {
    EXPECT_EQ(parse_bands("1000:2999:1").size(), 2000U);
    EXPECT_NE(test::message_of<UsageError>([] {
                  parse_bands("1000:3000:1");
              }).find("more than 2000 wavelengths; give a larger step"),
              std::string::npos);
    std::string list = "10";
    for (int i = 1; i <= 2000; ++i) list += "," + std::to_string(10 + i);
    EXPECT_THROW(parse_bands(list), UsageError);
}

TEST(BandList, RefusesInOneLine) {
    const auto refused = [](const std::string& text) {
        return test::message_of<UsageError>([&] { parse_bands(text); });
    };
    for (const char* text :
         {"", "green", "500,", ",500", "500 540", "9", "1e6", "nan", "-500", "500nm", "5OO"})
        EXPECT_NE(refused(text).find("give nanometres"), std::string::npos) << text;
    for (const char* text :
         {"400:700", "400:700:10:2", "400:700:0", "400:700:-1", "400:700:x", "400:700:1e-9"})
        EXPECT_NE(refused(text).find("a range is first:last:step"), std::string::npos) << text;
    EXPECT_NE(refused("700:400:10").find("the last wavelength is less than the first"),
              std::string::npos);
    EXPECT_NE(refused("500,540,500").find("a wavelength is given twice"), std::string::npos);
    EXPECT_EQ(refused("a\nb").substr(0, 12), "--bands a?b:");
}

}  // namespace
}  // namespace uw
