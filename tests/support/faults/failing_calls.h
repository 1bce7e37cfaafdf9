#pragma once

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "cli/command.h"
#include "tests/support/cli_test.h"

namespace uw::test {

/// A command, the files that it writes and those of them whose content tells of the run itself.
struct FaultyRun {
    std::vector<std::string> command, outputs, times;
};

/// Runs in which calls to the system fail (tests/faults/failing_calls.cpp). The tests' program is
/// told where that library is by UWVDB_FAILING_CALLS.
class FailingCallsTest : public CliTest {
  protected:
    ~FailingCallsTest() override {
        for (const char* name : {"LD_PRELOAD", "UWVDB_FAIL", "UWVDB_FAIL_DONE"}) ::unsetenv(name);
    }

    struct Outcome {
        ProgramResult result;
        bool has_failed = false;  // a call, as the run came to it
    };
    Outcome run_with(const std::string& fault, const std::vector<std::string>& command) const {
        const TempDir elsewhere;
        const std::string done = (elsewhere / "done").string();
        ::setenv("LD_PRELOAD", UWVDB_FAILING_CALLS, 1);
        ::setenv("UWVDB_FAIL", fault.c_str(), 1);
        ::setenv("UWVDB_FAIL_DONE", done.c_str(), 1);
        Outcome outcome{run(command), false};
        ::unsetenv("LD_PRELOAD");
        outcome.has_failed = std::filesystem::exists(done);
        return outcome;
    }

    /// Fails the n-th call of a kind, for every n that the run comes to (beyond 40 for some), and
    /// returns how many there are, up to 40 exactly. Each time the program has to end with one of
    /// `exit_codes`, 0 silently and the others with one line, and to leave the files that were
    /// there before or, whole, those of a run without faults, and nothing else: all new ones where
    /// it says 0, none where it was interrupted.
    int fail_each(const FaultyRun& faulty, const std::string& kind,
                  const std::vector<int>& exit_codes) const {
        put_precious_files(faulty);
        const std::size_t files = file_count();
        EXPECT_EQ(run(faulty.command).exit_code, 0);
        std::map<std::string, std::string> whole;
        for (const std::string& name : faulty.outputs) whole[name] = read(name);
        // Pages with pictures take thousands of writes, of which the later ones are alike.
        constexpr int k_all_of = 40, k_most = 100'000;
        for (int n = 1; n < k_most; n += n < k_all_of ? 1 : n / 4) {
            SCOPED_TRACE(kind + ":" + std::to_string(n));
            put_precious_files(faulty);
            const Outcome outcome = run_with(kind + ":" + std::to_string(n), faulty.command);
            if (!outcome.has_failed) return n - 1;
            const ProgramResult& result = outcome.result;
            EXPECT_TRUE(std::ranges::find(exit_codes, result.exit_code) != exit_codes.end())
                << result.exit_code << ": " << result.err;
            EXPECT_EQ(line_count(without_notices(result.err)), result.exit_code == 0 ? 0 : 1)
                << result.err;
            EXPECT_EQ(file_count(), files);
            const std::size_t replaced = expect_precious_or_whole(faulty, whole);
            if (result.exit_code == 0) {
                EXPECT_EQ(replaced, faulty.outputs.size());
            } else if (result.exit_code == k_exit_interrupted) {
                EXPECT_EQ(replaced, 0U);
            }
        }
        ADD_FAILURE() << "more than " << k_most << " calls";
        return k_most;
    }

    std::map<std::string, std::string> files_in(const std::string& folder) const {
        namespace fs = std::filesystem;
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / folder))
            if (entry.is_regular_file()) {
                const std::string name = fs::relative(entry.path(), folder_.path()).string();
                files[name.substr(folder.size() + 1)] = read(name);
            }
        return files;
    }
    /// How many files are in the folder `part`, if it is there: each has to be one of `whole`.
    std::size_t expect_whole(const std::string& part, const std::string& whole) const {
        if (!exists(part)) return 0;
        const auto all = files_in(whole), there = files_in(part);
        for (const auto& [name, content] : there) {
            const auto expected = all.find(name);
            EXPECT_TRUE(expected != all.end() && content == expected->second) << name;
        }
        return there.size();
    }

  private:
    static constexpr auto k_precious = "precious";

    /// `uwvdb water` has no --quiet and says what it has written before.
    static std::string without_notices(const std::string& lines) {
        std::string others, line;
        for (std::istringstream in(lines); std::getline(in, line);)
            if (!line.starts_with("wrote ")) others += line + "\n";
        return others;
    }
    void put_precious_files(const FaultyRun& faulty) const {
        for (const std::string& name : faulty.outputs) write(name, k_precious);
    }
    /// How many files are new.
    std::size_t expect_precious_or_whole(const FaultyRun& faulty,
                                         const std::map<std::string, std::string>& whole) const {
        std::size_t replaced = 0;
        for (const std::string& name : faulty.outputs) {
            const std::string now = read(name);
            if (now == k_precious) continue;
            ++replaced;
            if (std::ranges::find(faulty.times, name) == faulty.times.end())
                EXPECT_TRUE(now == whole.at(name)) << name;
            else
                EXPECT_TRUE(now.ends_with(whole.at(name).substr(whole.at(name).size() - 2)))
                    << name;
        }
        return replaced;
    }
};

}  // namespace uw::test
