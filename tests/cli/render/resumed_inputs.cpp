// ctest labels: unit slow
// --resume keeps no image whose inputs have changed, whichever key or file names them.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"
#include "tests/support/named_files.h"

namespace uw {
namespace {

class ResumedInputs : public test::CliTest {
  protected:
    void expect_noticed(const test::NamedFileCase& of) const {
        SCOPED_TRACE(of.key);
        const std::filesystem::path given = folder_ / "given";
        std::filesystem::remove_all(given);
        std::filesystem::create_directories((given / of.file).parent_path());
        write("given/s.yaml", of.scene(of.file));
        write("given/" + of.file, of.bytes);
        for (const auto& [file, text] : of.others) {
            std::filesystem::create_directories((given / file).parent_path());
            write("given/" + file, test::NamedFileCase::with_name(text, of.file));
        }
        std::vector<std::string> render{"render", "given/s.yaml"};
        for (const std::string& word : of.arguments(of.file)) render.push_back(word);
        if (of.options.empty())
            render.insert(render.end(), {"--frames", "1", "-o", "given/out.#.exr"});
        else
            render.insert(render.end(), {"-o", "given/out.{variation}.exr"});
        const test::ProgramResult first = run(render);
        ASSERT_EQ(first.exit_code, 0) << first.err;
        render.emplace_back("--resume");
        const test::ProgramResult kept = run(render);
        ASSERT_EQ(kept.exit_code, 0) << kept.err;
        EXPECT_NE(kept.err.find("there already, 0"), std::string::npos) << kept.err;
        if (of.changed.empty())
            std::filesystem::last_write_time(
                given / of.file,
                std::filesystem::file_time_type::clock::now() + std::chrono::seconds(2));
        else
            write("given/" + of.file, of.changed);
        const test::ProgramResult again = run(render);
        ASSERT_EQ(again.exit_code, 0) << again.err;
        EXPECT_EQ(again.err.find("there already"), std::string::npos) << again.err;
    }
};

TEST_F(ResumedInputs, AreNoticedWhenTheyChange) {
    for (const test::NamedFileCase& of : test::named_file_cases()) expect_noticed(of);
}

}  // namespace
}  // namespace uw
