#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fit/point_residuals.h"

namespace uw {

/// A printed checkerboard by its inner corners, where four squares meet.
struct BoardDesc {
    int columns = 0, rows = 0;
    double square = 0;  // side of a square [m]
};

/// "9x6x0.03". Throws UsageError for anything else, and for boards of less than 3 x 3 corners.
BoardDesc read_board(const std::string& text);

/// The corners of the board in photographs, to a fraction of a pixel, found by OpenCV in the module
/// of fit/min_squares.h: row by row, x to the right and y down the board [m] from the first one,
/// beyond which the square at the board's corner is black, as on uwvdb's sheet. Pictures that do
/// not show all of the board are passed over, and named to `say` in one line each. Throws as
/// read_image, and InputError if none shows it.
PointTable find_board_corners(const std::vector<std::filesystem::path>& pictures,
                              const BoardDesc& board,
                              const std::function<void(const std::string&)>& say);

/// A table of points as read_seen_points reads it.
std::string point_csv(const PointTable& table);

/// The function that the module exports: takes a picture's grey values, 0 to 255, row by row, and
/// returns the corners found in it, row by row of the board, the image's corner at (0, 0) [pixels];
/// none if the board is not found.
namespace board_module {
inline constexpr const char* k_find = "uwvdb_find_board";
struct GreyPicture {
    int width = 0, height = 0;
    std::vector<unsigned char> values;
};
using Find = void(const GreyPicture& picture, const BoardDesc& board,
                  std::vector<ImagePoint>& corners);
}  // namespace board_module

}  // namespace uw
