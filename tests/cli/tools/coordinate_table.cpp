// ctest labels: unit
#include "cli/tools/points_commands.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

const std::vector<std::vector<std::string_view>> k_pixels{{"pixel_x", "pixel_y"}, {"x", "y"}};
const std::vector<std::vector<std::string_view>> k_points{{"x", "y", "z"}};

std::vector<double> all_of(const CoordinateTable& table) {
    std::vector<double> values;
    for (std::size_t row = 0; row < table.row_count(); ++row)
        values.insert(values.end(), table.coordinates(row).begin(), table.coordinates(row).end());
    return values;
}

std::string message_about(const std::string& text) {
    return test::message_of<InputError>([&] { CoordinateTable(text, "p.csv", k_points); });
}

TEST(CoordinateTable, ReadsItsColumnsWhereverTheyAre) {
    const CoordinateTable table(
        "\xEF\xBB\xBF# a comment\r\nname, Z,x ,y\r\n\r\na,3,1,2\r\n b, +6,4e0,5", "p.csv",
        k_points);
    EXPECT_EQ(all_of(table), (std::vector<double>{1, 2, 3, 4, 5, 6}));
    const CoordinateTable bare("1,2,3\n4,5,6\n", "p.csv", k_points);
    EXPECT_EQ(all_of(bare), (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

TEST(CoordinateTable, PrefersTheFirstSetOfNames) {
    const CoordinateTable both("x,y,pixel_y,pixel_x\n1,2,3,4\n", "p.csv", k_pixels);
    EXPECT_EQ(all_of(both), (std::vector<double>{4, 3}));
    const CoordinateTable plain("y,x,pixel_y\n1,2,3\n", "p.csv", k_pixels);
    EXPECT_EQ(all_of(plain), (std::vector<double>{2, 1}));
}

TEST(CoordinateTable, CarriesRowsAlongAsTheyAreWritten) {
    const CoordinateTable table("id,x,y,z\nleft,1.50,0,nan\nright,-0,1e-3,2\n", "p.csv", k_points);
    EXPECT_TRUE(std::isnan(table.coordinates(0)[2]));
    const auto append = [](std::size_t row, std::string& text) {
        text += "," + std::to_string(row);
    };
    EXPECT_EQ(table.with_columns({"row"}, append),
              "id,x,y,z,row\nleft,1.50,0,nan,0\nright,-0,1e-3,2,1\n");
    const CoordinateTable bare("1,2,3\n", "p.csv", k_points);
    EXPECT_EQ(bare.with_columns({"row"}, append), "x,y,z,row\n1,2,3,0\n");
    EXPECT_THROW(table.with_columns({"ID"}, append), InputError);
}

TEST(CoordinateTable, KeepsTheOrderOfManyRows) {
    std::string text = "x,y\n", expected = "x,y,row\n";
    for (int row = 0; row < 20000; ++row) {
        text += std::to_string(row) + ",0\n";
        expected += std::to_string(row) + ",0," + std::to_string(row) + "\n";
    }
    const CoordinateTable table(text, "p.csv", k_pixels);
    EXPECT_EQ(
        table.with_columns(
            {"row"}, [&](std::size_t row, std::string& out) { out += "," + std::to_string(row); }),
        expected);
}

TEST(CoordinateTable, SaysWhereATableIsWrong) {
    EXPECT_EQ(message_about("x,y,z\n1,2,3\n# more\n1,abc,3\n"),
              "p.csv:4: 'abc' in column 'y' is not a finite number; write it like 0.25 or 1.5e-3, "
              "or nan where there is none");
    EXPECT_TRUE(message_about("id,x,Y,z\na,1,,3\n").starts_with("p.csv:2: '' in column 'Y' "));
    EXPECT_TRUE(message_about("x,y,z\n1,2,inf\n").starts_with("p.csv:2: 'inf' in column 'z' "));
    EXPECT_EQ(message_about("x,y,z\n1,2\n"),
              "p.csv:2: 2 cells where there are 3 columns; give one cell per column");
    EXPECT_EQ(message_about("x,y\n1,2\n"),
              "p.csv:1: the columns x, y, z are needed, separated by commas; the first line names "
              "'x', 'y'");
    EXPECT_EQ(message_about("1 2 3\n4 5 6\n"),
              "p.csv:1: the columns x, y, z are needed, separated by commas; the first line names "
              "'1 2 3'");
    EXPECT_EQ(message_about("1,2,3,4\n"),
              "p.csv:1: 4 numbers without a header; name the columns in a first line, such as "
              "x,y,z, or leave those alone");
    EXPECT_EQ(message_about("x,y,z\n"),
              "p.csv: no rows; give a line that names the columns x, y, z, and a line for each "
              "point");
}

}  // namespace
}  // namespace uw
