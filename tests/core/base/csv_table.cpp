// ctest labels: unit
#include "core/base/csv_table.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using CsvNumbers = std::vector<double>;

constexpr std::string_view k_small_table =
    "# a comment, with commas, before the header\n"
    "nm, a ,b,kind\n"
    "400,0.5,1,water\n"
    "\n"
    "# another\n"
    "500, ,2,ice\n"
    "600,1.5e-1,3,water\n";

std::string csv_error(std::string_view text) {
    return test::message_of<InputError>([&] { CsvTable(text, "t.csv"); });
}

TEST(CsvTable, ReadsColumnsByName) {
    const CsvTable table(k_small_table, "t.csv");
    EXPECT_EQ(table.name(), "t.csv");
    EXPECT_EQ(table.row_count(), 3U);
    EXPECT_EQ(table.columns(), (std::vector<std::string>{"nm", "a", "b", "kind"}));
    EXPECT_EQ(table.numbers("nm"), (CsvNumbers{400, 500, 600}));
    EXPECT_EQ(table.numbers("b"), (CsvNumbers{1, 2, 3}));
    EXPECT_EQ(table.text("a"), (std::vector<std::string>{"0.5", "", "1.5e-1"}));
}

TEST(CsvTable, CurvesLeaveBlankRowsOut) {
    const SampledCurve curve = CsvTable(k_small_table, "t.csv").curve("nm", "a");
    EXPECT_EQ(curve.x, (CsvNumbers{400, 600}));
    EXPECT_EQ(curve.y, (CsvNumbers{0.5, 0.15}));
}

TEST(CsvTable, SelectsRowsByValue) {
    const CsvTable water = CsvTable(k_small_table, "t.csv").where("kind", "water");
    EXPECT_EQ(water.numbers("nm"), (CsvNumbers{400, 600}));
    EXPECT_EQ(CsvTable(k_small_table, "t.csv").where("kind", "stone").row_count(), 0U);
}

TEST(CsvTable, ReadsWhatSpreadsheetsWrite) {
    const CsvTable table("\xEF\xBB\xBFx,y\r\n1,2\r\n3,4", "t.csv");  // a byte order mark, CR LF
    EXPECT_EQ(table.numbers("x"), (CsvNumbers{1, 3}));
    EXPECT_EQ(table.numbers("y"), (CsvNumbers{2, 4}));
}

TEST(CsvTable, SaysWhereAndWhat) {
    const CsvTable table("# c\nangle,phase\n0,1\n90,abc\n91,\n", "t.csv");
    EXPECT_EQ(test::message_of<InputError>([&] { table.numbers("phase"); }),
              "t.csv:4: 'abc' in column 'phase' is not a number; write it like 0.25 or 1.5e-3");
    EXPECT_EQ(test::message_of<InputError>([&] { table.text("angel"); }),
              "t.csv: no column 'angel'; the header names 'angle', 'phase'");
    EXPECT_EQ(csv_error("a,b\n1,2\n1,2,3\n"),
              "t.csv:3: 3 cells where the header names 2 columns; give one cell per column");
    EXPECT_EQ(csv_error("x,y\n"),
              "t.csv: no rows; a table is a line of comma-separated column names and lines of "
              "values");
}

TEST(CsvTable, NumbersAreFiniteAndWhole) {
    for (const char* cell : {"", "nan", "inf", "1e999", "1 2", "0x1", "1;5", "+1"}) {
        const CsvTable table(std::string("x,y\n1,") + cell + "\n", "t.csv");
        EXPECT_THROW(table.numbers("y"), InputError) << cell;
    }
}

TEST(CsvTable, CurvesAscend) {
    for (const char* rows : {"1,1\n1,2\n", "2,1\n1,2\n"}) {
        const CsvTable table(std::string("x,y\n") + rows, "t.csv");
        const std::string message = test::message_of<InputError>([&] { table.curve("x", "y"); });
        EXPECT_NE(message.find("t.csv:3: 'x' = 1 does not ascend"), std::string::npos) << message;
    }
    const CsvTable blank("x,y\n1,\n,2\n", "t.csv");
    EXPECT_EQ(test::message_of<InputError>([&] { blank.curve("x", "y"); }),
              "t.csv: no row has values in both columns 'x' and 'y'; fill them in");
}

TEST(CsvTable, QuotesGarbageBriefly) {
    const std::string garbage = "\x01\x02" + std::string(100, 'z');
    const CsvTable table("x,y\n1," + garbage + "\n", "t.csv");
    const std::string message = test::message_of<InputError>([&] { table.numbers("y"); });
    EXPECT_NE(message.find("'??" + std::string(38, 'z') + "...'"), std::string::npos) << message;
}

TEST(CsvTable, RefusesWhatIsNoTableOfASpectrum) {
    std::string rows = "x\n";
    for (std::size_t i = 0; i < CsvTable::k_max_rows; ++i) rows += "1\n";
    EXPECT_EQ(CsvTable(rows, "t.csv").row_count(), CsvTable::k_max_rows);
    EXPECT_NE(csv_error(rows + "1\n").find("more than 20000 rows"), std::string::npos);
    EXPECT_NE(csv_error(std::string(CsvTable::k_max_columns, ',')).find("more than 256 columns"),
              std::string::npos);
}

TEST(CsvTable, EmbeddedTablesAreSortedAndWhole) {
    std::string_view last;
    for (const EmbeddedTable& embedded : embedded_tables()) {
        EXPECT_LT(last, embedded.name);
        last = embedded.name;
        EXPECT_TRUE(embedded.text.starts_with("#")) << embedded.name;
        EXPECT_GT(read_embedded_table(embedded.name).row_count(), 1U) << embedded.name;
    }
    EXPECT_THROW(read_embedded_table("none.csv"), std::logic_error);
}

}  // namespace
}  // namespace uw
