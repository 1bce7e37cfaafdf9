// ctest labels: unit
// `uwvdb render --integrator path`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

class Paths : public test::CliTest {
  protected:
    static std::vector<std::string> with(std::vector<std::string> more) {
        more.insert(more.begin(), {"--integrator", "path", "--size", "12x8"});
        return more;
    }
    void refused(std::vector<std::string> more, int exit_code, const std::string& part) const {
        more.insert(more.begin(), {"render", "scene.yaml", "-o", "out.exr"});
        expect_failure(more, exit_code, part);
        EXPECT_FALSE(exists("out.exr"));
    }
};

TEST_F(Paths, HaveLayersAndAHeaderOfTheirOwn) {
    const ImageFile image =
        render(with({"--samples", "20", "--layers", "all", "--orders", "1", "--stats", "s.json"}));
    for (const char* const name :
         {"multiple.R", "multiple.volume.G", "multiple.surface.B", "error.R", "lamp.left.G",
          "order.0.R", "order.more.B", "reflections.1.G", "depth.Z"})
        EXPECT_TRUE(image.channels.contains(name)) << name;
    test::expect_finite_and_lit(image);
    EXPECT_EQ(image.metadata.at("uwvdb/integrator"), "path");
    EXPECT_EQ(image.metadata.at("uwvdb/scattering"), "multiple");
    EXPECT_EQ(image.metadata.at("uwvdb/samples"), "20");
    EXPECT_EQ(image.metadata.at("uwvdb/seed"), "0: the same paths every time");
    const nlohmann::json stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats.at("samples"), 20);
    EXPECT_GT(stats.at("error"), 0);
    EXPECT_EQ(stats.at("camera_rays"), 12 * 8 * 20);

    const ImageFile single = render({"--size", "12x8", "--layers", "all"});
    EXPECT_FALSE(single.channels.contains("multiple.R"));
    EXPECT_FALSE(single.channels.contains("error.R"));
    EXPECT_FALSE(single.metadata.contains("uwvdb/scattering"));
}

/// Walks between surfaces pass through water that has nothing to scatter them with.
TEST_F(Paths, NeedNoScatteringWater) {
    const std::string clear = "water.scattering={b: 0, phase: {type: hg, g: 0.9}}";
    const ImageFile image = render(with({"--samples", "64", "--layers", "all", "--set", clear}));
    const ImageFile single = render({"--size", "12x8", "--set", clear, "--samples", "64"});
    double direct = 0, truth = 0, reflected = 0;
    for (const char* const band : {"R", "G", "B"}) {
        const std::string layer = std::string("direct.") + band;
        for (std::size_t i = 0; i < image.channels.at(layer).size(); ++i) {
            direct += static_cast<double>(image.channels.at(layer)[i]);
            truth += static_cast<double>(single.channels.at(layer)[i]);
            EXPECT_EQ(image.channels.at(std::string("backscatter.") + band)[i], 0);
            EXPECT_EQ(image.channels.at(std::string("multiple.volume.") + band)[i], 0);
            reflected +=
                static_cast<double>(image.channels.at(std::string("multiple.surface.") + band)[i]);
        }
    }
    EXPECT_NEAR(direct / truth, 1, 0.02);  // 64 rays in each of 96 pixels, some at an edge
    EXPECT_GT(reflected, 0);               // the box lights the wall
}

TEST_F(Paths, AreAsManyAsTheErrorNeeds) {
    const test::ProgramResult result =
        run({"render", "scene.yaml", "-o", "out.exr", "--integrator", "path", "--size", "12x8",
             "--error", "0.2", "--stats", "s.json", "--layers", "error"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find(" samples, error "), std::string::npos) << result.err;
    const nlohmann::json stats = nlohmann::json::parse(read("s.json"));
    EXPECT_LE(stats.at("error"), 0.2);
    EXPECT_GE(stats.at("samples"), 16);
    const ImageFile image = test::read_exr(folder_ / "out.exr");
    EXPECT_EQ(image.metadata.at("uwvdb/samples"), stats.at("samples").dump());
    EXPECT_EQ(image.metadata.at("uwvdb/error_requested"), "0.2");
}

TEST_F(Paths, AreSixteenUnlessRequestedAndFewInDrafts) {
    EXPECT_EQ(render(with({})).metadata.at("uwvdb/samples"), "16");
    EXPECT_EQ(render(with({"--quality", "draft"})).metadata.at("uwvdb/samples"), "4");
    write("scene.yaml", std::string(test::k_small_scene) + "render: {samples: 3}\n");
    EXPECT_EQ(render(with({})).metadata.at("uwvdb/samples"), "3");
}

TEST_F(Paths, AreNotTracedAgainToResume) {
    const std::vector<std::string> sequence{
        "render", "scene.yaml", "--frames", "2-3",     "-o",  "{frame}.exr", "--integrator",
        "path",   "--size",     "8x6",      "--error", "0.3", "--resume"};
    EXPECT_EQ(run(sequence).exit_code, 0);
    const test::ProgramResult again = run(sequence);
    EXPECT_NE(again.err.find("resume: frames 2-3 are there already"), std::string::npos)
        << again.err;
    EXPECT_EQ(read("2.exr").size(), read("3.exr").size());
    std::vector<std::string> closer = sequence;
    closer[11] = "0.25";
    EXPECT_EQ(run(closer).err.find("there already"), std::string::npos);
}

TEST_F(Paths, AreRefusedWhereTheyMakeNoSense) {
    refused({"--error", "0.1"}, 2, "--error: is for --integrator path only");
    refused({"--orders", "2"}, 2, "--orders: is for --integrator path only");
    refused(with({"--error", "0.1", "--samples", "4"}), 2, "--samples and --error: each says");
    refused({"--samples", "4097"}, 2, "--samples: expected 1 to 4096, found 4097; only integrator");
    refused({"--layers", "multiple"}, 2, "--layers: multiple: the scene is rendered with single");
    refused({"--layers", "error"}, 2, "--layers: error: only all light has a standard error");
    refused(with({"--layers", "order.1"}), 2, "written with --orders N");
    refused(with({"--set", "render.scattering=single"}), 3, "always renders all light");
    refused({"--integrator", "planes", "--set", "render.scattering=multiple"}, 3,
            "use integrator volume or path");
    refused(with({"--set", "water.forward_scatter={K: 1, G: 0.02, B: 0.1}"}), 3,
            "would count twice");
    refused(with({"--set", "render.output=paper", "--set",
                  "camera.lens={f_number: 2.8, focal_length: 0.0085}"}),
            3, "the paper's formula");
}

// What the fast form of multiple scattering says of its own error.
TEST_F(Paths, OfTheFastFormHaveAStatedError) {
    const std::vector<std::string> fast{
        "render",    "scene.yaml", "-o",      "out.exr", "--size", "12x8",
        "--quality", "draft",      "--stats", "s.json",  "--set",  "render.scattering=multiple",
        "--layers",  "all"};
    const test::ProgramResult result = run(fast);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("multiple scattering: standard error "), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find(" % of the image's mean (red "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(" % of the bands')\n"), std::string::npos) << result.err;
    const nlohmann::json stats = nlohmann::json::parse(read("s.json"));
    EXPECT_GT(stats.at("multiple_error"), 0);
    EXPECT_LT(stats.at("multiple_error"), 0.1);
    ASSERT_EQ(stats.at("multiple_error_of_bands").size(), 3U);
    for (const nlohmann::json& of_band : stats.at("multiple_error_of_bands")) {
        EXPECT_GT(of_band, 0);
        EXPECT_LT(of_band, 0.1);
    }
    EXPECT_NE(result.err.find(" % of the light in each part of the image, "), std::string::npos)
        << result.err;
    EXPECT_GT(stats.at("multiple_error_of_parts"), 0);
    EXPECT_GT(stats.at("multiple_error_of_worst_part"), stats.at("multiple_error_of_parts"));
    EXPECT_FALSE(stats.contains("error"));
    EXPECT_FALSE(stats.contains("samples"));
    EXPECT_TRUE(stats.at("seconds").contains("multiple scattering"));
    const ImageFile image = test::read_exr(folder_ / "out.exr");
    EXPECT_NEAR(std::stod(image.metadata.at("uwvdb/multiple_error")), stats.at("multiple_error"),
                1e-6);
    EXPECT_TRUE(image.metadata.contains("uwvdb/multiple_error_of_bands"));
    EXPECT_NEAR(std::stod(image.metadata.at("uwvdb/multiple_error_of_parts")),
                stats.at("multiple_error_of_parts"), 1e-6);
    EXPECT_TRUE(image.metadata.contains("uwvdb/multiple_error_of_worst_part"));
    EXPECT_FALSE(image.metadata.contains("uwvdb/error"));
    EXPECT_TRUE(image.channels.contains("error.R"));
    EXPECT_EQ(image.metadata.at("uwvdb/scattering"), "multiple");
    EXPECT_TRUE(image.channels.contains("multiple.volume.R"));
}

TEST_F(Paths, AreRecommendedWhereLampsLieTooFarForTheFastForm) {
    std::vector<std::string> far{"--size",    "8x6",
                                 "--quality", "draft",
                                 "--set",     "render.scattering=multiple",
                                 "--set",     "water.absorption=50"};
    far.insert(far.begin(), {"render", "scene.yaml", "-o", "out.exr"});
    const std::string said = run(far).err;
    EXPECT_NE(said.find("warning: multiple scattering: the nearest lamp lies behind an optical "
                        "depth of 2"),
              std::string::npos)
        << said;
    far.back() = "water.absorption=1";
    EXPECT_EQ(run(far).err.find("the nearest lamp"), std::string::npos);
}

}  // namespace
}  // namespace uw
