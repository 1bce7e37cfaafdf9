// ctest labels: unit
#include "cli/console.h"

#include <gtest/gtest.h>

#include <algorithm>

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
