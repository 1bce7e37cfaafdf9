// ctest labels: unit analytic
#include "core/light/image_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/light/lamp_profile.h"
#include "tests/support/image_file.h"
#include "tests/support/lamp_profile_laws.h"
#include "tests/support/random_direction.h"
#include "tests/support/temp_dir.h"

namespace uw::test {
namespace {

std::shared_ptr<const Grid2D<float>> pattern(int width, int height,
                                             const std::function<float(int, int)>& value) {
    auto made = std::make_shared<Grid2D<float>>(width, height, 0.0F);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) (*made)(x, y) = value(x, y);
    return made;
}
float stripes(int x, int /*y*/) {
    return x / 6 % 2 == 0 ? 1.0F : 0.0F;
}
float smooth(int x, int y) {
    return 0.5F +
           0.5F * std::sin(0.05F * static_cast<float>(x)) * std::cos(0.07F * static_cast<float>(y));
}

TEST(ImageProfile, ObeysTheLaws) {
    expect_lamp_profile_laws(ImageProfile({"", 40, 0}, {}, pattern(64, 32, stripes)));
    expect_lamp_profile_laws(ImageProfile({"", 150, 70}, {}, pattern(3, 50, smooth)));
}

// Seen from behind the lamp the image stands upright.
TEST(ImageProfile, HasItsPixelsWhereACameraWouldSeeThem) {
    const auto values =
        pattern(4, 2, [](int x, int y) { return 0.1F * static_cast<float>(x + 4 * y) + 0.3F; });
    const ImageProfile image({"", 90, 0}, {}, values);
    // 90 degrees across 4 pixels: a focal length of 2.
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(image.relative_intensity({x + 0.5 - 2, y + 0.5 - 1, 2}),
                        static_cast<double>((*values)(x, y)), 1e-12);
    // Halfway between four of them; at the edge, and beyond; behind.
    EXPECT_NEAR(image.relative_intensity({-1, 0, 2}), 0.3 + 0.05 + 0.2, 1e-7);
    EXPECT_NEAR(image.relative_intensity({-1.999, -0.999, 2}), 0.3, 1e-7);
    EXPECT_EQ(image.relative_intensity({-2.001, 0, 2}), 0);
    EXPECT_EQ(image.relative_intensity({0, 1.001, 2}), 0);
    EXPECT_EQ(image.relative_intensity({0, 0, -2}), 0);
    const ImageProfile turned({"", 90, 90}, {}, values);  // its right edge is up
    EXPECT_NEAR(turned.relative_intensity({-0.5, -1.5, 2}), 0.6, 1e-7);
}

TEST(ImageProfile, SolidAngleIsTheIntegral) {
    for (const double fov : {20.0, 100.0}) {
        // A white one is a rectangle seen from its axis, which has a closed form. One row of many
        // pixels is that of a line scanner.
        for (const auto& [width, height] : {std::pair(16, 8), {20000, 1}}) {
            const ImageProfile white({"", fov, 0}, {},
                                     pattern(width, height, [](int, int) { return 1.0F; }));
            const double x = std::tan(std::numbers::pi / 360 * fov), y = x * height / width;
            const double sides = std::sqrt((1 + x * x) * (1 + y * y));
            EXPECT_NEAR(white.solid_angle() / (4 * std::asin(x * y / sides)), 1, 1e-5) << fov;
        }
        const ImageProfile image({"", fov, 0}, {}, pattern(64, 32, smooth));
        EXPECT_NEAR(image.solid_angle() / solid_angle_by_quadrature(image, 3000, 3000), 1, 1e-3);
    }
}

TEST(ImageProfile, FewNodesBetweenBreaksIntegrateIt) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> offset(-0.5, 0.5);
    for (const auto& values : {pattern(64, 48, stripes), pattern(300, 200, smooth)}) {
        const ImageProfile image({"", 60, 15}, {}, values);
        double worst = 0;
        std::size_t most = 0;
        for (int n = 0; n < 300; ++n) {
            const Ray ray{{offset(rng), offset(rng), offset(rng) + 1.5}, random_direction(rng)};
            std::vector<double> s{0, 3};
            image.append_breaks(ray, {0, 3}, {0, 0, 0}, s);
            std::sort(s.begin(), s.end());
            most = std::max(most, s.size());
            const auto at = [&](double t) {
                return image.relative_intensity(from_origin(ray.at(t)));
            };
            double sum = 0, fine = 0;
            for (std::size_t i = 0; i + 1 < s.size(); ++i)
                for (const QuadratureNode& node : gauss_legendre(4))
                    sum += node.weight * (s[i + 1] - s[i]) *
                           at(s[i] + node.position * (s[i + 1] - s[i]));
            constexpr int k_midpoints = 20000;
            for (int i = 0; i < k_midpoints; ++i)
                fine += at((i + 0.5) / k_midpoints * 3) * 3 / k_midpoints;
            worst = std::max(worst, std::abs(sum - fine) / std::max(fine, 0.01));
        }
        // The light between breaks is within 2 % of the greatest of a straight line.
        EXPECT_LT(worst, 0.01);
        EXPECT_LT(most, 100U);
    }
}

TEST(ImageProfile, IsReadAsTextures) {
    const TempDir folder;
    const auto write = [&](const std::string& name, int channels, const std::vector<int>& values) {
        std::ofstream(folder.path() / name, std::ios::binary)
            << encoded_image("png", 2, 1, channels, values);
        return ImageProfileDesc{folder.path() / name, 90, 0, "scene.yaml:1: profile"};
    };
    std::vector<std::string> warnings;
    const ImageProfile grey = make_profile(write("grey.png", 1, {188, 94}), {}, warnings);
    EXPECT_NEAR(grey.relative_intensity({-0.5, 0, 1}), 1, 1e-7);
    // (94/255 + 0.055)/1.055 to the power of 2.4, over the same of 188.
    EXPECT_NEAR(grey.relative_intensity({0.5, 0, 1}),
                std::pow((94 / 255.0 + 0.055) / (188 / 255.0 + 0.055), 2.4), 1e-6);
    EXPECT_TRUE(warnings.empty());
    const ImageProfile red =
        make_profile(write("red.png", 3, {255, 0, 0, 255, 255, 255}), {}, warnings);
    EXPECT_NEAR(red.relative_intensity({-0.5, 0, 1}), 0.2126, 1e-6);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("has colours"), std::string::npos);
    EXPECT_THROW(make_profile(write("black.png", 1, {0, 0}), {}, warnings), InputError);
}

}  // namespace
}  // namespace uw::test
