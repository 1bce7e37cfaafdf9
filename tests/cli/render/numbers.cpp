// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/csv_table.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

class RenderNumbers : public test::CliTest {
  protected:
    RenderNumbers() {
        write("two.yaml", std::string(test::k_small_scene) +
                              "  - {name: right, position: [0.5, 0.2, 0], intensity: 20}\n");
    }
    test::ProgramResult expect_runs(std::vector<std::string> arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
};

TEST_F(RenderNumbers, LeaveTheImageAsItIs) {
    expect_runs({"render", "two.yaml", "-o", "a.exr", "--quiet"});
    const auto result = expect_runs({"render", "two.yaml", "-o", "b,1.exr", "--quiet", "--numbers",
                                     "n.csv", "--stats", "s.json", "--object", "box"});
    EXPECT_EQ(read("a.exr"), read("b,1.exr"));
    EXPECT_EQ(read("a.png"), read("b,1.png"));
    // A name with a comma is in quotes.
    const std::string csv = read("n.csv");
    EXPECT_TRUE(csv.starts_with("image,frame,part,lamp,pixels,direct_mean,")) << csv;
    for (const char* row : {"\n\"b,1.exr\",,image,all,627,", "\n\"b,1.exr\",,box,all,",
                            "\n\"b,1.exr\",,image,left,", "\n\"b,1.exr\",,box,right,"})
        EXPECT_NE(csv.find(row), std::string::npos) << row;
    EXPECT_EQ(test::line_count(csv), 1 + 2 * 3);
    const auto stats = nlohmann::json::parse(read("s.json"));
    ASSERT_EQ(stats["numbers"].size(), 6U);
    EXPECT_EQ(stats["numbers"][0]["part"], "image");
    EXPECT_TRUE(stats["numbers"][0]["lamp"].is_null());
    EXPECT_EQ(stats["numbers"][5]["lamp"], "right");
    const double all = stats["numbers"][1]["direct_mean"];
    EXPECT_GT(all, 0);
    EXPECT_NEAR(static_cast<double>(stats["numbers"][3]["direct_mean"]) +
                    static_cast<double>(stats["numbers"][5]["direct_mean"]),
                all, 1e-5 * all);
    EXPECT_TRUE(stats["seconds"].contains("numbers"));
}

TEST_F(RenderNumbers, OfThePixelsThatTheLayersHold) {
    const test::ImageFile image = render({"--numbers", "n.csv", "--part", "4,3,14,9"});
    double direct = 0, backscatter = 0;
    for (int y = 3; y < 9; ++y)
        for (int x = 4; x < 14; ++x)
            for (const char* band : {"R", "G", "B"}) {
                const auto at = static_cast<std::size_t>(y * 33 + x);
                direct += image.channels.at(std::string("direct.") + band)[at] / 180;
                backscatter += image.channels.at(std::string("backscatter.") + band)[at] / 180;
            }
    const CsvTable part = CsvTable(read("n.csv"), "n.csv").where("part", "part");
    EXPECT_NEAR(part.numbers("direct_mean")[0], direct, 1e-6 * direct);
    EXPECT_NEAR(part.numbers("backscatter")[0], backscatter, 1e-6 * backscatter);
    EXPECT_NEAR(part.numbers("signal_to_backscatter")[0], direct / backscatter, 1e-5);
    // Within a crop the same pixels have the same numbers.
    render({"--numbers", "c.csv", "--part", "4,3,14,9", "--crop", "2,2,20,18"});
    const CsvTable cropped = CsvTable(read("c.csv"), "c.csv").where("part", "part");
    for (const std::string& column : part.columns())
        EXPECT_EQ(cropped.text(column), part.text(column)) << column;
}

TEST_F(RenderNumbers, ArePrintedAsATable) {
    const auto result =
        expect_runs({"render", "two.yaml", "-o", "a.exr", "--quiet", "--numbers", "-"});
    EXPECT_TRUE(result.out.starts_with("a.exr\npart ")) << result.out;
    EXPECT_EQ(test::line_count(result.out), 2 + 3);
    EXPECT_NE(result.out.find("right"), std::string::npos);
}

TEST_F(RenderNumbers, OfSequencesAreInOneTable) {
    expect_runs(
        {"render", "scene.yaml", "--frames", "3-4", "-o", "a.##.exr", "--numbers", "n.csv"});
    const CsvTable table(read("n.csv"), "n.csv");
    EXPECT_EQ(table.text("frame"), (std::vector<std::string>{"3", "3", "4", "4"}));
    EXPECT_EQ(table.text("image")[3], "a.04.exr");
}

TEST_F(RenderNumbers, AreRefusedInOneLine) {
    expect_failure({"render", "scene.yaml", "--object", "box"}, 2, "give --numbers as well");
    expect_failure({"render", "scene.yaml", "--numbers", "n.csv", "--object", "bix"}, 2,
                   "the scene has 1 (plane), 2 (box)");
    expect_failure({"render", "scene.yaml", "--numbers", "n.csv", "--part", "0,0,2"}, 2,
                   "--part: expected x0,y0,x1,y1");
    expect_failure({"render", "scene.yaml", "--numbers", "n.json"}, 2, "ends in .csv");
    expect_failure({"render", "scene.yaml", "--numbers", "scene.yaml/n.csv"}, 4, "not a folder");
    EXPECT_EQ(file_count(), 2U);
}

}  // namespace
}  // namespace uw
