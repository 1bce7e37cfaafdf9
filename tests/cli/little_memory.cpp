// ctest labels: unit
// A machine, or a share of one, with little memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/support/cli_test.h"

namespace uw::test {
namespace {

class LittleMemory : public CliTest {
  protected:
    /// The program has 2 GB of address space for all that it is and does.
    ProgramResult run_in_2_gb(const std::vector<std::string>& arguments) const {
        struct Restore {
            rlimit limit{};
            Restore() { ::getrlimit(RLIMIT_AS, &limit); }
            ~Restore() { ::setrlimit(RLIMIT_AS, &limit); }
        } const restore;
        const rlimit little{2'000'000'000, restore.limit.rlim_max};
        ::setrlimit(RLIMIT_AS, &little);
        return run(arguments);
    }
};

TEST_F(LittleMemory, RendersWhatFits) {
    const ProgramResult result = run_in_2_gb(
        {"render", "scene.yaml", "-o", "out.exr", "--layers", "all", "--threads", "2", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

// Before anything is rendered, by what is left of the 2 GB, whatever the machine has.
TEST_F(LittleMemory, RefusesWhatDoesNot) {
    const ProgramResult result = run_in_2_gb({"render", "scene.yaml", "-o", "out.exr", "--size",
                                              "6000x4000", "--layers", "all", "--quiet"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("but only 1."), std::string::npos) << result.err;
    EXPECT_FALSE(exists("out.exr"));
}

}  // namespace
}  // namespace uw::test
