// ctest labels: unit analytic
#include "core/light/photometric_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/ies_files.h"

namespace uw {
namespace {

using std::numbers::pi;

constexpr double radians(double degrees) {
    return degrees * pi / 180;
}

PhotometricWeb web_of(const test::IesWriter& writer) {
    return PhotometricWeb(parse_ies(writer.text(), "lamp.ies"));
}

TEST(PhotometricWeb, FluxOfTheFilesIsTheirLumens) {
    for (const char* const name :
         {"synthetic_flood_1500lm_120deg.ies", "synthetic_flood_6000lm_70deg.ies",
          "synthetic_spot_6000lm_20deg.ies"}) {
        const IesFile file =
            read_ies(std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/ies" / name);
        const double flux = PhotometricWeb(file).flux();
        // Straight lines between the angles of a lobe that is none: 0.12 % at most.
        EXPECT_NEAR(flux, file.lumens, 0.002 * file.lumens) << name;
        EXPECT_TRUE(file.warnings.empty());
    }
}

TEST(PhotometricWeb, FluxInClosedForm) {
    test::IesWriter writer;
    writer.polar = {0, 180};
    writer.candelas = [](double, double) { return 10.0; };
    EXPECT_NEAR(web_of(writer).flux(), 40 * pi, 1e-12);  // the whole sphere
    // cos^2(azimuth) sin(polar): 2 pi/2 * pi/2 ... = int sin^2 * int cos^2 = (pi/2) pi.
    writer.polar = test::steps(0, 180, 1);
    writer.planes = test::steps(0, 90, 1);
    writer.candelas = [](double polar, double plane) {
        return std::sin(radians(polar)) * std::pow(std::cos(radians(plane)), 2);
    };
    EXPECT_NEAR(web_of(writer).flux(), pi * pi / 2, 1e-3);
}

TEST(PhotometricWeb, LinearInBothAnglesByHand) {
    test::IesWriter writer;
    writer.polar = {0, 30, 90};
    writer.planes = {0, 90, 180, 270, 360};
    // Rows of 30 degrees: 100, 200, 300, 400, 100; of 0: 800; of 90: 0.
    writer.candelas = [](double polar, double plane) {
        if (polar == 0) return 800.0;
        return polar == 90 ? 0.0 : (plane == 360 ? 100.0 : 100 + plane / 90 * 100);
    };
    const PhotometricWeb web = web_of(writer);
    EXPECT_FALSE(web.is_rotational());
    EXPECT_EQ(web.peak(), 800);
    const double tolerance = 1e-9;  // of angles in radians
    EXPECT_NEAR(web.candelas(0, 1), 800, tolerance);
    EXPECT_NEAR(web.candelas(radians(30), radians(90)), 200, tolerance);
    EXPECT_NEAR(web.candelas(radians(30), radians(45)), 150, tolerance);
    EXPECT_NEAR(web.candelas(radians(15), radians(45)), 475, tolerance);
    EXPECT_NEAR(web.candelas(radians(60), radians(225)), 175, tolerance);
    EXPECT_NEAR(web.candelas(radians(30), radians(315)), 250, tolerance);
    EXPECT_NEAR(web.candelas(radians(30), radians(-45)), 250, tolerance);
    EXPECT_EQ(web.candelas(radians(90.1), 0), 0);
}

// The four symmetries against the full table of the same luminaire.
TEST(PhotometricWeb, SymmetriesUnfold) {
    struct Case {
        double first, last;
        std::function<double(double)> around;  // of the azimuth in degrees
    };
    const auto both = [](double a) { return 2 + std::cos(2 * radians(a)); };
    const auto about_0 = [](double a) { return 2 + std::cos(radians(a)); };
    const auto about_90 = [](double a) { return 2 + std::sin(radians(a)); };
    const auto none = [](double a) { return 3 + std::sin(radians(a)) + std::cos(2 * radians(a)); };
    for (const Case& c : {Case{0, 90, both}, Case{0, 180, about_0}, Case{90, 270, about_90},
                          Case{0, 360, none}, Case{0, 337.5, none}}) {
        test::IesWriter writer;
        writer.polar = {0, 40, 180};
        writer.planes = test::steps(c.first, c.last, 22.5);
        writer.candelas = [&](double, double plane) { return c.around(plane); };
        const PhotometricWeb web = web_of(writer);
        for (const double azimuth : test::steps(-180, 180, 22.5))
            EXPECT_NEAR(web.candelas(1, radians(azimuth)), c.around(azimuth), 1e-9)
                << c.first << " to " << c.last << " at " << azimuth;
    }
}

TEST(PhotometricWeb, BreaksFollowTheIntensity) {
    test::IesWriter even;
    even.polar = test::steps(0, 90, 1);
    even.candelas = [](double polar, double) { return 5 + std::cos(radians(polar)); };
    EXPECT_LE(web_of(even).polar_breaks().size(), 9U);  // every 15 degrees, not every one
    test::IesWriter step = even;
    step.candelas = [](double polar, double) { return polar < 32.5 ? 7.0 : 0.0; };
    const PhotometricWeb web = web_of(step);
    for (const double edge : {32, 33})
        EXPECT_TRUE(std::ranges::any_of(web.polar_breaks(), [&](double angle) {
            return std::abs(angle - radians(edge)) < 1e-9;
        })) << edge;
    EXPECT_NEAR(web.dark_angle(), radians(33), 1e-12);
}

}  // namespace
}  // namespace uw
