// ctest labels: statistical
#include "cli/validate/light_validation.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "cli/validate/validation_report.h"
#include "core/paths/path_tracer.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A box before a wall and a lamp beside the camera.
SceneDesc small_scene() {
    SceneDesc desc = pinhole_scene(32, 24);
    desc.geometry = {plane_at_z(3), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40)};
    desc.water.absorption = PerBand{0.3, 0.1, 0.1};
    desc.water.scattering = ScatteringDesc{{0.2, 0.2, 0.3}, {}};
    desc.water.scattering->phase.function = HenyeyGreensteinDesc{0.8};
    desc.render.scattering = RenderDesc::Scattering::multiple;
    return desc;
}

TEST(AllLight, OfTheFastFormIsThatOfLightPaths) {
    const LightValidation result = validate_all_light(small_scene(), "scene", {});
    EXPECT_TRUE(result.passed()) << light_table(result, false);
    EXPECT_EQ(result.checks.size(), 9U);
    ASSERT_EQ(result.parts.size(), 3U);
    for (const LightParts& parts : result.parts) EXPECT_GT(parts.ratio(), 1.2);
    const std::string text = light_table(result, false);
    EXPECT_NE(text.find("all light / single scattering"), std::string::npos);
    EXPECT_NE(text.find("multiple.surface, 450 nm"), std::string::npos);

    const TempDir dir;
    write_validation_report(dir / "report.html", {}, {result});
    std::ifstream in(dir / "report.html");
    const std::string html{std::istreambuf_iterator<char>(in), {}};
    for (const char* part : {"scene, all light: <span class=passed>", "data:image/png;base64,",
                             "<svg", "<td>multiple.volume</td>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

// By light paths in water that scatters a tenth more than the scene's.
TEST(AllLight, IsFoundWrongWhereTheFastFormIs) {
    SceneDesc murky = small_scene();
    for (double& b : murky.water.scattering->b) b *= 1.1;
    Renderer other;
    other.set_scene(std::move(murky));
    ValidationOptions options;
    options.volume = [&other](LightTransport transport) {
        transport.paths = std::make_shared<PathTracer>(other.assemble().lit());
        return transport;
    };
    const LightValidation result = validate_all_light(small_scene(), "scene", options);
    EXPECT_FALSE(result.passed()) << light_table(result, false);
}

TEST(AllLight, IsFoundMissingWhereThereIsNone) {
    ValidationOptions options;
    options.volume = [](LightTransport transport) {
        transport.paths = nullptr;
        return transport;
    };
    EXPECT_FALSE(validate_all_light(small_scene(), "scene", options).passed());
}

}  // namespace
}  // namespace uw::test
