// ctest labels: unit analytic
// Pictures through the views of OpenColorIO configs whose values can be written down.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/image/image_file.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

using Rgb = std::array<double, 3>;

constexpr auto k_spaces = R"(
displays:
  monitor:
    - !<View> {name: Plain, colorspace: plain}
    - !<View> {name: Warm, colorspace: plain, looks: warm}
  paper:
    - !<View> {name: Ink, colorspace: ink}
active_displays: []
active_views: []
looks:
  - !<Look>
    name: warm
    process_space: lin
    transform: !<CDLTransform> {slope: [1.2, 1, 0.5]}
  - !<Look>
    name: cold
    process_space: lin
    transform: !<CDLTransform> {slope: [0.5, 1, 1.2]}
colorspaces:
  - !<ColorSpace>
    name: lin
  - !<ColorSpace>
    name: plain
    from_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.7, 0.2, 0.1, 0, 0, 1, 0, 0, 0.1, 0.3, 0.6, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [2, 2, 2, 1], direction: inverse}
  - !<ColorSpace>
    name: ink
    from_reference: !<FileTransform> {src: ink.spi1d, interpolation: linear}
)";

Rgb plain(const Rgb& c) {
    return {std::sqrt(0.7 * c[0] + 0.2 * c[1] + 0.1 * c[2]), std::sqrt(c[1]),
            std::sqrt(0.1 * c[0] + 0.3 * c[1] + 0.6 * c[2])};
}

class ColourViews : public test::CliTest {
  protected:
    ColourViews() {
        std::filesystem::create_directories(folder_ / "luts");
        write("luts/ink.spi1d",
              "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n0.1\n0.7\n}\n");
        write_config("{scene_linear: lin, default: lin}");
    }
    void write_config(const std::string& roles, const std::string& name = "show.ocio") const {
        write(name, "ocio_profile_version: 1\nsearch_path: luts\nroles: " + roles + k_spaces);
    }
    /// Renders with this view, as written in the scene; the picture must be what `shown` makes of
    /// the light.
    void expect_shown(const std::string& view, const std::function<Rgb(const Rgb&)>& shown) const {
        const test::ProgramResult result =
            run({"render", "scene.yaml", "-o", "out.exr", "--precision", "float", "--exposure", "6",
                 "--preview-bits", "16", "--set", "render.view=" + view});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        expect_picture("out.png", shown);
    }
    void expect_picture(const std::string& name,
                        const std::function<Rgb(const Rgb&)>& shown) const {
        const test::ImageFile light = test::read_exr(folder_ / "out.exr");
        const test::ImageFile picture = test::read_exr(folder_ / name);
        const std::array<const char*, 3> channels{"R", "G", "B"};
        for (std::size_t i = 0; i < light.channels.at("R").size(); ++i) {
            Rgb rgb{};
            for (std::size_t c = 0; c < 3; ++c)
                rgb.at(c) = 6 * static_cast<double>(light.channels.at(channels.at(c))[i]);
            const Rgb truth = shown(rgb);
            for (std::size_t c = 0; c < 3; ++c)  // OpenColorIO's powers are good to 1e-5
                ASSERT_NEAR(static_cast<double>(picture.channels.at(channels.at(c))[i]),
                            std::clamp(truth.at(c), 0.0, 1.0), 5e-5)
                    << i << " " << c;
        }
    }
    test::ProgramResult run_with_ocio(const std::string& config,
                                      std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"OCIO=" + config, UWVDB_PROGRAM});
        return test::run_program(arguments, {.folder = folder_.path(), .program = "/usr/bin/env"});
    }
    void expect_refused(const std::string& view, const std::string& part) const {
        std::filesystem::remove(folder_ / "out.exr");
        expect_failure({"render", "scene.yaml", "-o", "out.exr", "--set", "render.view=" + view}, 3,
                       part);
        EXPECT_FALSE(exists("out.exr"));
    }
};

TEST_F(ColourViews, ShowWhatTheirConfigsSay) {
    expect_shown("{config: show.ocio}", plain);  // the first of each
    expect_shown("{config: show.ocio, display: monitor, view: Warm}", [](const Rgb& c) {
        return plain({1.2 * c[0], c[1], 0.5 * c[2]});
    });
    expect_shown("{config: show.ocio, view: Warm, look: cold}", [](const Rgb& c) {
        return plain({0.5 * c[0], c[1], 1.2 * c[2]});
    });
    expect_shown("{config: show.ocio, display: paper}", [](const Rgb& c) {
        Rgb shown{};
        for (std::size_t i = 0; i < 3; ++i) shown.at(i) = 0.1 + 0.6 * std::clamp(c.at(i), 0.0, 1.0);
        return shown;
    });
}

TEST_F(ColourViews, AreTakenFromTheEnvironment) {
    const std::vector<std::string> render{"render",     "scene.yaml", "-o",          "out.exr",
                                          "--exposure", "6",          "--precision", "float"};
    ASSERT_EQ(run(render).exit_code, 0);
    const std::string srgb = read("out.png");
    EXPECT_NE(srgb.find("sRGB"), std::string::npos);  // the chunk
    ASSERT_EQ(run_with_ocio("", render).exit_code, 0);
    EXPECT_EQ(read("out.png"), srgb);

    std::vector<std::string> fine = render;
    fine.insert(fine.end(), {"--preview-bits", "16"});
    const test::ProgramResult result = run_with_ocio("show.ocio", fine);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_picture("out.png", plain);
    EXPECT_EQ(read("out.png").find("sRGB"), std::string::npos);
    EXPECT_EQ(read_preview_header(folder_ / "out.png")->view, "Plain / monitor");

    // Other formats show the same, and the scene's own config comes first.
    ASSERT_EQ(run_with_ocio("nowhere.ocio", {"render", "scene.yaml", "-o", "out.tif", "--exposure",
                                             "6", "--set", "render.view={config: show.ocio}"})
                  .exit_code,
              0);
    expect_picture("out.tif", plain);
}

TEST_F(ColourViews, BeginWithLinearSrgbInAConfigOfOtherPrimaries) {
    // The role alone: values are brought to ACES2065-1 first (the Academy's matrix for BT.709).
    write_config("{aces_interchange: lin, default: lin}", "aces.ocio");
    expect_shown("{config: aces.ocio}", [](const Rgb& c) {
        return plain({0.4396329819 * c[0] + 0.3829886982 * c[1] + 0.1773783199 * c[2],
                      0.0897764430 * c[0] + 0.8134394287 * c[1] + 0.0967841283 * c[2],
                      0.0175411704 * c[0] + 0.1115465533 * c[1] + 0.8709122763 * c[2]});
    });
    expect_shown("{config: aces.ocio, input: lin}", plain);
    write_config("{default: lin}", "none.ocio");
    expect_refused("{config: none.ocio}", "which of its colour spaces is linear sRGB?");
}

TEST_F(ColourViews, AreMadeAnewWhenARunIsResumed) {
    const std::vector<std::string> render{"render",   "scene.yaml", "-o",      "f.#.exr",
                                          "--frames", "1-2",        "--resume"};
    ASSERT_EQ(run_with_ocio("show.ocio", render).exit_code, 0);
    const std::string again = run_with_ocio("show.ocio", render).err;
    EXPECT_NE(again.find("frames 1-2 are there already"), std::string::npos) << again;
    EXPECT_EQ(run(render).err.find("there already"), std::string::npos);
}

TEST_F(ColourViews, AreRefusedInOneLineThatSaysWhatThereIs) {
    expect_refused("{config: show.ocio, view: Fancy}",
                   "no view 'Fancy'; there are Plain, Warm for the display 'monitor'");
    expect_refused("{config: show.ocio, display: tv}", "no display 'tv'; there are monitor, paper");
    expect_refused("{config: show.ocio, look: '+warm, -wram'}",
                   "no look 'wram'; there are warm, cold");
    expect_refused("{config: show.ocio, input: aces}",
                   "no colour space 'aces'; there are lin, plain, ink");
    expect_refused("{view: Plain}", "which config? Add config: FILE.ocio, or set");
    expect_refused("{config: none.ocio}", "none.ocio");
    expect_refused("{config: scene.yaml}", "OpenColorIO cannot use it");
    expect_refused("{config: show.ocio, veiw: Plain}", "did you mean 'view'?");
    std::filesystem::remove(folder_ / "luts/ink.spi1d");
    expect_refused("{config: show.ocio, display: paper}", "ink.spi1d");
    const test::ProgramResult result =
        run_with_ocio("nowhere.ocio", {"render", "scene.yaml", "-o", "out.exr"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_NE(result.err.find("OCIO: 'nowhere.ocio': no such file; check the name of the Open"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(test::line_count(result.err), 1);
}

TEST_F(ColourViews, AreConfinedWithAllTheirFiles) {
    std::filesystem::create_directories(folder_ / "given");
    write("given/scene.yaml", test::k_small_scene);
    write_config("{scene_linear: lin}", "given/show.ocio");  // whose luts are not there
    const std::vector<std::string> render{"render",
                                          "given/scene.yaml",
                                          "-o",
                                          "out.exr",
                                          "--confine",
                                          "--set",
                                          "render.view={config: show.ocio}"};
    EXPECT_EQ(run(render).exit_code, 0);
    write("given/show.ocio",
          "ocio_profile_version: 1\nsearch_path: ../luts\nroles: {scene_linear: "
          "lin}" +
              std::string(k_spaces));
    expect_failure(render, 3, "luts/ink.spi1d: lies outside '");
    // What the user's own environment names may lie anywhere.
    EXPECT_EQ(
        run_with_ocio("show.ocio", {"render", "given/scene.yaml", "-o", "out.exr", "--confine"})
            .exit_code,
        0);
}

TEST_F(ColourViews, OfDataSetsAreTheScenesOwn) {
    const std::vector<std::string> make{"dataset", "scene.yaml", "-o", "set",  "--format",
                                        "png",     "--exposure", "6",  "--set"};
    const auto with = [&](const std::string& view) {
        std::vector<std::string> arguments = make;
        arguments.push_back("render.view=" + view);
        return arguments;
    };
    expect_failure(with("{view: Plain}"), 3, "a data set does not depend on the environment");
    ASSERT_EQ(run_with_ocio("nowhere.ocio", with("{config: show.ocio}")).exit_code, 0);
    ASSERT_EQ(run({"render", "scene.yaml", "-o", "one.png", "--exposure", "6", "--set",
                   "render.view={config: show.ocio}"})
                  .exit_code,
              0);
    bool is_found = false;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "set/images")) {
        is_found = true;
        EXPECT_EQ(read_image(entry.path()).pixels, read_image(folder_ / "one.png").pixels);
    }
    EXPECT_TRUE(is_found);
    EXPECT_NE(read("set/dataset.json").find("show.ocio"), std::string::npos);
}

TEST_F(ColourViews, AreRefusedWithoutTheirModule) {
    std::filesystem::copy_file(UWVDB_PROGRAM, folder_ / "alone");
    const test::ProgramResult result = test::run_program(
        {"render", "scene.yaml", "-o", "out.exr", "--set", "render.view={config: show.ocio}"},
        {.folder = folder_.path(), .program = folder_ / "alone"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("a view needs OpenColorIO (the module uwvdb_colour_views is not "
                              "installed); run scripts/demo in the repository"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(test::line_count(result.err), 1);
}

}  // namespace
}  // namespace uw
