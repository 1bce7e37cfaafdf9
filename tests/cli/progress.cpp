// ctest labels: unit
#include "cli/console.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "cli/command.h"
#include "core/base/json.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

class ProgressBar : public test::CliTest {};

TEST_F(ProgressBar, FitsTheTerminalAndDrawsOverItself) {
    for (const int columns : {80, 40, 12}) {
        const test::ProgramResult result =
            run({"render", "scene.yaml", "--size", "132x76", "--integrator", "reference"}, columns);
        EXPECT_EQ(result.exit_code, 0);
        // What the image leaves out is said once the bar is done.
        const std::size_t note = result.err.find("note: single scattering leaves out about");
        ASSERT_NE(note, std::string::npos) << result.err;
        const std::string bars = result.err.substr(0, note);
        ASSERT_EQ(bars.find("\rrender"), 0U) << bars;
        std::size_t drawn = 0;
        for (std::size_t at = 0; at + 1 < bars.size() && bars[at] == '\r'; ++drawn) {
            const std::size_t end = std::min(bars.find('\r', at + 1), bars.size());
            // One column stays free: text in the last one may wrap.
            EXPECT_LT(end - at - 1, static_cast<std::size_t>(columns)) << bars.substr(at, end - at);
            at = end;
        }
        EXPECT_GE(drawn, 2U);
        if (columns < 80) continue;
        EXPECT_NE(bars.find("[==="), std::string::npos) << bars;
        EXPECT_NE(bars.find("100 %"), std::string::npos) << bars;
    }
}

TEST_F(ProgressBar, IsNotShownWhenQuiet) {
    const test::ProgramResult result = run(
        {"render", "scene.yaml", "--size", "132x76", "--integrator", "reference", "--quiet"}, 80);
    EXPECT_EQ(result.err, "");
}

TEST_F(ProgressBar, IsAlsoLinesOfJsonForPrograms) {
    for (const int columns : {0, 80}) {  // a pipe, a terminal
        const test::ProgramResult result =
            run({"render", "scene.yaml", "--size", "132x76", "--quiet", "--integrator", "reference",
                 "--progress", "json"},
                columns);
        EXPECT_EQ(result.exit_code, 0);
        std::istringstream lines(result.err);
        int count = 0;
        double before = 0;
        for (std::string text; std::getline(lines, text); ++count) {
            const Json line = Json::parse(text);
            EXPECT_EQ(line["stage"], "render") << text;
            const double fraction = line["fraction"];
            EXPECT_GE(fraction, before);
            EXPECT_LE(fraction, 1);
            EXPECT_GE(line["seconds_left"].get<double>(), 0);
            before = fraction;
        }
        EXPECT_GE(count, 2);
        EXPECT_EQ(before, 1);
    }
}

TEST_F(ProgressBar, HasNoOtherForms) {
    const test::ProgramResult result = run({"render", "scene.yaml", "--progress", "xml"});
    EXPECT_EQ(result.exit_code, k_exit_usage);
    EXPECT_EQ(result.err, "uwvdb: --progress xml: expected text or json\n");
}

TEST(Duration, IsShort) {
    EXPECT_EQ(format_duration(0), "0.0 s");
    EXPECT_EQ(format_duration(9.94), "9.9 s");
    EXPECT_EQ(format_duration(9.96), "10 s");
    EXPECT_EQ(format_duration(59.6), "1 min 00 s");
    EXPECT_EQ(format_duration(185), "3 min 05 s");
    EXPECT_EQ(format_duration(4320), "1 h 12 min");
}

}  // namespace
}  // namespace uw
