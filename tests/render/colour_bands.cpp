// ctest labels: analytic
// What three bands shown as R, G, B make of a white wall in Jerlov water, against 16 bands through
// CIE 1931, and 16 bands against twice as many. docs/colour.md has the numbers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>

#include "core/image/colour.h"
#include "tests/support/ies_files.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using Lab = std::array<double, 3>;

/// CIE 1976 L*a*b* of linear sRGB, white D65.
Lab lab_of(const LinearRgb& rgb) {
    const auto f = [](double t) {
        return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    };
    const double x = (0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505;
    const double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    const double z = (0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.0888;
    return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

double delta_e(const Lab& a, const Lab& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// A white wall `distance` away lit by a white lamp beside the camera, as linear sRGB.
LinearRgb wall(const std::vector<double>& bands, double distance) {
    SceneDesc desc = pinhole_scene(9, 9);
    desc.water = WaterDesc{};
    desc.water.bands_nm = bands;
    desc.water.preset = "jerlov-II";
    desc.geometry = {plane_at_z(distance)};
    desc.lamps = {isotropic_lamp({0.3, 0, 0}, 0)};
    desc.lamps[0].intensity = PerBand(bands.size(), 50.0);
    const PixelResult pixel = TestScene(desc).pixel(4, 4);
    Spectrum total{};
    for (std::size_t b = 0; b < bands.size(); ++b)
        total[b] = pixel.direct[b] + pixel.backscatter[b];
    return BandColour(bands)(total);
}

/// Both exposed alike: so that the second has Y = 0.5.
double difference(const std::vector<double>& a, const std::vector<double>& b, double distance) {
    LinearRgb first = wall(a, distance), second = wall(b, distance);
    const double exposure = 0.5 / luminance(second);
    for (std::size_t c = 0; c < 3; ++c) {
        first[c] *= exposure;
        second[c] *= exposure;
    }
    return delta_e(lab_of(first), lab_of(second));
}

TEST(ColourBands, ThreeBandsAreAnotherColourSixteenAreNot) {
    const std::vector<double> three{620, 540, 450}, sixteen = steps(400, 700, 20),
                                                    thirty_one = steps(400, 700, 10);
    for (const double distance : {0.5, 1.0, 2.0, 4.0}) {
        const double coarse = difference(three, sixteen, distance);
        const double fine = difference(sixteen, thirty_one, distance);
        std::cout << "wall at " << distance << " m: 3 against 16 bands " << coarse
                  << ", 16 against 31 bands " << fine << "\n";
        // 2.3 is just noticeable.
        EXPECT_LT(fine, 2.3) << distance;
        EXPECT_GT(coarse, fine) << distance;
    }
    EXPECT_GT(difference(three, sixteen, 4), 2 * 2.3);
}

}  // namespace
}  // namespace uw::test
