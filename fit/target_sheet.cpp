#include "fit/target_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

// Lengths are in millimetres from the sheet's upper left corner, as the eye reads.
constexpr double k_margin = 10;         // that printers leave
constexpr double k_patch_width = 24;    // of the greys
constexpr double k_below_grey = 5;      // where its number stands
constexpr double k_gap = 12;            // white beside the board
constexpr double k_foot_height = 26;    // of the ruler and what stands beside it
constexpr double k_ruler_length = 100;  // for checking the scale
constexpr double k_points_per_mm = 72 / 25.4;
constexpr int k_columns = 10, k_rows = 7;  // squares, if nothing is said

const std::array<Paper, 3> k_papers{{{"a4", 297, 210}, {"a3", 420, 297}, {"letter", 279.4, 215.9}}};

/// The contents of a page, as PDF operators.
class PageContent {
  public:
    explicit PageContent(const Paper& paper) : height_(paper.height) {}

    /// `grey`: 0 black, 1 white.
    void rectangle(double x, double y, double width, double height, double grey) {
        operators_ += fmt::format("{:.4g} g {:.4f} {:.4f} {:.4f} {:.4f} re f\n", grey,
                                  x * k_points_per_mm, (height_ - y - height) * k_points_per_mm,
                                  width * k_points_per_mm, height * k_points_per_mm);
    }
    /// Beginning at x, on a line at y; `size` in points.
    void text(double x, double y, double size, const std::string& words) {
        std::string escaped;
        for (const char c : words) {
            if (c == '(' || c == ')' || c == '\\') escaped += '\\';
            escaped += c;
        }
        operators_ += fmt::format("0 g BT /F1 {:.4g} Tf {:.4f} {:.4f} Td ({}) Tj ET\n", size,
                                  x * k_points_per_mm, (height_ - y) * k_points_per_mm, escaped);
    }
    const std::string& operators() const { return operators_; }

  private:
    double height_;
    std::string operators_;
};

/// The file around a page's content: ISO 32000-1, 7.5.
std::string pdf_of(const Paper& paper, const PageContent& content) {
    const std::array<std::string, 5> objects{
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                    "/Resources << /Font << /F1 5 0 R >> >> >>",
                    paper.width * k_points_per_mm, paper.height * k_points_per_mm),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", content.operators().size(),
                    content.operators()),
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>"};
    std::string file = "%PDF-1.6\n";
    std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        table += fmt::format("{:010} 00000 n \n", file.size());
        file += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    const std::size_t start = file.size();
    return file + table +
           fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                       objects.size() + 1, start);
}

double room_across(const Paper& paper) {
    return paper.width - 2 * k_margin - k_gap - k_patch_width;
}
double room_down(const Paper& paper) {
    return paper.height - 2 * k_margin - k_foot_height;
}

/// A part of the sheet. `grey`: 0 black, 1 paper.
struct Patch {
    double x = 0, y = 0, width = 0, height = 0, grey = 0;
};

std::vector<Patch> squares_of(const BoardDesc& board, double side) {
    std::vector<Patch> patches;
    for (int row = 0; row <= board.rows; ++row)
        for (int column = 0; column <= board.columns; ++column)
            if ((row + column) % 2 == 0)
                patches.push_back({k_margin + side * column, k_margin + side * row, side, side, 0});
    return patches;
}

std::vector<Patch> greys_of(double left, double height) {
    constexpr int k_fifths = 5;
    const double step = height / (k_fifths + 1);
    std::vector<Patch> patches;
    for (int i = 0; i <= k_fifths; ++i)
        patches.push_back({left, k_margin + step * i, k_patch_width, step - k_below_grey,
                           static_cast<double>(i) / k_fifths});
    return patches;
}

/// The sheet's sizes, and that the board has room on it.
struct Sheet {
    Sheet(const BoardDesc& board, const Paper& paper)
        : side(1000 * board.square),
          height(side * (board.rows + 1)),
          greys_left(paper.width - k_margin - k_patch_width) {
        const double width = side * (board.columns + 1);
        if (width <= room_across(paper) && height <= room_down(paper)) return;
        const BoardDesc fitting = board_for(paper);
        throw UsageError(fmt::format(
            "--board {}x{}x{:.6g}: is {:.0f} x {:.0f} mm, and {} has room for {:.0f} x {:.0f} mm; "
            "take another --paper, or --board {}x{}x{:.6g}",
            board.columns, board.rows, board.square, width, height, paper.name, room_across(paper),
            room_down(paper), fitting.columns, fitting.rows, fitting.square));
    }
    double side, height, greys_left;  // height: of the board
};

void draw_foot(const BoardDesc& board, double side, double top, PageContent& page) {
    constexpr double k_line = 0.2;
    page.rectangle(k_margin, top, k_ruler_length, k_line, 0);
    for (int mm = 0; mm <= 100; mm += 10)
        page.rectangle(k_margin + mm - 0.5 * k_line, top, k_line, mm % 50 == 0 ? 4 : 2.5, 0);
    page.text(
        k_margin + k_ruler_length + 3, top + 3, 8,
        "100 mm: print at 100 %, without fitting to the page, and measure. The squares are off "
        "by as much as the ruler.");
    const std::string form = fmt::format("{}x{}x{:.6g}", board.columns, board.rows, board.square);
    page.text(k_margin, top + 11, 9,
              fmt::format("{} x {} inner corners, squares of {:.6g} mm: --board {}", board.columns,
                          board.rows, side, form));
    page.text(k_margin, top + 16, 8,
              "uwvdb fit SCENE.yaml --images 'board_%03d.png' --board " + form +
                  " --unknown camera.port.distance,camera.port.normal -o fitted.yaml");
    page.text(k_margin, top + 21, 7,
              "Greys are what the file asks for; what the printer made of them is to be measured, "
              "dry and wet.");
}

}  // namespace

Paper read_paper(const std::string& word) {
    std::vector<std::string_view> names;
    for (const Paper& paper : k_papers) {
        if (paper.name == word) return paper;
        names.push_back(paper.name);
    }
    throw UsageError(fmt::format("--paper {}: {}", printable(word), suggestion(word, names)));
}

BoardDesc board_for(const Paper& paper) {
    const double side =
        std::floor(std::min(room_across(paper) / k_columns, room_down(paper) / k_rows));
    return {k_columns - 1, k_rows - 1, side / 1000};
}

std::string target_pdf(const BoardDesc& board, const Paper& paper) {
    const Sheet sheet(board, paper);
    PageContent page(paper);
    for (const Patch& patch : squares_of(board, sheet.side))
        page.rectangle(patch.x, patch.y, patch.width, patch.height, patch.grey);
    for (const Patch& patch : greys_of(sheet.greys_left, sheet.height)) {
        page.rectangle(patch.x, patch.y, patch.width, patch.height, patch.grey);
        page.text(patch.x, patch.y + patch.height + k_below_grey - 1.5, 7,
                  patch.grey == 1 ? "paper" : fmt::format("{:.1f}", patch.grey));
    }
    draw_foot(board, sheet.side, k_margin + sheet.height + 6, page);
    return pdf_of(paper, page);
}

TargetMesh target_mesh(const BoardDesc& board, const Paper& paper, const std::string& name) {
    const Sheet sheet(board, paper);
    std::vector<Patch> patches = squares_of(board, sheet.side);
    for (const Patch& patch : greys_of(sheet.greys_left, sheet.height)) patches.push_back(patch);
    // Divided at all edges, so that nothing lies on anything else.
    std::vector<double> xs{0, paper.width}, ys{0, paper.height};
    for (const Patch& patch : patches) {
        for (const double x : {patch.x, patch.x + patch.width}) xs.push_back(x);
        for (const double y : {patch.y, patch.y + patch.height}) ys.push_back(y);
    }
    constexpr double k_same = 1e-6;
    for (std::vector<double>* edges : {&xs, &ys}) {
        std::ranges::sort(*edges);
        const auto beyond = std::unique(edges->begin(), edges->end(),
                                        [](double a, double b) { return b - a < k_same; });
        edges->erase(beyond, edges->end());
    }
    const auto grey_at = [&](double x, double y) {
        for (const Patch& patch : patches)
            if (x > patch.x && x < patch.x + patch.width && y > patch.y &&
                y < patch.y + patch.height)
                return patch.grey;
        return 1.0;
    };
    std::map<double, std::string> faces;  // by grey
    for (std::size_t j = 0; j + 1 < ys.size(); ++j)
        for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
            const std::size_t corner = j * xs.size() + i + 1;  // of the vertices, from 1
            faces[grey_at(0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1]))] += fmt::format(
                "f {} {} {} {}\n", corner, corner + xs.size(), corner + xs.size() + 1, corner + 1);
        }
    TargetMesh mesh;
    mesh.obj =
        fmt::format("# A board of {} x {} corners [m], its first one at the origin.\nmtllib {}\n",
                    board.columns, board.rows, name);
    const double origin = k_margin + sheet.side;
    for (const double y : ys)
        for (const double x : xs)
            mesh.obj +=
                fmt::format("v {:.7g} {:.7g} 0\n", (x - origin) / 1000, (y - origin) / 1000);
    mesh.mtl = "# Reflectances of printed paper, roughly: put in what yours reflects, wet.\n";
    for (const auto& [grey, quads] : faces) {
        const std::string material = fmt::format("grey{:.0f}", 10 * grey);
        // Toner reflects 4 %, paper 80 %.
        const double reflectance = 0.04 + 0.76 * grey;
        mesh.obj += fmt::format("usemtl {}\n{}", material, quads);
        mesh.mtl += fmt::format("newmtl {}\nKd {:.4g} {:.4g} {:.4g}\n", material, reflectance,
                                reflectance, reflectance);
    }
    return mesh;
}

}  // namespace uw
