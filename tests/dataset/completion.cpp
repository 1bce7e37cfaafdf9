// ctest labels: unit
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
    for (const Json& view : Json::parse(read("set/manifest.json")).at("views")) {
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
    make("scene.yaml", "png");
    EXPECT_TRUE(Json::parse(read("set/views/000000.json")).at("frame").is_null());
    EXPECT_NE(read("set/README.md").find("1 view (1 draw × 1 frame × 1 camera)"),
              std::string::npos);
    EXPECT_NE(read("set/index.html").find("<p>1 view."), std::string::npos);
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
