// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

class ImageLayers : public test::CliTest {};

using Names = std::vector<std::string>;

Names sorted(Names names) {
    std::ranges::sort(names);
    return names;
}

TEST_F(ImageLayers, ThreeBandsAreRedGreenBlue) {
    const ImageFile image = render({"--layers", "all"});
    Names expected{"R", "G", "B", "A"};
    for (const char* layer : {"direct", "forward", "backscatter", "backscatter_first", "irradiance",
                              "exitance", "clean", "transmittance", "albedo", "lamp.left"})
        for (const char* band : {".R", ".G", ".B"}) expected.push_back(std::string(layer) + band);
    for (const char* name :
         {"lit.V", "depth.Z", "range.V", "path.V", "normal.X", "normal.Y", "normal.Z", "position.X",
          "position.Y", "position.Z", "id.V", "material.V"})
        expected.emplace_back(name);
    EXPECT_EQ(sorted(image.names), sorted(expected));
    test::expect_finite_and_lit(image);
    EXPECT_EQ(image.metadata.at("uwvdb/bands_nm"), "620, 540, 450");
    EXPECT_EQ(image.metadata.at("uwvdb/water_attenuation_per_m"), "0.55, 0.3, 0.3");
    EXPECT_EQ(image.metadata.at("uwvdb/scene"), "scene.yaml");
    EXPECT_EQ(image.metadata.at("uwvdb/integrator"), "volume");
}

TEST_F(ImageLayers, DefaultIsTheImageWithItsDepth) {
    const ImageFile image = render({"--layers", "default"}), all = render({"--layers", "all"});
    EXPECT_EQ(sorted(image.names), (Names{"A", "B", "G", "R", "depth.Z"}));
    EXPECT_EQ(image.channels.at("depth.Z"), all.channels.at("depth.Z"));
    for (const char* band : {"R", "G", "B"}) {
        const std::vector<float>& exact = all.channels.at(band);
        for (std::size_t i = 0; i < exact.size(); ++i)  // half floats: 11 bits
            EXPECT_LE(std::abs(image.channels.at(band)[i] - exact[i]), 0x1p-11F * exact[i]);
        EXPECT_NE(image.channels.at(band), exact);
        EXPECT_EQ(render({"--layers", "default", "--precision", "float"}).channels.at(band), exact);
    }
}

TEST_F(ImageLayers, WhatHalfFloatsCannotHoldIsKeptOrSaid) {
    const Names bright{"--layers", "default", "--set", "lamps.left.intensity=1e8"};
    const Names dark{"--layers", "default", "--set", "lamps.left.intensity=1e-6"};
    const auto with_precision = [](Names arguments, const char* precision) {
        arguments.insert(arguments.end(), {"--precision", precision});
        return arguments;
    };
    for (const Names& arguments : {bright, dark}) {
        const ImageFile image = render(with_precision(arguments, "auto"));
        EXPECT_EQ(image.channels.at("G"),
                  render(with_precision(arguments, "float")).channels.at("G"));
    }
    const auto said = [&](Names arguments) {
        arguments.insert(arguments.begin(), {"render", "scene.yaml", "--precision", "half"});
        return run(arguments).err;
    };
    EXPECT_NE(said(bright).find("values are too large for half floats"), std::string::npos);
    EXPECT_NE(said(dark).find("the light is so weak that half floats"), std::string::npos);
    EXPECT_EQ(said({}).find("half floats"), std::string::npos);
}

TEST_F(ImageLayers, OtherBandsAreNamedByWavelength) {
    for (const int count : {1, 5, 16}) {
        Names bands;
        std::string list, ones;
        for (int i = 0; i < count; ++i) {
            const std::string nm = std::to_string(430 + 17 * i);
            list += (i == 0 ? "" : ", ") + nm;
            bands.push_back("." + nm + "nm");
        }
        const ImageFile image =
            render({"--set", "water={bands: [" + list + "]}", "--set", "lamps.left.intensity=50",
                    "--set", "geometry=[{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]",
                    "--layers", "total,direct,backscatter,depth"});
        Names expected{"R", "G", "B", "A", "depth.Z"};
        for (const char* layer : {"total", "direct", "backscatter"})
            for (const std::string& band : bands) expected.push_back(layer + band);
        EXPECT_EQ(sorted(image.names), sorted(expected)) << count;
        for (const auto& [name, values] : image.channels)
            for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
        for (const std::string& band : bands) {
            const std::vector<float>& total = image.channels.at("total" + band);
            EXPECT_GT(total.at(total.size() / 2), 0) << band;
            for (std::size_t i = 0; i < total.size(); ++i)
                ASSERT_EQ(total[i], image.channels.at("direct" + band)[i] +
                                        image.channels.at("backscatter" + band)[i]);
        }
    }
}

TEST_F(ImageLayers, CropHoldsThePixelsOfTheWholeToTheBit) {
    const ImageFile whole = render({"--layers", "all", "--samples", "4"});
    const ImageFile part = render({"--layers", "all", "--samples", "4", "--crop", "7,3,29,18"});
    EXPECT_EQ(part.x, 7);
    EXPECT_EQ(part.y, 3);
    EXPECT_EQ(part.width, 22);
    EXPECT_EQ(part.height, 15);
    EXPECT_EQ(part.full_width, 33);
    EXPECT_EQ(part.full_height, 19);
    for (const std::string& name : whole.names)
        for (int y = 3; y < 18; ++y)
            for (int x = 7; x < 29; ++x)
                ASSERT_EQ(part.at(name, x, y), whole.at(name, x, y)) << name;
}

TEST_F(ImageLayers, DraftsAreWithinThreePerCentAndFinalImagesCloseToExact) {
    const std::vector<std::string> size{"--samples", "1", "--size", "132x76", "--quality"};
    const auto render_as = [&](const char* quality) {
        std::vector<std::string> options = size;
        options.emplace_back(quality);
        return render(options);
    };
    const ImageFile exact = render_as("exact");
    // The RMS relative to the mean: what `--help` says of drafts, and what the lattice of rays
    // allows (InScatterLattice).
    for (const auto& [quality, tolerance] : {std::pair("draft", 0.03), std::pair("final", 1e-3)}) {
        const ImageFile image = render_as(quality);
        double squares = 0, mean = 0;
        for (std::size_t i = 0; i < exact.channels.at("G").size(); ++i) {
            const auto truth = static_cast<double>(exact.channels.at("G")[i]);
            const double difference = static_cast<double>(image.channels.at("G")[i]) - truth;
            squares += difference * difference;
            mean += truth;
        }
        const auto count = static_cast<double>(exact.channels.at("G").size());
        EXPECT_LT(std::sqrt(squares / count), tolerance * mean / count) << quality;
        EXPECT_EQ(image.channels.at("depth.Z"), exact.channels.at("depth.Z"));
    }
}

TEST_F(ImageLayers, SizeScalesTheIntrinsics) {
    const ImageFile small = render({"--samples", "1", "--quality", "exact"});
    const ImageFile large = render({"--samples", "1", "--quality", "exact", "--size", "99x57"});
    // Pixel (x, y) of the small image has its centre at that of (3x + 1, 3y + 1) of the large one:
    // the same rays to rounding, which places shadow edges to a part in a thousand.
    for (const char* name : {"R", "B", "direct.G", "backscatter.G", "depth.Z", "position.X"})
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 33; ++x) {
                const float there = large.at(name, 3 * x + 1, 3 * y + 1);
                ASSERT_NEAR(small.at(name, x, y), there, 1e-3 * std::abs(there) + 1e-6) << name;
            }
}

TEST_F(ImageLayers, SetReplacesWhatTheFileSays) {
    const ImageFile near = render({"--set", "geometry[0].point=[0, 0, 3]"});
    EXPECT_NEAR(near.at("depth.Z", 2, 9), 3, 1e-6);
    const ImageFile last = render({"--set", "geometry[0].point=[0, 0, 3]", "--set",
                                   "geometry[0].point=[0, 0, 2]", "--integrator", "reference"});
    EXPECT_NEAR(last.at("depth.Z", 2, 9), 2, 1e-6);
    EXPECT_EQ(last.metadata.at("uwvdb/integrator"), "reference");
}

TEST_F(ImageLayers, ThePortShortensThePathAndEnlargesWhatIsSeen) {
    const ImageFile bare = render({"--samples", "1"});
    const ImageFile port =
        render({"--samples", "1", "--set", "camera.port={distance: 0.02, thickness: 0.04}"});
    // On the axis, in the middle of an odd number of pixels, no glass bends anything.
    EXPECT_NEAR(bare.at("path.V", 16, 9), 4, 1e-6);
    EXPECT_NEAR(port.at("path.V", 16, 9), 4 - 0.02 - 0.04, 1e-6);
    EXPECT_NEAR(port.at("range.V", 16, 9), 4, 1e-6);
    const auto x_of = [](const ImageFile& image, int x) { return image.at("position.X", x, 2); };
    const double n_water = 1.334;  // the wall at the left edge of the image: 4 tan(angle)
    const double angle = std::atan(16 / (16.5 / std::tan(std::numbers::pi / 6)));
    EXPECT_NEAR(x_of(bare, 0), -4 * std::tan(angle), 1e-5);
    const double in_water = std::asin(std::sin(angle) / n_water);
    EXPECT_NEAR(x_of(port, 0), -4 * std::tan(in_water), 0.08);  // the glass shifts by less
}

TEST_F(ImageLayers, PixelsWithoutARayHaveAlphaZero) {
    // From the dense side beyond the critical angle all is reflected: sin(angle) > n_water / n_air.
    const std::vector<std::string> wide{
        "--samples", "1",
        "--layers",  "all",
        "--set",     "camera.intrinsics={fov_x: 150}",
        "--set",     "camera.port={distance: 0.02, thickness: 0.04, n_air: 1.5, n_water: 1.1}"};
    const ImageFile image = render(wide);
    const double focal = 16.5 / std::tan(75 * std::numbers::pi / 180);
    int empty = 0;
    for (int y = 0; y < 19; ++y) {
        for (int x = 0; x < 33; ++x) {
            const double angle = std::atan(std::hypot(x - 16, y - 9) / focal);
            const bool reflected = std::sin(angle) > 1.1 / 1.5;
            empty += reflected ? 1 : 0;
            ASSERT_EQ(image.at("A", x, y), reflected ? 0 : 1) << x << ", " << y;
            if (!reflected) continue;
            for (const std::string& name : image.names) ASSERT_EQ(image.at(name, x, y), 0) << name;
        }
    }
    EXPECT_GT(empty, 50);
    EXPECT_LT(empty, 600);
    std::vector<std::string> arguments{"render", "scene.yaml", "--quiet"};
    arguments.insert(arguments.end(), wide.begin(), wide.end());
    EXPECT_EQ(run(arguments).err.find("warning: " + std::to_string(empty) + " of 627 pixels"), 0U);
}

}  // namespace
}  // namespace uw
