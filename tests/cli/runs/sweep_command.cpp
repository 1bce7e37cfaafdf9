// ctest labels: unit analytic metamorphic
#include <gtest/gtest.h>

#include <csignal>

#include "core/base/csv_table.h"
#include "tests/support/cli_test.h"
#include "tests/support/xml_check.h"

namespace uw {
namespace {

class SweepCommand : public test::CliTest {
  protected:
    test::ProgramResult expect_runs(std::vector<std::string> arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    CsvTable table(const std::string& name) const { return {read(name), name}; }
};

TEST_F(SweepCommand, LightIsLinearInBrightness) {
    const auto result = expect_runs(
        {"sweep", "scene.yaml", "--set", "lamps.left.intensity=10:40:10", "--part", "0,0,10,19"});
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("wrote scene-sweep.csv\nwrote scene-sweep.svg\n"), std::string::npos)
        << result.err;
    const CsvTable all = table("scene-sweep.csv");
    EXPECT_EQ(all.columns()[0], "lamps.left.intensity");
    for (const char* part : {"image", "part"}) {
        const CsvTable rows = all.where("part", part);
        EXPECT_EQ(rows.numbers("lamps.left.intensity"), (std::vector<double>{10, 20, 30, 40}));
        for (const char* column : {"direct_mean", "backscatter_p95", "irradiance_mean"}) {
            const std::vector<double> values = rows.numbers(column);
            for (std::size_t i = 0; i < 4; ++i)  // films hold 32-bit floats
                EXPECT_NEAR(values[i], static_cast<double>(i + 1) * values[0], 1e-6 * values[i])
                    << column;
        }
        const std::vector<double> contrast = rows.numbers("contrast");
        for (const double value : contrast) EXPECT_NEAR(value, contrast[0], 1e-6);
    }
    EXPECT_EQ(test::xml_fault(read("scene-sweep.svg")), "");
}

TEST_F(SweepCommand, MeasuresWhatRenderMeasures) {
    expect_runs({"sweep", "scene.yaml", "--set", "lamps.left.position[0]=-0.6:-0.2:0.2", "--object",
                 "box", "-o", "s.csv", "--quiet"});
    expect_runs({"render", "scene.yaml", "--set", "lamps.left.position[0]=-0.4", "--object", "2",
                 "--quality", "draft", "-o", "r.exr", "--numbers", "r.csv", "--quiet"});
    const CsvTable sweep = table("s.csv").where("lamps.left.position[0]", "-0.4");
    const CsvTable render = table("r.csv").where("lamp", "all");
    ASSERT_EQ(sweep.row_count(), 2U);
    for (const std::string& column : render.columns())
        if (column != "image" && column != "frame" && column != "lamp") {
            EXPECT_EQ(sweep.text(column), render.text(column)) << column;
        }
}

TEST_F(SweepCommand, TwoAxesACompanionAndATarget) {
    expect_runs({"sweep", "scene.yaml", "--set", "lamps.left.position[0]=-0.6:-0.2:0.2", "--set",
                 "water.scattering.b=0.1:0.2:0.1", "--with", "lamps.left.position[1]=0.3:0.1:0.1",
                 "--target", "2", "-o", "s.csv", "--size", "16x9", "--quiet"});
    const CsvTable rows = table("s.csv");
    EXPECT_EQ(rows.numbers("lamps.left.position[0]"),
              (std::vector<double>{-0.6, -0.4, -0.2, -0.6, -0.4, -0.2}));
    EXPECT_EQ(rows.numbers("water.scattering.b"),
              (std::vector<double>{0.1, 0.1, 0.1, 0.2, 0.2, 0.2}));
    EXPECT_EQ(rows.numbers("lamps.left.position[1]"),
              (std::vector<double>{0.3, 0.2, 0.1, 0.3, 0.2, 0.1}));
    const std::vector<double> contrast = rows.numbers("target_contrast");
    const std::vector<double> signal = rows.numbers("target_signal"),
                              backscatter = rows.numbers("target_backscatter");
    for (std::size_t i = 0; i < 6; ++i)  // black and white; nine digits are written
        EXPECT_NEAR(contrast[i], signal[i] / (signal[i] + 2 * backscatter[i]), 1e-8);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(contrast[i], contrast[i + 3]);
    EXPECT_NE(read("s.svg").find(">0.1<"), std::string::npos);  // a curve for each value
}

TEST_F(SweepCommand, ClearWaterHasNoBackscatter) {
    expect_runs({"sweep", "scene.yaml", "--set", "lamps.left.position[0]=-0.6:-0.2:0.4", "--set",
                 "water.scattering.b=0", "-o", "s.csv"});
    EXPECT_EQ(table("s.csv").text("signal_to_backscatter"),
              (std::vector<std::string>{"inf", "inf"}));
}

TEST_F(SweepCommand, CtrlCKeepsWhatWasMeasured) {
    test::Program program({"sweep", "scene.yaml", "--set", "lamps.left.intensity=1:1000:1", "-o",
                           "s.csv", "--size", "320x200"},
                          {.folder = folder_.path()});
    program.wait_for("left");  // the first line of progress
    program.signal(SIGINT);
    const test::ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_NE(result.err.find("of 1000 pictures are measured"), std::string::npos) << result.err;
    const std::size_t rows = table("s.csv").row_count();
    EXPECT_GT(rows, 0U);
    EXPECT_LT(rows, 1000U);
    EXPECT_NE(read("s.svg").find("interrupted"), std::string::npos);
}

TEST_F(SweepCommand, RefusesInOneLine) {
    const std::string range = "lamps.left.intensity=10:40:10";
    expect_failure({"sweep", "scene.yaml"}, 2, "--set is required");
    expect_failure({"sweep", "scene.yaml", "--set", "lamps.left.intensity=10"}, 2,
                   "vary one or two, such as lamps.left.position[0]=-1.2:-0.2:0.2");
    expect_failure({"sweep", "scene.yaml", "--set", "lamps.left.intensty=10:40:10"}, 3,
                   "did you mean 'intensity'?");
    // Wrong for the last of the values only: nothing is rendered.
    expect_failure({"sweep", "scene.yaml", "--set", "lamps.left.profile.beam=100:500:100"}, 3,
                   "profile.beam");
    expect_failure({"sweep", "scene.yaml", "--set", range, "--with", "camera.x=1:2:1"}, 2,
                   "has 2 values, but lamps.left.intensity has 4");
    expect_failure({"sweep", "scene.yaml", "--set", range, "--object", "ball"}, 2,
                   "the scene has 1 (plane), 2 (box)");
    expect_failure({"sweep", "scene.yaml", "--set", range, "--part", "0,0,40,10"}, 2,
                   "not a part of the pixels 0,0,33,19");
    expect_failure({"sweep", "scene.yaml", "--set", range, "-o", "out.png"}, 2, "ends in .csv");
    expect_failure({"sweep", "scene.yaml", "--set", range, "-o", "scene.yaml/out.csv"}, 4,
                   "not a folder");
    EXPECT_EQ(file_count(), 1U);
}

}  // namespace
}  // namespace uw
