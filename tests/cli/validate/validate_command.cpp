// ctest labels: analytic
#include "cli/validate/validate_command.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/temp_dir.h"

namespace uw::test {
namespace {

constexpr const char* k_few_pixels = "camera.resolution=[12,7]";

class Validate : public ::testing::Test {
  protected:
    Validate() {
        arguments_.quiet = true;
        arguments_.scene = std::string(UWVDB_SOURCE_DIR) + "/assets/scenes/uniform.yaml";
        // The light of a spot is splatted four times as fast as that of the example's wide lamp,
        // with which built_in_suite.cpp runs.
        arguments_.overrides = {k_few_pixels,
                                "lamps.right.profile={type: spot, beam: 60, edge: 5}"};
    }
    void scatter_forward(const std::string& shape) {
        arguments_.overrides.push_back(
            "water.forward_scatter={K: 1, G: 0.02, B: 0.1, shape: " + shape + "}");
    }
    TempDir dir_;
    ValidateArguments arguments_;
    std::ostringstream out_;
};

TEST_F(Validate, SaysInRedWhatIsNotWithinTheTolerance) {
    arguments_.tolerance = 1e-6;  // less than quadrature is required to reach
    EXPECT_FALSE(run_validate(arguments_, true, out_));
    const std::string text = out_.str();
    EXPECT_NE(text.find("validation FAILED"), std::string::npos);
    const std::size_t red = text.find("\033[31m");
    ASSERT_NE(red, std::string::npos);
    const std::string line = text.substr(red, text.find('\n', red) - red);
    EXPECT_NE(line.find("FAILED"), std::string::npos);
    EXPECT_EQ(line.substr(line.size() - 4), "\033[0m");
}

// With a Gaussian it passes where the page is written, below.
TEST_F(Validate, PassesWithExponentialForwardScatter) {
    arguments_.quiet = false;
    scatter_forward("exponential");
    EXPECT_TRUE(run_validate(arguments_, false, out_)) << out_.str();
    EXPECT_NE(out_.str().find("volume - direct sum"), std::string::npos);
    EXPECT_NE(out_.str().find("blurred backscatter"), std::string::npos);
}

// In water that does not scatter in one band: how much it scatters cannot measure the blur in a VDB
// then.
TEST_F(Validate, WritesOnePageThatNeedsNothingElse) {
    arguments_.report = dir_ / "report.html";
    scatter_forward("gaussian");
    arguments_.overrides.emplace_back(
        "water.scattering={b: [0.2, 0, 0.25], phase: {type: hg, g: 0.9}}");
    EXPECT_TRUE(run_validate(arguments_, false, out_)) << out_.str();
    EXPECT_EQ(out_.str(), "");  // quiet
    std::ifstream in(arguments_.report);
    const std::string html{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(html.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(html.find("data:image/svg+xml;base64,"), std::string::npos);
    EXPECT_NE(html.find("Pictures with forward scatter"), std::string::npos);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("src=\"http"), std::string::npos);
    EXPECT_EQ(html.find("href="), std::string::npos);
}

}  // namespace
}  // namespace uw::test
