// ctest labels: unit slow
// What a set has besides its formats' files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "core/base/csv_table.h"
#include "core/base/json.h"
#include "core/image/image_file.h"
#include "dataset/set_files.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

class DatasetCompletion : public test::DatasetTest {};

TEST_F(DatasetCompletion, ThePageShowsFilesThatAreThereAndNothingElse) {
    make("moving.yaml", "clean", {"--licence", "<b>&\"mine\"</b>"});
    const std::string page = read("set/index.html");
    EXPECT_EQ(page.find("http"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_NE(page.find("--licence &#39;&lt;b&gt;&amp;&quot;mine&quot;&lt;/b&gt;&#39;"),
              std::string::npos)
        << page;
    const std::regex link("(?:src|href)=\"([^\"]*)\"");
    int pictures = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), link), end; at != end; ++at) {
        const std::string file = (*at)[1];
        EXPECT_TRUE(exists("set/" + file)) << file;
        pictures += file.ends_with(".png") ? 1 : 0;
    }
    EXPECT_EQ(pictures, 2 * 2 * 7);  // the image and the clean one, each with a link
    const PixelImage sheet = read_image(folder_ / "set/contact_sheet.png");
    EXPECT_GE(sheet.width, 3 * 40);
}

TEST_F(DatasetCompletion, TheManifestListsEveryViewAndFile) {
    make("pair.yaml", "png,depth,colmap");
    const CsvTable csv(read("set/manifest.csv"), "manifest.csv");
    ASSERT_EQ(csv.row_count(), 2U);
    EXPECT_EQ(csv.text("camera"), (std::vector<std::string>{"left", "right"}));
    EXPECT_EQ(csv.numbers("tx"), (std::vector<double>{0, 0.1}));
    const Json json = Json::parse(read("set/manifest.json"));
    ASSERT_EQ(json.at("views").size(), 2U);
    for (const Json& view : json.at("views")) {
        EXPECT_TRUE(exists("set/" + view.at("record").get<std::string>()));
        for (const auto& [role, file] : view.at("files").items())
            EXPECT_TRUE(exists("set/" + file.get<std::string>())) << role;
        EXPECT_TRUE(view.at("files").contains("depth"));
    }
}

TEST_F(DatasetCompletion, RecordsNameTheirFramesAsTheManifestDoes) {
    make("moving.yaml", "png", {"--frames", "2,5"});
    const Json manifest = Json::parse(read("set/manifest.json"));
    for (const Json& view : manifest.at("views")) {
        const Json record = Json::parse(read("set/" + view.at("record").get<std::string>()));
        EXPECT_EQ(record.at("frame"), view.at("frame"));
    }
    const Json last = Json::parse(read("set/views/000005.json"));
    EXPECT_EQ(last.at("frame"), 5);
    // By which the same command knows them again.
    const auto written = fs::last_write_time(folder_ / "set/views/000005.json");
    make("moving.yaml", "png", {"--frames", "2,5"});
    EXPECT_EQ(fs::last_write_time(folder_ / "set/views/000005.json"), written);
    EXPECT_NE(read("set/README.md").find("2 views (1 draw × 2 frames × 1 camera)"),
              std::string::npos);
}

TEST_F(DatasetCompletion, CountsOneViewAsOne) {
    const test::ProgramResult made = run({"dataset", "scene.yaml", "-o", "set"});
    EXPECT_TRUE(made.err.ends_with("set: complete, 1 view\n")) << made.err;
    EXPECT_TRUE(Json::parse(read("set/views/000000.json")).at("frame").is_null());
    EXPECT_NE(read("set/README.md").find("1 view (1 draw × 1 frame × 1 camera)"),
              std::string::npos);
    EXPECT_NE(read("set/index.html").find("<p>1 view."), std::string::npos);
}

// In water that scatters as much as it absorbs a set of single scattering lacks light, and says so.
TEST_F(DatasetCompletion, TheCardTellsOfTheLightLeftOut) {
    const auto said_by = [&](const std::string& folder, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"dataset",  "moving.yaml", "-o",       folder,
                                           "--format", "png",         "--frames", "0-1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    };
    const std::string words = "single scattering leaves out about ";
    const std::string said = said_by("single", {});
    const std::size_t begin = said.find("note: " + words);
    ASSERT_NE(begin, std::string::npos) << said;
    const std::string note = said.substr(begin + 6, said.find('\n', begin) - begin - 6);
    EXPECT_TRUE(note.ends_with("; render.scattering: multiple renders it")) << note;
    EXPECT_NE(read("single/README.md").find("- light: " + note + "\n"), std::string::npos);
    // What it says is what a run of one image says.
    const test::ProgramResult image =
        run({"render", "moving.yaml", "--frames", "0", "-o", "x.exr"});
    const Json left_out = Json::parse(read("single/dataset.json")).at("facts").at("light_left_out");
    const std::size_t at = image.err.find(words);
    ASSERT_NE(at, std::string::npos) << image.err;
    const double percent = std::stod(image.err.substr(at + words.size()));
    EXPECT_NEAR(percent, 100 * left_out.at("most").get<double>(), 5);
    EXPECT_EQ(said_by("fixed", {"--exposure", "2"}).find("note: " + words), 0U);
    // Too little to speak of: the card has it all the same.
    EXPECT_EQ(said_by("clear", {"--set", "water.scattering.b=0.001"}).find(words),
              std::string::npos);
    EXPECT_NE(read("clear/README.md").find("- light: " + words), std::string::npos);
    EXPECT_EQ(said_by("all", {"--set", "render.scattering=multiple"}).find(words),
              std::string::npos);
    EXPECT_EQ(read("all/README.md").find(words), std::string::npos);
}

// Draws of other waters leave out other shares: the card has the least and the most.
TEST_F(DatasetCompletion, TheCardTellsOfTheLightThatDrawsLeaveOut) {
    write("varied.yaml", read("scene.yaml") +
                             "variations: {keys: {water.scattering.b: {uniform: [0.01, 0.4]}}}\n");
    const test::ProgramResult result =
        run({"dataset", "varied.yaml", "-o", "set", "--format", "png", "--variations", "8"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json left_out = Json::parse(read("set/dataset.json")).at("facts").at("light_left_out");
    EXPECT_EQ(left_out.at("views"), 5);
    EXPECT_GT(left_out.at("most").get<double>(), left_out.at("least").get<double>() + 0.02);
    EXPECT_NE(
        read("set/README.md")
            .find(fmt::format("leaves out about {:.0f} to {:.0f} % of the light of the 5 views",
                              100 * left_out.at("least").get<double>(),
                              100 * left_out.at("most").get<double>())),
        std::string::npos);
}

// The card's command makes the same set, to the byte.
TEST_F(DatasetCompletion, TheCardTellsHowToMakeTheSetAgain) {
    make("moving.yaml", "exr,npy,depth",
         {"--frames",      "1-5:2,6", "--set",       "water.absorption=[0.4, 0.1, 0.06]",
          "--size",        "20x15",   "--quality",   "draft",
          "--layers",      "normal",  "--exposure",  "1.5",
          "--image-bits",  "16",      "--depth-far", "3.5",
          "--depth-scale", "2000",    "--licence",   "it's CC BY 4.0"});
    const std::string card = read("set/README.md");
    EXPECT_NE(card.find("- licence: it's CC BY 4.0\n"), std::string::npos);
    EXPECT_NE(card.find("| 620 | 0.4 | 0.2 | 0.6 |"), std::string::npos) << card;
    EXPECT_NE(card.find("- `left`: fixed to the camera, position (-0.5, -0.2, 0)"),
              std::string::npos);
    const std::string before = "- command: `uwvdb ";
    const std::size_t begin = card.find(before) + before.size();
    const std::string options = card.substr(begin, card.find("`\n", begin) - begin);
    const std::string again = fmt::format("cd '{}' && '{}' {} -o again --quiet",
                                          folder_.path().string(), UWVDB_PROGRAM, options);
    ASSERT_EQ(std::system(again.c_str()), 0) << again;
    EXPECT_EQ(read("again/SHA256SUMS"), read("set/SHA256SUMS"));
}

TEST_F(DatasetCompletion, RemovesWhatKilledProcessesLeft) {
    make("pair.yaml", "png");
    write("set/images/left/.uwvdb-123-4.tmp", "half a file");
    make("pair.yaml", "png");
    EXPECT_FALSE(exists("set/images/left/.uwvdb-123-4.tmp"));
}

}  // namespace
}  // namespace uw
