// ctest labels: unit slow
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

/// Runs in which the n-th call of a kind fails (tests/faults/failing_calls.cpp), for every n that
/// the run comes to, over files that were there before.
class FailingCalls : public test::CliTest {
  protected:
    ~FailingCalls() override {
        for (const char* name : {"LD_PRELOAD", "UWVDB_FAIL", "UWVDB_FAIL_DONE"}) ::unsetenv(name);
    }

    struct Outcome {
        test::ProgramResult result;
        bool has_failed = false;  // the call, as the run came to it
    };
    Outcome run_with(const std::string& fault) const {
        const test::TempDir elsewhere;
        const std::string done = (elsewhere / "done").string();
        ::setenv("LD_PRELOAD", UWVDB_FAILING_CALLS, 1);
        ::setenv("UWVDB_FAIL", fault.c_str(), 1);
        ::setenv("UWVDB_FAIL_DONE", done.c_str(), 1);
        Outcome outcome{run(k_command), false};
        ::unsetenv("LD_PRELOAD");
        outcome.has_failed = std::filesystem::exists(done);
        return outcome;
    }
    void put_precious_files() const {
        for (const std::string& name : k_outputs) write(name, k_precious);
    }
    /// Everything in the folder is what was put there or, whole, what a run without faults writes.
    void expect_no_harm(const std::map<std::string, std::string>& whole) const {
        EXPECT_EQ(file_count(), k_outputs.size() + 1);  // and the scene
        for (const std::string& name : k_outputs) {
            const std::string now = read(name);
            if (now == k_precious) continue;
            // Statistics tell times, and so differ.
            if (name == "out.json")
                EXPECT_TRUE(now.starts_with("{") && now.ends_with("}\n")) << name;
            else
                EXPECT_TRUE(now == whole.at(name)) << name;
        }
    }
    /// For all n: `exit_codes` are what the program may end with.
    int fail_each(const std::string& kind, const std::vector<int>& exit_codes) const {
        put_precious_files();
        EXPECT_EQ(run(k_command).exit_code, 0);
        std::map<std::string, std::string> whole;
        for (const std::string& name : k_outputs) whole[name] = read(name);
        constexpr int k_most = 200;
        for (int n = 1; n < k_most; ++n) {
            SCOPED_TRACE(kind + ":" + std::to_string(n));
            put_precious_files();
            const Outcome outcome = run_with(kind + ":" + std::to_string(n));
            if (!outcome.has_failed) return n - 1;
            const test::ProgramResult& result = outcome.result;
            EXPECT_TRUE(std::ranges::find(exit_codes, result.exit_code) != exit_codes.end())
                << result.exit_code << ": " << result.err;
            EXPECT_EQ(test::line_count(result.err), result.exit_code == 0 ? 0 : 1) << result.err;
            expect_no_harm(whole);
        }
        ADD_FAILURE() << "more than " << k_most << " calls";
        return k_most;
    }

    static constexpr auto k_precious = "precious";
    const std::vector<std::string> k_outputs{"out.exr", "out.png", "out.json", "out.csv",
                                             "out_ids.csv"};
    const std::vector<std::string> k_command{"render",  "scene.yaml", "-o",        "out.exr",
                                             "--stats", "out.json",   "--numbers", "out.csv",
                                             "--quiet", "--layers",   "all"};
};

TEST_F(FailingCalls, NothingIsLostWhereWritingFails) {
    EXPECT_GE(fail_each("write", {4}), 5);  // one for each file at least
}

TEST_F(FailingCalls, NothingIsLostWhereFilesCannotBeMade) {
    EXPECT_GE(fail_each("open", {4}), 5);
}

TEST_F(FailingCalls, NothingIsLostWhereRenamingFails) {
    EXPECT_EQ(fail_each("rename", {4}), 5);
}

// Where there is not enough memory: refused, an error of one line, or done without.
TEST_F(FailingCalls, MemoryThatIsNotThere) {
    EXPECT_GE(fail_each("allocate", {0, 1, 3}), 1);
}

// Which Embree asks for; it must not be waited for where it gave up (EmbreeScene::commit).
TEST_F(FailingCalls, MemoryThatCannotBeMapped) {
    EXPECT_GE(fail_each("map", {0, 1, 3}), 5);
}

// Its work is done by the others, or Embree ends the run with a line where it has none.
TEST_F(FailingCalls, ThreadsThatCannotBeStarted) {
    EXPECT_GE(fail_each("thread", {0, 1}), 2);
}

}  // namespace
}  // namespace uw
