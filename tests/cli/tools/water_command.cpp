// ctest labels: unit
#include "cli/tools/water_command.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "cli/command.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "media/water/water_types.h"
#include "tests/support/temp_dir.h"
#include "tests/support/xml_check.h"

namespace uw {
namespace {

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    EXPECT_TRUE(stream) << file;
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string printed(const WaterArguments& arguments) {
    std::stringstream out;
    run_water(arguments, out);
    return out.str();
}

// `words` behind `uwvdb water`, as arguments.
WaterArguments parsed(std::vector<const char*> words) {
    words.insert(words.begin(), {"uwvdb", "water"});
    WaterArguments arguments;
    std::vector<Command> commands;
    commands.push_back({"water", "", "", water_options(arguments), [] { return k_exit_done; }});
    EXPECT_EQ(read_command_line(static_cast<int>(words.size()), words.data(), commands)(),
              k_exit_done);
    return arguments;
}

std::string write_scene(const test::TempDir& folder, const std::string& water) {
    std::ofstream(folder / "scene.yaml") << "uwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: "
                                            "{fov_x: 60}}\nwater: "
                                         << water << "\n";
    return (folder / "scene.yaml").string();
}

TEST(WaterArguments, AsTyped) {
    EXPECT_EQ(parsed({}).subject, "");
    const WaterArguments a =
        parsed({"jerlov-II", "--set", "water.salinity=0", "--bands", "400:700:10", "--band", "550",
                "--csv", "out/x", "--svg", "x.svg", "--json"});
    EXPECT_EQ(a.subject, "jerlov-II");
    EXPECT_EQ(a.overrides, std::vector<std::string>{"water.salinity=0"});
    ASSERT_EQ(a.bands_nm.size(), 31U);
    EXPECT_EQ(a.bands_nm.front(), 400);
    EXPECT_EQ(a.bands_nm.back(), 700);
    EXPECT_EQ(a.band_nm, 550);
    EXPECT_EQ(a.csv, "out/x");
    EXPECT_TRUE(a.json);
    EXPECT_EQ(parsed({"--bands", "620,540.5,450"}).bands_nm,
              (std::vector<double>{620, 540.5, 450}));
    EXPECT_EQ(parsed({"--bands", "532"}).bands_nm, std::vector<double>{532});
    for (const char* bands :
         {"", "x", "400:700", "400:700:0", "700:400:10", "400:700:-1", "400:700:1e-9", "1,2",
          "500,500", "400:nan:1", "500,", "400:700:10:2", "inf", "620 540"}) {
        EXPECT_THROW(parsed({"--bands", bands}), UsageError) << bands;
    }
    EXPECT_THROW(parsed({"a", "b"}), UsageError);
    EXPECT_THROW(parsed({"--band", "green"}), UsageError);
}

TEST(WaterCommand, PrintsTablesWithUnitsAndSources) {
    const std::string pure = printed({});
    for (const char* text : {"pure sea water", "Roettgers", "Morel 1974", "[1/m]", "[1/(m sr)]",
                             "620", "beta(psi) at 450 nm"})
        EXPECT_NE(pure.find(text), std::string::npos) << text;
    WaterArguments a;
    a.subject = "Jerlov-ii";
    a.band_nm = 540;
    const std::string preset = printed(a);
    EXPECT_NE(preset.find("Williamson and Hollins"), std::string::npos);
    EXPECT_EQ(test::occurrences(preset, "beta(psi) at"), 1);
    a.json = true;
    const std::string json = printed(a);
    EXPECT_EQ(json.front(), '{');
    EXPECT_NE(json.find("\"wavelengths_nm\""), std::string::npos);
}

TEST(WaterCommand, SettingsNeedNoScene) {
    WaterArguments a;
    a.overrides = {"water.particles={small: 1, large: 2}", "water.bands=[550]"};
    const std::string text = printed(a);
    EXPECT_NE(text.find("1 ppm small, 2 ppm large"), std::string::npos);
    // b = water + 1.34 + 2 * 0.312 at 550 nm
    EXPECT_NE(text.find("1.966"), std::string::npos);
    a.overrides = {"camera.port=none"};
    EXPECT_THROW(printed(a), InputError);
    a.overrides = {"water.bnds=[550]"};
    EXPECT_THROW(printed(a), InputError);
}

// What is written is what the models say, and the project's own reader of tables reads it.
TEST(WaterCommand, FilesHoldTheNumbers) {
    const test::TempDir folder;
    WaterArguments a;
    a.overrides = {"water.particles={small: 0.03, large: 0.05}"};
    a.bands_nm = {450, 550, 650};
    a.csv = folder / "fig4.csv";
    a.svg = folder / "fig4.svg";
    printed(a);
    const CsvTable iop(read_file(folder / "fig4-coefficients.csv"), "coefficients");
    ASSERT_EQ(iop.row_count(), 3U);
    const auto at = [](const CsvTable& table, const char* column, std::size_t row) {
        return table.numbers(column)[row];
    };
    EXPECT_NEAR(at(iop, "a_per_m", 1), pure_water_absorption(550, 20, 35), 1e-9);
    const double b = water_scattering(550, 35) + 0.03 * 1.34 + 0.05 * 0.312;
    EXPECT_NEAR(at(iop, "b_per_m", 1), b, 1e-9);
    EXPECT_NEAR(at(iop, "b_small_per_m", 1), 0.03 * 1.34, 1e-9);
    EXPECT_NEAR(at(iop, "attenuation_length_m", 1), 1 / at(iop, "c_per_m", 1), 1e-7);
    const CsvTable vsf(read_file(folder / "fig4-vsf.csv"), "vsf");
    const CsvTable green = vsf.where("wavelength_nm", "550");
    ASSERT_EQ(green.row_count(), 199U);
    const CsvTable right_angle = green.where("angle_deg", "90");
    EXPECT_NEAR(at(right_angle, "water_per_m_per_sr", 0), water_vsf_90(550, 35), 1e-12);
    EXPECT_NEAR(at(right_angle, "total_per_m_per_sr", 0),
                at(right_angle, "water_per_m_per_sr", 0) +
                    at(right_angle, "small_per_m_per_sr", 0) +
                    at(right_angle, "large_per_m_per_sr", 0),
                2e-12);  // nine digits each
    const std::string svg = read_file(folder / "fig4.svg");
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const char* label : {">total<", ">water<", ">small<", ">large<", "at 550 nm"})
        EXPECT_GE(test::occurrences(svg, label), 1) << label;
}

TEST(WaterCommand, ScenesWithNumbersPerBand) {
    const test::TempDir folder;
    WaterArguments a;
    a.subject = write_scene(folder,
                            "{absorption: [0.3, 0.07, 0.03], scattering: {b: [0.2, 0.2, 0], "
                            "phase: {type: hg, g: 0.9}}}");
    a.svg = folder / "x.svg";
    EXPECT_NE(printed(a).find("henyey-greenstein g=0.9"), std::string::npos);
    EXPECT_EQ(test::xml_fault(read_file(folder / "x.svg")), "");
    a.bands_nm = {500};
    EXPECT_THROW(printed(a), UsageError);
    a.subject = write_scene(folder, "{absorption: 0, scattering: {b: 0, phase: {type: water}}}");
    a.bands_nm.clear();
    EXPECT_NE(printed(a).find("-"), std::string::npos);
    EXPECT_EQ(test::xml_fault(read_file(folder / "x.svg")), "");
}

TEST(WaterCommand, WhatCannotBeDoneLeavesNoFiles) {
    const test::TempDir folder;
    const auto refuses_and_leaves_nothing = [&](const WaterArguments& a) {
        std::stringstream out;
        EXPECT_ANY_THROW(run_water(a, out));
        EXPECT_EQ(out.str(), "");
        EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    };
    WaterArguments a;
    a.csv = folder / "x";
    a.svg = "/dev/null/x.svg";  // not a folder
    EXPECT_THROW(printed(a), IoError);
    refuses_and_leaves_nothing(a);
    a.svg = folder / "x.svg";
    a.band_nm = 555;
    EXPECT_THROW(printed(a), UsageError);
    refuses_and_leaves_nothing(a);
    a.band_nm.reset();
    a.subject = "jerlov-X";
    EXPECT_THROW(printed(a), UsageError);
    refuses_and_leaves_nothing(a);
    a.subject = "nowhere/scene.yaml";
    EXPECT_THROW(printed(a), IoError);
    refuses_and_leaves_nothing(a);
    a.subject.clear();
    a.bands_nm = {500, 1000};
    EXPECT_THROW(printed(a), InputError);
    refuses_and_leaves_nothing(a);
}

}  // namespace
}  // namespace uw
