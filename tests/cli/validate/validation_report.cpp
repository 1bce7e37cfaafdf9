// ctest labels: unit
#include "cli/validate/validation_report.h"

#include <gtest/gtest.h>

namespace uw::test {
namespace {

LightValidation light_with(double deviation) {
    LightValidation light;
    light.name = "scene, all light";
    light.notes = {"a note"};
    light.bands_nm = {540};
    light.checks = {{"volume", "path", "multiple.surface, 540 nm", deviation, 0.001, 0.02,
                     PixelSpread{96, 0.01, 0.9, 2.5}}};
    light.parts = {LightParts{{1, 2, 3, 6}}};
    light.pictures.emplace_back("all light", Preview(4, 3));
    return light;
}

TEST(LightTable, SaysHowFarApartTheMethodsAre) {
    const std::string text = light_table(light_with(0.002), false);
    for (const char* part :
         {"scene, all light", "a note", "volume - path", "multiple.surface, 540 nm", "+0.200 %",
          "0.100 %", "2.0", "1.00 %", "0.90", "2.5", "passed",
          "multiple.volume                25.0 %", "all light / single scattering   4.000"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(LightTable, IsRedWhereAnErrorIsExceeded) {
    const std::string text = light_table(light_with(0.005), true);
    EXPECT_NE(text.find("\033[31m"), std::string::npos) << text;
    EXPECT_NE(text.find("FAILED"), std::string::npos) << text;
}

TEST(ValidationReport, ShowsTheLightOnOnePage) {
    const std::string html = validation_page({}, {light_with(0.002)});
    for (const char* part : {"scene, all light: <span class=passed>", "data:image/png;base64,",
                             "<svg", "<td>multiple.volume</td>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace uw::test
