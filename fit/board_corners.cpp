#include "fit/board_corners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"
#include "fit/least_squares.h"

namespace uw {

namespace {

board_module::GreyPicture grey(const PixelImage& image) {
    board_module::GreyPicture picture{image.width, image.height, {}};
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t colours = channels >= 3 ? 3 : 1;
    std::vector<double> means;
    for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
        double sum = 0;
        for (std::size_t k = 0; k < colours; ++k) sum += double{image.pixels[i + k]};
        means.push_back(sum / static_cast<double>(colours));
    }
    // Stretches the grey values to the full range, so that dark pictures work as well.
    const double brightest = means.empty() ? 0 : *std::ranges::max_element(means);
    for (const double mean : means)
        picture.values.push_back(static_cast<unsigned char>(
            brightest > 0 ? std::clamp(std::lround(255 * mean / brightest), 0L, 255L) : 0));
    return picture;
}

/// The same corners from the other end of the board, if the square beyond the first of them is
/// bright: that of uwvdb's sheet is black. Boards that look the same turned by half stay as they
/// were found.
void begin_at_black(const board_module::GreyPicture& picture, const BoardDesc& board,
                    std::vector<ImagePoint>& corners) {
    if ((board.columns + board.rows) % 2 == 0) return;
    const auto columns = static_cast<std::size_t>(board.columns);
    // The grey in the middle of the square before the first corner, and of that beside it.
    const auto grey_at = [&](double along) {
        const ImagePoint &first = corners[0], &right = corners[1], &below = corners[columns];
        const double x = first.x + along * (right.x - first.x) - 0.5 * (below.x - first.x);
        const double y = first.y + along * (right.y - first.y) - 0.5 * (below.y - first.y);
        const int column = std::clamp(static_cast<int>(x), 0, picture.width - 1);
        const int row = std::clamp(static_cast<int>(y), 0, picture.height - 1);
        return picture
            .values[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                    static_cast<std::size_t>(column)];
    };
    if (grey_at(-0.5) > grey_at(0.5)) std::ranges::reverse(corners);
}

}  // namespace

BoardDesc read_board(const std::string& text) {
    const std::size_t first = text.find('x');
    const std::size_t second = first == std::string::npos ? first : text.find('x', first + 1);
    double columns = 0, rows = 0;
    BoardDesc board;
    constexpr int k_fewest = 3, k_most = 200;
    const bool is_read =
        second != std::string::npos &&
        parse_number(text.substr(0, first), columns) == NumberText::number &&
        parse_number(text.substr(first + 1, second - first - 1), rows) == NumberText::number &&
        parse_number(text.substr(second + 1), board.square) == NumberText::number;
    if (!is_read || !(board.square > 0) || !(columns >= k_fewest && columns <= k_most) ||
        !(rows >= k_fewest && rows <= k_most) || columns != std::floor(columns) ||
        rows != std::floor(rows))
        throw UsageError(fmt::format(
            "--board {}: give COLUMNSxROWSxSIDE, its inner corners (at least 3 x 3) and "
            "the side of a square in metres, such as 9x6x0.03",
            printable(text)));
    board.columns = static_cast<int>(columns);
    board.rows = static_cast<int>(rows);
    return board;
}

PointTable find_board_corners(const std::vector<std::filesystem::path>& pictures,
                              const BoardDesc& board,
                              const std::function<void(const std::string&)>& say) {
    auto& find = function_of_fitting<board_module::Find>(board_module::k_find);
    PointTable table;
    for (const std::filesystem::path& file : pictures) {
        throw_if_stopped();
        std::vector<ImagePoint> corners;
        const board_module::GreyPicture picture = grey(read_image(file));
        find(picture, board, corners);
        if (corners.empty()) {
            say(
                fmt::format("{}: the board of {} x {} corners is not to be seen, or not all of it; "
                            "passed over",
                            file.string(), board.columns, board.rows));
            continue;
        }
        begin_at_black(picture, board, corners);
        const std::size_t image = table.images.size();
        table.images.push_back(file.filename().string());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto columns = static_cast<std::size_t>(board.columns);
            const std::size_t column = i % columns, row = i / columns;
            table.points.push_back({image,
                                    {board.square * static_cast<double>(column),
                                     board.square * static_cast<double>(row), 0},
                                    corners[i]});
        }
    }
    if (table.images.empty())
        throw InputError(
            fmt::format("none of {} shows the board of {} x {} inner corners; check --board: of a "
                        "board with 10 "
                        "x 7 squares they are 9x6",
                        counted(pictures.size(), "picture"), board.columns, board.rows));
    return table;
}

std::string point_csv(const PointTable& table) {
    std::string text =
        "# points in axes that those of an image share [m], and where it shows them [pixels], its "
        "corner at (0, 0)\nimage,x,y,z,u,v\n";
    for (const PhotographedPoint& point : table.points)
        text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                            csv_text(table.images[point.image]), point.point.x, point.point.y,
                            point.point.z, point.seen.x, point.seen.y);
    return text;
}

}  // namespace uw
