// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/image_file.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

class Previews : public test::CliTest {
  protected:
    test::ProgramResult expect_runs(std::vector<std::string> arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    PreviewHeader header(const std::string& name) const {
        return read_preview_header(folder_ / name).value_or(PreviewHeader{-1, 0});
    }
    /// The values of a PNG as encoded, 0 to 1.
    std::vector<float> values(const std::string& name) const {
        return read_image(folder_ / name).pixels;
    }
    /// Frames 1 and 2: in the second a wall stands closer to the camera, and is brighter.
    void write_walls() const {
        for (const auto& [name, z] : {std::pair{"wall_1.obj", "3"}, {"wall_2.obj", "1.5"}})
            write(name, std::string("v -9 -9 ") + z + "\nv 9 -9 " + z + "\nv 9 9 " + z +
                            "\nv -9 9 " + z + "\nf 1 2 3 4\n");
        std::string scene = test::k_small_scene;
        scene.insert(scene.find("  - {type: plane"), "  - {file: wall_#.obj}\n");
        write("walls.yaml", scene);
    }
};

TEST_F(Previews, AreMultipliedByTheExposureGiven) {
    expect_runs({"render", "scene.yaml", "-o", "out.exr", "--exposure", "7.5"});
    EXPECT_EQ(header("out.png").exposure, 7.5);
    const test::ImageFile image = test::read_exr(folder_ / "out.exr");
    const std::vector<float> png = values("out.png");
    std::size_t i = 0;
    for (std::size_t pixel = 0; pixel < 33 * 19; ++pixel)
        for (const char* channel : {"R", "G", "B"}) {
            // IEC 61966-2-1.
            const double x =
                std::min(1.0, 7.5 * static_cast<double>(image.channels.at(channel)[pixel]));
            const double encoded =
                x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
            // Half a step, and half floats in the EXR: 2^-11 of x.
            ASSERT_NEAR(static_cast<double>(png[i++]), encoded, 0.5 / 255 + 5e-4) << pixel;
        }
}

TEST_F(Previews, Of16BitsAreThoseOf8WithFinerSteps) {
    expect_runs({"render", "scene.yaml", "-o", "fine.exr", "--preview-bits", "16"});
    expect_runs({"render", "scene.yaml", "-o", "coarse.exr"});
    EXPECT_EQ(read("fine.exr"), read("coarse.exr"));
    EXPECT_EQ(header("fine.png").bits, 16);
    EXPECT_EQ(header("coarse.png").bits, 8);
    const std::vector<float> fine = values("fine.png"), coarse = values("coarse.png");
    ASSERT_EQ(fine.size(), coarse.size());
    std::size_t between = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        ASSERT_NEAR(fine[i], coarse[i], 0.5F / 255 + 1.0F / 65535);
        const float steps = 255 * fine[i];
        if (std::abs(steps - std::round(steps)) > 0.1F) ++between;
    }
    EXPECT_GT(between, fine.size() / 2);
}

TEST_F(Previews, OfASequenceKeepTheExposureOfTheFirst) {
    write_walls();
    const std::vector<std::string> frames{"render", "walls.yaml", "--frames", "1-2", "--quiet"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), frames.begin(), frames.end());
        return more;
    };
    expect_runs(with({"-o", "auto.#.exr"}));
    expect_runs(with({"-o", "first.#.exr", "--exposure", "first"}));
    EXPECT_LT(header("auto.2.png").exposure, 0.8 * header("auto.1.png").exposure);
    EXPECT_EQ(header("first.1.png").exposure, header("auto.1.png").exposure);
    EXPECT_EQ(header("first.2.png").exposure, header("first.1.png").exposure);
    // A run that continues writes the same bytes, and replaces previews of another exposure or
    // depth.
    const std::string second = read("first.2.png");
    std::filesystem::remove(folder_ / "first.2.exr");
    expect_runs(with({"-o", "first.#.exr", "--exposure", "first", "--resume"}));
    EXPECT_EQ(read("first.2.png"), second);
    std::filesystem::copy_file(folder_ / "auto.2.png", folder_ / "first.2.png",
                               std::filesystem::copy_options::overwrite_existing);
    expect_runs(with({"-o", "first.#.exr", "--exposure", "first", "--resume"}));
    EXPECT_EQ(read("first.2.png"), second);
    expect_runs(with({"-o", "first.#.exr", "--exposure", "3", "--preview-bits", "16", "--resume"}));
    EXPECT_EQ(header("first.1.png").exposure, 3);
    EXPECT_EQ(header("first.2.png").bits, 16);
}

TEST_F(Previews, AloneAreThoseBesideAnEXR) {
    expect_runs({"render", "scene.yaml", "-o", "out.exr"});
    const auto result = expect_runs({"render", "scene.yaml", "-o", "new/deep/out.png"});
    EXPECT_EQ(read("new/deep/out.png"), read("out.png"));
    EXPECT_FALSE(exists("new/deep/out.exr"));
    EXPECT_NE(result.err.find("wrote new/deep/out.png (R G B x "), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("warning"), std::string::npos) << result.err;
    for (const std::vector<std::string>& option : {std::vector<std::string>{"--layers", "all"},
                                                   {"--precision", "half"},
                                                   {"--compression", "zips"},
                                                   {"--frames", "1-2", "--resume"}}) {
        std::vector<std::string> arguments{"render", "scene.yaml", "-o", "out.##.png"};
        arguments.insert(arguments.end(), option.begin(), option.end());
        expect_failure(arguments, 2, "is a PNG alone; give a name that ends in .exr");
    }
    expect_failure({"render", "scene.yaml", "-o", "out.gif"}, 2, "ends in .exr, .png");
    expect_failure({"render", "scene.yaml", "--frames", "1-2", "-o", "out.png"}, 2,
                   "all frames would be written to one file");
}

TEST_F(Previews, AreAllOnAContactSheet) {
    write_walls();
    expect_runs({"render", "walls.yaml", "--frames", "1-2", "-o", "out.#.png", "--exposure",
                 "first", "--contact-sheet", "sheets/sheet.png"});
    const PixelImage sheet = read_image(folder_ / "sheets/sheet.png");
    // One column and two rows, or two columns and one row, make the sheet about 16:9.
    ASSERT_EQ(sheet.width, 4 + 1 * (33 + 4));
    ASSERT_EQ(sheet.height, 4 + 2 * (19 + 4));
    const PixelImage second = read_image(folder_ / "out.2.png");
    for (int y = 0; y < 19; ++y)
        for (int x = 0; x < 33 * 3; ++x)
            ASSERT_EQ(
                sheet.pixels[static_cast<std::size_t>((4 + 23 + y) * sheet.width * 3 + 12 + x)],
                second.pixels[static_cast<std::size_t>(y * 33 * 3 + x)]);
    expect_failure({"render", "walls.yaml", "--frames", "1-2", "-o", "out.#.png", "--contact-sheet",
                    "out.1.png"},
                   2, "would replace");
}

TEST_F(Previews, AreRefusedInOneLine) {
    expect_failure({"render", "scene.yaml", "--exposure", "-1"}, 2,
                   "a number above 0, auto or first");
    expect_failure({"render", "scene.yaml", "--exposure", "firts"}, 2, "auto or first");
    expect_failure({"render", "scene.yaml", "--preview-bits", "12"}, 2, "expected 8 or 16");
    expect_failure({"render", "scene.yaml", "--contact-sheet", "s.exr"}, 2, "ends in .png");
}

}  // namespace
}  // namespace uw
