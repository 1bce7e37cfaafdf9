// ctest labels: unit
#include "cli/validate/validation_report.h"

#include <gtest/gtest.h>

#include "cli/validate/published_report.h"

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

/// A scene of 2 x 1 pixels, an edge of shadow in the rays of both, with one row that is
/// `everywhere` and one that is not.
SceneValidation edgy_scene(double rms) {
    SceneValidation scene;
    scene.name = "edges";
    scene.width = 2;
    scene.height = 1;
    scene.bands_nm = {540};
    scene.smooth = {0, 0};
    MethodImage image;
    image.direct = image.backscatter = {Spectrum{}, Spectrum{}};
    scene.images = {{"volume", image}, {"reference", image}};
    Check check{"volume", "reference", k_backscatter, 0, true, 2, 0.01};
    check.tolerance = 0.001;
    check.rms_tolerance = 0.003;
    scene.checks = {check, check};
    scene.checks[1].everywhere = false;
    scene.checks[1].pixels = 0;
    scene.checks[1].rms = rms;
    scene.planes = {{8, 0, 0}};
    return scene;
}

TEST(ValidationTable, RowsWithoutAPixelAreNotPassed) {
    const std::string text = validation_table(edgy_scene(0), false);
    EXPECT_NE(text.find("-  0.0000 %      0.1 %  not compared"), std::string::npos) << text;
    EXPECT_NE(text.find("1 of 2 rows has no pixel to compare"), std::string::npos) << text;
    EXPECT_EQ(text.find("  passed"), text.rfind("  passed")) << text;
    const std::string html = validation_page({edgy_scene(0)}, {});
    for (const char* part : {"<td>not compared</td>", "volume − reference: not compared",
                             "<p>1 of 2 rows has no pixel"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(ValidationTable, RowsWithoutAPixelStillFailByTheirRms) {
    EXPECT_TRUE(edgy_scene(0).passed());
    EXPECT_FALSE(edgy_scene(0.01).passed());
    EXPECT_NE(validation_table(edgy_scene(0.01), false).find("FAILED"), std::string::npos);
}

TEST(ValidationReport, ShowsTheLightOnOnePage) {
    const std::string html = validation_page({}, {light_with(0.002)});
    for (const char* part : {"scene, all light: <span class=passed>", "data:image/png;base64,",
                             "data:image/svg+xml;base64,", "<td>multiple.volume</td>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

PublishedComparison published_with(double ours) {
    PublishedFigure light{"Model & others", "Ed < at depth 5", 2, ours, 0.001, 0.02, 0.015};
    light.place = {"problem 9", "Ed", "optical depth", 5};
    PortPhotographs set;
    set.source = "a photograph";
    set.published_plain = 2;
    set.published_port = 1;
    set.port = {{1, 0}, {0, -1}};
    set.plain = {{2, 0}, {0, -2}};
    return {{light}, {set}};
}

TEST(PublishedReport, IsAPageToCite) {
    const std::string html = published_page(published_with(2.01));
    for (const char* part :
         {"1 figures", "<span class=passed>passed</span>, 1 of 1", "<td>Model &amp; others</td>",
          "<td>Ed &lt; at depth 5</td>", "+0.50 %", "±1.70 %", "data:image/svg+xml;base64,",
          "<td class=n>2</td><td class=n>2</td><td class=n>1</td><td class=n>1</td>", "cff-version",
          "doi:10.1364/AO.32.007484"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(html, published_page(published_with(2.01)));
    EXPECT_NE(published_page(published_with(3)).find("FAILED"), std::string::npos);
}

TEST(PublishedReport, PrintsATable) {
    EXPECT_NE(published_text(published_with(2.01), false).find("+0.50 %  ±1.70 %  passed"),
              std::string::npos)
        << published_text(published_with(2.01), false);
    EXPECT_NE(published_text(published_with(3), true).find("\033[31m"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
