// ctest labels: analytic
// The sheet to print: its file is a PDF, and what it draws is a board that is found in it, with
// squares of the size that it states.
#include "fit/target_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "fit/board_corners.h"
#include "tests/support/cli_test.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

constexpr double k_pdf_points_per_mm = 72 / 25.4;

struct DrawnRectangle {
    double grey = 0, x = 0, y = 0, width = 0, height = 0;  // [mm], y up from the lower edge
};

/// The rectangles of a page, each by "grey g x y width height re f".
std::vector<DrawnRectangle> rectangles_of(const std::string& pdf) {
    std::vector<DrawnRectangle> rectangles;
    std::istringstream lines(pdf);
    for (std::string line; std::getline(lines, line);) {
        DrawnRectangle r;
        std::string g, re, f;
        std::istringstream words(line);
        if (!(words >> r.grey >> g >> r.x >> r.y >> r.width >> r.height >> re >> f) || g != "g" ||
            re != "re")
            continue;
        for (double* const length : {&r.x, &r.y, &r.width, &r.height})
            *length /= k_pdf_points_per_mm;
        rectangles.push_back(r);
    }
    return rectangles;
}

/// What a printer of two dots per millimetre makes of them, seen from above.
Preview printed_sheet(const std::vector<DrawnRectangle>& rectangles, double width, double height) {
    constexpr double k_dots = 2;
    Preview sheet(static_cast<int>(width * k_dots), static_cast<int>(height * k_dots));
    for (int y = 0; y < static_cast<int>(height * k_dots); ++y)
        for (int x = 0; x < static_cast<int>(width * k_dots); ++x) sheet(x, y) = {255, 255, 255};
    for (const DrawnRectangle& r : rectangles) {
        const auto shade = static_cast<std::uint8_t>(std::lround(255 * r.grey));
        const auto dot = [&](double mm) { return static_cast<int>(std::lround(mm * k_dots)); };
        for (int y = dot(height - r.y - r.height); y < dot(height - r.y); ++y)
            for (int x = dot(r.x); x < dot(r.x + r.width); ++x) sheet(x, y) = {shade, shade, shade};
    }
    return sheet;
}

class FitTarget : public CliTest {
  protected:
    std::string written(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"fit", "--target", "sheet.pdf", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read("sheet.pdf");
    }
};

// ISO 32000-1, 7.5: the last lines say where the table is, which says where each object begins.
TEST_F(FitTarget, IsAWellFormedFile) {
    const std::string pdf = written({});
    EXPECT_EQ(pdf.rfind("%PDF-1.", 0), 0U);
    EXPECT_TRUE(pdf.ends_with("\n%%EOF\n"));
    const std::size_t start = pdf.find("startxref\n");
    ASSERT_NE(start, std::string::npos);
    const std::string table = pdf.substr(std::stoul(pdf.substr(start + 10)));
    ASSERT_EQ(table.rfind("xref\n0 6\n0000000000 65535 f \n", 0), 0U);
    for (std::size_t i = 1; i <= 5; ++i) {
        constexpr std::size_t k_head = 9, k_entry = 20;
        const std::string entry = table.substr(k_head + k_entry * i, k_entry);
        EXPECT_EQ(entry.substr(10), " 00000 n \n");
        EXPECT_EQ(pdf.substr(std::stoul(entry), 8), std::to_string(i) + " 0 obj\n");
    }
    const std::size_t begin = pdf.find("stream\n") + 7;
    EXPECT_EQ(pdf.find("endstream") - begin, std::stoul(pdf.substr(pdf.find("/Length ") + 8)));
    // A4, lying.
    EXPECT_NE(pdf.find("/MediaBox [0 0 841.8898 595.2756]"), std::string::npos);
    EXPECT_NE(pdf.find("--board 9x6x0.023"), std::string::npos);
}

TEST_F(FitTarget, HasABoardThatIsFound) {
    struct Sheet {
        std::vector<std::string> options;
        double width, height;
        BoardDesc board;
    };
    for (const Sheet& sheet :
         {Sheet{{}, 297, 210, {9, 6, 0.023}}, Sheet{{"--paper", "a3"}, 420, 297, {9, 6, 0.035}},
          Sheet{{"--paper", "letter", "--board", "7x5x0.02"}, 279.4, 215.9, {7, 5, 0.02}}}) {
        const std::vector<DrawnRectangle> rectangles = rectangles_of(written(sheet.options));
        for (const DrawnRectangle& r : rectangles) {
            EXPECT_GT(std::min(r.x, r.y), 5);  // what printers leave white
            EXPECT_LT(r.x + r.width, sheet.width - 5);
            EXPECT_LT(r.y + r.height, sheet.height - 5);
        }
        // The ruler is 100 mm, to what is written of its coordinates.
        EXPECT_TRUE(std::ranges::any_of(
            rectangles, [](const auto& r) { return std::abs(r.width - 100) < 1e-3; }));
        const TempDir folder;
        write_png(folder / "sheet.png", printed_sheet(rectangles, sheet.width, sheet.height), {});
        const PointTable found =
            find_board_corners({folder / "sheet.png"}, sheet.board, [](const std::string&) {});
        const auto columns = static_cast<std::size_t>(sheet.board.columns);
        ASSERT_EQ(found.points.size(), columns * static_cast<std::size_t>(sheet.board.rows));
        // Two dots per millimetre; the detector is good to a tenth of a dot.
        const double across = found.points[columns - 1].seen.x - found.points[0].seen.x;
        const double down = found.points.back().seen.y - found.points[0].seen.y;
        EXPECT_NEAR(std::abs(across), 2000 * sheet.board.square * (sheet.board.columns - 1), 0.2);
        EXPECT_NEAR(std::abs(down), 2000 * sheet.board.square * (sheet.board.rows - 1), 0.2);
    }
}

TEST_F(FitTarget, SaysWhatDoesNotFit) {
    const auto error = [&](const std::vector<std::string>& arguments) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 2);
        return result.err;
    };
    EXPECT_EQ(error({"fit", "--target", "sheet.pdf", "--board", "9x6x0.03"}),
              "uwvdb: --board 9x6x0.03: is 300 x 210 mm, and a4 has room for 241 x 164 mm; take "
              "another --paper, or --board 9x6x0.023\n");
    EXPECT_EQ(error({"fit", "--target", "sheet.pdf", "--paper", "a5"}),
              "uwvdb: --paper a5: did you mean 'a4'?\n");
    EXPECT_EQ(error({"fit", "--target", "sheet.OBJ"}),
              "uwvdb: --target sheet.OBJ: name a sheet to print SHEET.pdf, or its surface for "
              "scenes SHEET.obj\n");
    EXPECT_EQ(error({"fit", "rig.yaml", "--target", "sheet.pdf"}),
              "uwvdb: --target: writes a sheet to print, and fits nothing; leave the scene out\n");
    EXPECT_EQ(error({"fit"}),
              "uwvdb: fit: give the scene, as in 'uwvdb fit SCENE.yaml'; see 'uwvdb fit --help'\n");
    EXPECT_EQ(error({"fit", "rig.yaml", "--points", "corners.csv"}),
              "uwvdb: --unknown: give what to find, such as camera.port.distance; see 'uwvdb fit "
              "--help'\n");
}

}  // namespace
}  // namespace uw::test
