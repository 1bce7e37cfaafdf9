// ctest labels: metamorphic
// What is predicted of a cell is the light over the pixels that it has: of each colour, in all
// kinds of pictures, for cells of all widths.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/film.h"
#include "core/image/image_file.h"
#include "fit/picture_residuals.h"
#include "fit/unknowns.h"
#include "render/scene_loading.h"
#include "tests/support/fit_cells.h"

namespace uw::test {
namespace {

/// A picture of k_noisy_dive without noise, and what the same scene predicts of its cells.
class FitCellPredictions : public CliTest {
  protected:
    /// `sensor` and `camera`: keys in the place of the scene's sensor, and beside its port. The
    /// sensor's numbers are fine enough for their rounding not to matter.
    void take_picture(const std::string& sensor, const std::string& camera) {
        text_ = k_noisy_dive;
        const std::size_t begin = text_.find("  lens:"), end = text_.find("water:");
        text_.replace(begin, end - begin, sensor + camera);
        write("dive.yaml", text_);
        const std::string ending = sensor.empty() ? ".exr" : ".sensor.png";
        file_ = "dive_1" + ending;
        std::vector<std::string> arguments{"render",           "dive.yaml", "-o",
                                           "dive_%d" + ending, "--frames",  "1-1",
                                           "--quiet",          "--set",     "render.samples=16"};
        if (sensor.empty()) arguments.insert(arguments.end(), {"--precision", "float"});
        const ProgramResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }

    PictureResiduals::Comparison comparison(int cells) const {
        const SceneUnknowns unknowns(scene_tree(text_, folder_ / "dive.yaml", {}),
                                     folder_ / "dive.yaml",
                                     std::vector<std::string>{"lamps.left.intensity"});
        PictureResiduals pictures(unknowns, {{folder_ / file_, {1, 0}}}, cells);
        const double truth[] = {30};
        EXPECT_TRUE(pictures.prepare(truth, false));
        return pictures.comparison(0);
    }

    /// Where predictions are less what was seen, for each colour: by what they are off in the mean,
    /// relative to the light; and by how many pixels to the right they were taken, which is the
    /// slope of what they are off by against the light's gradient.
    struct Difference {
        std::array<double, 3> mean{}, shift{};
        std::size_t cells = 0;
    };
    Difference difference(int cells, double black) const {
        const PictureResiduals::Comparison all = comparison(cells);
        Difference result;
        const double side = 160.0 / all.width;
        for (std::size_t k = 0; k < 3; ++k) {
            double light = 0, off = 0, along = 0, squares = 0;
            for (int y = 0; y < all.height; ++y)
                for (int x = 1; x + 1 < all.width; ++x) {
                    const auto at = [&](int column) {
                        return static_cast<std::size_t>(y * all.width + column);
                    };
                    const double seen = all.seen[at(x)][k];
                    const double gradient =
                        (all.seen[at(x + 1)][k] - all.seen[at(x - 1)][k]) / (2 * side);
                    if (!std::isfinite(seen) || !std::isfinite(gradient)) continue;
                    ++result.cells;
                    light += seen - black;
                    off += all.predicted[at(x)][k] - seen;
                    along += (all.predicted[at(x)][k] - seen) * gradient;
                    squares += gradient * gradient;
                }
            result.mean[k] = off / light;
            result.shift[k] = along / squares;
        }
        return result;
    }

    std::string text_, file_;
};

std::string quiet_sensor(const std::string& mosaic) {
    const std::string efficiency = mosaic == "mono" ? "0.5" : "[0.4, 0.55, 0.5]";
    return fmt::format(
        "  lens: {{focal_length: 0.008, f_number: 2.8}}\n"
        "  sensor: {{exposure: 0.00001, mosaic: {}, quantum_efficiency: {}, gain: 10, "
        "shot_noise: false, black_level: 64, bit_depth: 16, image: raw}}\n",
        mosaic, efficiency);
}

// Cells of 2 to 16 pixels, most of which do not divide 160 x 120.
constexpr std::array k_cell_counts{64, 23, 10};

void expect_none(const auto& difference, const std::string& what) {
    EXPECT_GT(difference.cells, 50U) << what;
    for (std::size_t k = 0; k < 3; ++k) {
        // Light is computed to about 1e-3, a table's error, which is not the same in both images.
        EXPECT_LT(std::abs(difference.mean[k]), 5e-4) << what << ", colour " << k;
        // Half a pixel is what a mosaic's colours, and a rounded edge, are off by; a tenth of that.
        EXPECT_LT(std::abs(difference.shift[k]), 0.05) << what << ", colour " << k;
    }
}

TEST_F(FitCellPredictions, AreOfTheirPixelsInMosaics) {
    for (const std::string mosaic : {"rggb", "bggr", "grbg", "gbrg", "mono", "three"}) {
        take_picture(quiet_sensor(mosaic), "");
        for (const int cells : k_cell_counts)
            expect_none(difference(cells, 64), fmt::format("{}, {} cells", mosaic, cells));
    }
}

TEST_F(FitCellPredictions, AreOfTheirPixelsInLightAndThroughALens) {
    const std::string lens = "  distortion: {model: brown-conrady, k: [-0.2, 0.05, 0]}\n";
    for (const std::string& camera : {std::string(), lens}) {
        take_picture("", camera);
        for (const int cells : k_cell_counts)
            expect_none(difference(cells, 0), fmt::format("{} cells {}", cells, camera));
    }
    take_picture(quiet_sensor("grbg"), lens);
    expect_none(difference(45, 64), "mosaic, 45 cells");
}

// A pixel that is masked or no number belongs to no cell that is compared; all others do.
TEST_F(FitCellPredictions, LeaveOutWhatIsMasked) {
    take_picture("", "");
    const PixelImage whole = read_linear_image(folder_ / file_);
    Film film(160, 120, {0, 0, 160, 120}, {"R", "G", "B", "A"});
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
            for (std::size_t c = 0; c < 4; ++c)
                film.pixel(x, y)[c] = whole.pixels[static_cast<std::size_t>(4 * (y * 160 + x)) + c];
    film.pixel(3, 3)[k_alpha] = 0.5F;
    film.pixel(40, 3)[k_green] = std::nanf("");
    file_ = "masked_1.exr";  // what was read is not replaced
    write_exr(folder_ / file_, film, {}, {ExrOptions::Precision::single});
    const PictureResiduals::Comparison seen = comparison(20);  // of 8 pixels
    ASSERT_EQ(seen.width, 20);
    ASSERT_EQ(seen.height, 15);
    for (std::size_t i = 0; i < seen.seen.size(); ++i)
        EXPECT_EQ(std::isfinite(seen.seen[i][0]), i != 0 && i != 5) << i;
}

// Where the lens has no ray there is nothing to compare.
TEST_F(FitCellPredictions, LeaveOutWhatHasNoRay) {
    take_picture("", "  distortion: {model: brown-conrady, k: [-0.6, 0, 0]}\n");
    const PictureResiduals::Comparison seen = comparison(32);
    const PixelImage picture = read_linear_image(folder_ / file_);
    std::size_t left_out = 0;
    for (int y = 0; y < seen.height; ++y)
        for (int x = 0; x < seen.width; ++x) {
            bool is_whole = true;
            for (int i = 0; i < 25; ++i) {
                const auto pixel = static_cast<std::size_t>((5 * y + i / 5) * 160 + 5 * x + i % 5);
                is_whole = is_whole && picture.pixels[4 * pixel + 3] == 1;
            }
            const bool is_seen =
                std::isfinite(seen.seen[static_cast<std::size_t>(y * seen.width + x)][0]);
            EXPECT_EQ(is_seen, is_whole) << x << " " << y;
            left_out += is_seen ? 0 : 1;
        }
    EXPECT_GT(left_out, 20U);
    EXPECT_LT(left_out, seen.seen.size() / 2);
}

// The normal run's share of FitCells (noisy_cells.cpp): a draw for cells of 2.5 pixels, as it were,
// and one for cells of 8.
TEST_F(FitCells, OfTwoWidthsAreOffByTheirErrors) {
    Off off;
    take_noisy_pictures(21);
    add_fit(2.5, off);
    take_noisy_pictures(22);
    add_fit(8, off);
    off.expect_is_noise("2.5 and 8 pixels");
}

TEST_F(FitCells, AreWholePixels) {
    take_noisy_pictures(1);
    const std::vector<std::string> keys{"lamps.left.intensity"};
    const SceneUnknowns unknowns(scene_tree(text_, folder_ / "dive.yaml", {}),
                                 folder_ / "dive.yaml", keys);
    // Of a mosaic an odd number, at least three.
    for (const auto& [cells, across] :
         {std::pair{160, 53}, {64, 53}, {40, 32}, {32, 32}, {16, 14}}) {
        PictureResiduals pictures(unknowns, pictures_called(folder_ / "noisy_00.sensor.png"),
                                  cells);
        const double start[] = {30};
        EXPECT_TRUE(pictures.prepare(start, false));
        EXPECT_EQ(pictures.comparison(0).width, across) << cells;
    }
}

}  // namespace
}  // namespace uw::test
