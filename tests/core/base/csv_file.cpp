// ctest labels: unit
#include "core/base/csv_table.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

constexpr auto k_entry = "scene.yaml:7:5: water.phase.file";

TEST(CsvFile, IsTheTableInIt) {
    const test::SceneFolder folder;
    const CsvTable table = read_csv_file(folder.write("t.csv", "x,y\n1,2\n"), k_entry);
    EXPECT_EQ(table.name(), "t.csv");  // what messages call it: the name without its folder
    EXPECT_EQ(table.numbers("y"), std::vector<double>{2});
}

TEST(CsvFile, ThatCannotBeReadIsNamedWithItsEntry) {
    const test::SceneFolder folder;
    const auto refusal = [](const std::filesystem::path& file) {
        return test::message_of<IoError>([&] { read_csv_file(file, k_entry); });
    };
    const std::filesystem::path none = folder.path() / "none.csv";
    EXPECT_EQ(refusal(none), std::string(k_entry) + ": " + none.string() +
                                 ": no such file; check the name of the table");
    EXPECT_EQ(refusal(folder.path()), std::string(k_entry) + ": " + folder.path().string() +
                                          ": is a folder; name the table in it");
}

TEST(CsvFile, TooLargeForATableIsRefused) {
    const test::SceneFolder folder;
    const std::string comment = "#" + std::string((4 << 20) - 9, ' ') + "\n";
    EXPECT_EQ(read_csv_file(folder.write("full.csv", comment + "x\n1\n2\n"), k_entry).row_count(),
              2U);
    const auto file = folder.write("large.csv", comment + "x\n1\n2\n33\n");
    const std::string message = test::message_of<InputError>([&] { read_csv_file(file, k_entry); });
    EXPECT_EQ(message, std::string(k_entry) + ": " + file.string() +
                           ": is larger than 4 MiB; this is not a valid table");
}

TEST(CsvFile, ContentThatIsNoTableIsRefused) {
    const test::SceneFolder folder;
    EXPECT_THROW(read_csv_file(folder.write("empty.csv", ""), k_entry), InputError);
    EXPECT_THROW(read_csv_file(folder.write("binary.csv", std::string(5000, '\0')), k_entry),
                 InputError);
}

}  // namespace
}  // namespace uw
