// ctest labels: statistical slow
// Brightness and coefficients from noisy raw pictures, divided into cells of all widths.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/fit_cells.h"

namespace uw::test {
namespace {

// Ten draws of the noise, and cells of 1 to 10 pixels and between, most of which do not divide the
// image; a mosaic's become odd. For each width 80 numbers are to be off by what their covariances
// say, no more and no less.
TEST_F(FitCells, OfAllWidthsAreOffByTheirErrors) {
    struct Kind {
        std::string mosaic;
        std::vector<double> sides;
    };
    for (const auto& [mosaic, sides] :
         {Kind{"rggb", {1, 2.5, 4, 5, 6.5, 8.5, 10}},
          Kind{"three", {1, 1.6, 2, 3, 3.3, 4, 4.6, 5, 6, 7.5, 8, 9, 10}}}) {
        std::vector<Off> off(sides.size());
        for (int seed = 1; seed <= 10; ++seed) {
            take_noisy_pictures(seed, mosaic);
            for (std::size_t i = 0; i < sides.size(); ++i) add_fit(sides[i], off[i]);
        }
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const std::string what = fmt::format("{}_{:g}", mosaic, sides[i]);
            off[i].expect_is_noise(what);
            RecordProperty(what,
                           fmt::format("chi2 {:.1f} of {:g}, lamps {:.2f} {:.2f}", off[i].squares,
                                       off[i].degrees, off[i].lamps[0], off[i].lamps[1]));
        }
    }
}

}  // namespace
}  // namespace uw::test
