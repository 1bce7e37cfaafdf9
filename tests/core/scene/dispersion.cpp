// ctest labels: unit analytic
#include "core/scene/dispersion.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using Material = DispersionDesc::Material;

double index_of(const std::string& yaml, double nm) {
    const ConfigNode root = parse_yaml(yaml, "s.yaml");
    double number = 0;
    const auto material = read_index(ConfigValue(root, "n"), number);
    return material ? refractive_index(*material, nm) : number;
}

// The data sheet's own table of spectral lines, to its five decimals.
TEST(Dispersion, Bk7IsThatOfSchottsDataSheet) {
    const std::vector<std::array<double, 2>> lines{
        {1013.98, 1.50731},  {852.11, 1.50980},   {706.5188, 1.51289}, {656.2725, 1.51432},
        {632.8, 1.51509},    {587.5618, 1.51680}, {546.074, 1.51872},  {486.1327, 1.52238},
        {435.8343, 1.52668}, {404.6561, 1.53024}, {365.0146, 1.53627}};
    for (const auto& [nm, n] : lines) EXPECT_NEAR(index_of("bk7", nm), n, 5.5e-6) << nm;
}

// Malitson 1965, table II, computed values.
TEST(Dispersion, FusedSilicaIsMalitsons) {
    const std::vector<std::array<double, 2>> lines{
        {404.656, 1.469618}, {435.835, 1.466693}, {486.133, 1.463126}, {546.074, 1.460078},
        {587.561, 1.458464}, {656.272, 1.456367}, {706.520, 1.455145}};
    for (const auto& [nm, n] : lines) EXPECT_NEAR(index_of("fused-silica", nm), n, 1.5e-6) << nm;
}

// Measured by Malitson in 1962 at 24 deg C, before the formula; sapphire's index grows by 1.3e-5
// per degree.
TEST(Dispersion, SapphireIsWhatWasMeasured) {
    const std::vector<std::array<double, 2>> lines{{435.834, 1.78120},
                                                   {546.071, 1.77078},
                                                   {576.960, 1.76884},
                                                   {643.847, 1.76547},
                                                   {706.519, 1.76303}};
    for (const auto& [nm, n] : lines) EXPECT_NEAR(index_of("sapphire", nm), n, 1e-4) << nm;
}

// Sultanova et al. 2009, table 1: measured, to three decimals.
TEST(Dispersion, PlasticsAreWhatWasMeasured) {
    const std::vector<std::array<double, 3>> lines{
        {486.1, 1.497, 1.600}, {587.6, 1.491, 1.585}, {656.3, 1.489, 1.580}};
    for (const auto& [nm, pmma, polycarbonate] : lines) {
        EXPECT_NEAR(index_of("pmma", nm), pmma, 1.5e-3) << nm;
        EXPECT_NEAR(index_of("polycarbonate", nm), polycarbonate, 1.5e-3) << nm;
    }
    const auto abbe = [](const char* name) {
        return (index_of(name, 587.56) - 1) / (index_of(name, 486.13) - index_of(name, 656.27));
    };
    EXPECT_NEAR(abbe("pmma"), 57, 4.5);  // as in catalogues
    EXPECT_NEAR(abbe("polycarbonate"), 30, 2.5);
}

// Quan and Fry 1995, as tabulated from its coefficients for 35 PSU at 10 deg C.
TEST(Dispersion, WaterIsQuanAndFrys) {
    EXPECT_NEAR(water_refractive_index(400, 10, 35), 1.35085, 5.1e-6);
    EXPECT_NEAR(water_refractive_index(550, 10, 35), 1.34167, 5.1e-6);
    EXPECT_NEAR(water_refractive_index(700, 10, 35), 1.33735, 5.1e-6);
    EXPECT_NEAR(water_refractive_index(550, 20, 0), 1.33434, 5.1e-6);
    EXPECT_EQ(index_of("{salinity: 35, temperature: 10}", 550),
              water_refractive_index(550, 10, 35));
    // The CRC Handbook: pure water of 20 deg C against air, in sodium light.
    EXPECT_NEAR(water_refractive_index(589.3, 20, 0), 1.33299, 3e-5);
}

// Ciddor's air of 15 deg C at 633 nm: 1.000276517 (Ciddor 1996, table 1, dry, 450 ppm).
TEST(Dispersion, VacuumIsAirsReciprocal) {
    EXPECT_NEAR(1 / index_of("vacuum", 633), 1.000276517, 2e-8);
    EXPECT_EQ(index_of("air", 633), 1);
}

TEST(Dispersion, AbbesNumberIsItself) {
    const char* const glass = "{n_d: 1.62, abbe: 36.3}";
    EXPECT_NEAR(index_of(glass, 587.5618), 1.62, 1e-12);
    EXPECT_NEAR(0.62 / (index_of(glass, 486.1327) - index_of(glass, 656.2725)), 36.3, 1e-9);
    // BK7's dispersion to 2e-4 over the visible.
    for (const double nm : {420.0, 500.0, 700.0})
        EXPECT_NEAR(index_of("{n_d: 1.5168, abbe: 64.17}", nm), index_of("bk7", nm), 5e-4) << nm;
}

TEST(Dispersion, IsRefusedInOneLine) {
    for (const auto& [yaml, message] : std::vector<std::array<std::string, 2>>{
             {"bk8", "n: unknown value 'bk8'; did you mean 'bk7'?"},
             {"0.9", "n: must be from 1 to 3"},
             {"{n_d: 1.5}", "n: 'abbe' is missing"},
             {"{salinity: 35, abbe: 30}", "n.abbe: "},
             {"{salinity: 101}", "n.salinity: must be from 0 to 100"},
             {"[1.5]", "n: expected a number, found a list"}}) {
        const std::string found =
            test::message_of<InputError>([&, text = yaml] { (void)index_of(text, 550); });
        EXPECT_NE(found.find(message), std::string::npos) << yaml << ": " << found;
    }
}

TEST(Dispersion, IsWrittenAsItWasRead) {
    for (const char* yaml : {"vacuum", "bk7", "fused-silica", "sapphire", "pmma", "polycarbonate",
                             "{salinity: 12.5, temperature: 3}", "{n_d: 1.62, abbe: 36.3}",
                             "seawater", "{salinity: 0}"}) {
        const ConfigNode root = parse_yaml(yaml, "s.yaml");
        double number = 0;
        EXPECT_EQ(scene_text(read_index(ConfigValue(root, "n"), number).value()), yaml);
    }
}

const char* const k_dispersing = R"(uwvdb: 1
camera: {resolution: [64, 48], intrinsics: {fov_x: 60}, port: {n_glass: bk7, n_water: seawater}}
water: {bands: [620, 540, 450], absorption: 0.1, salinity: 20, temperature: 5}
lamps: [{name: a, position: [0, 1, 0], intensity: 1}]
)";

TEST(Dispersion, APortHasTheWaterOfItsSceneAndTheIndicesOfOneBand) {
    SceneDesc scene = read_scene_text(k_dispersing, "s.yaml", {});
    EXPECT_EQ(scene.camera.wavelength_nm, 540);
    const auto& port = std::get<FlatPortDesc>(*scene.camera.port);
    EXPECT_EQ(port.n_water, water_refractive_index(540, 5, 20));
    EXPECT_EQ(port.n_glass, index_of("bk7", 540));
    EXPECT_EQ(port.n_air, 1);
    EXPECT_TRUE(disperses(scene.camera));
    set_wavelength(scene.camera, 450);
    EXPECT_EQ(port.n_water, water_refractive_index(450, 5, 20));
    const SceneDesc own =
        read_scene_text(k_dispersing, "s.yaml", {"camera.port.n_water={temperature: 9}"});
    EXPECT_EQ(std::get<FlatPortDesc>(*own.camera.port).n_water, water_refractive_index(540, 9, 20));
}

TEST(Dispersion, NumbersAreTheSameAtAllWavelengths) {
    SceneDesc scene = read_scene_text(k_dispersing, "s.yaml",
                                      {"camera.port.n_glass=1.5", "camera.port.n_water=1.34"});
    EXPECT_FALSE(disperses(scene.camera));
    set_wavelength(scene.camera, 450);
    EXPECT_EQ(std::get<FlatPortDesc>(*scene.camera.port).n_water, 1.34);
}

TEST(Dispersion, BandsBeyondTheMaterialsAreRefused) {
    EXPECT_NE(test::message_of<InputError>([] {
                  (void)read_scene_text(k_dispersing, "s.yaml", {"water.bands=[250, 540, 620]"});
              }).find("port: indices by material are known from 300 to 1100 nm"),
              std::string::npos);
}

TEST(Dispersion, TheReferenceIsTheBandNearestTo550) {
    EXPECT_EQ(reference_wavelength(std::vector<double>{620, 540, 450}), 540);
    EXPECT_EQ(reference_wavelength(std::vector<double>{560, 540}), 560);
    EXPECT_EQ(reference_wavelength(std::vector<double>{800}), 800);
}

}  // namespace
}  // namespace uw
