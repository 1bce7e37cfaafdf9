// ctest labels: unit
//
// Advice on sequences: what is empty, how it changes, and that it is the same for every frame.
// Where there is something to map, each call takes seconds, for the drafts by which it judges.
#include "cli/info/vdb_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

class Sequences : public test::CliTest {
  protected:
    /// A bar of `length` voxels of one value; none: an empty grid.
    void frame(int number, int length, double value = 1) const {
        test::VdbFixture bar;
        if (length > 0) bar.boxes = {{{0, 0, 0}, {length - 1, 9, 9}, value}};
        bar.file_from_index = Affine::scale(Vector3(0.05));
        test::write_fixture(folder_ / ("s_" + std::to_string(1000 + number) + ".vdb"), {bar});
    }
    ParsedJson info(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"info", "s_####.vdb", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ParsedJson::parse(result.out);
    }
    static bool says(const ParsedJson& json, const std::string& part) {
        return std::ranges::any_of(json.at("advice").at("lines"), [&](const ParsedJson& line) {
            return line.get<std::string>().find(part) != std::string::npos;
        });
    }
};

TEST_F(Sequences, HaveOneAdviceWhicheverFrameIsLookedAt) {
    frame(1, 0);
    frame(2, 0);
    frame(3, 10, 0.5);
    frame(4, 30);
    const ParsedJson all = info();
    EXPECT_EQ(all.at("sequence").at("empty"), ParsedJson({1001, 1002}));
    ASSERT_EQ(all.at("sequence").at("frame"), 1003);  // the first with anything in it
    EXPECT_EQ(all.at("advice").at("map"), ParsedJson({"density"}));
    for (const char* number : {"1001", "1004"}) {
        const ParsedJson one = info({"--frame", number});
        EXPECT_EQ(one.at("sequence").at("frame").dump(), number);
        EXPECT_EQ(one.at("advice"), all.at("advice")) << number;
    }
    // Bounds of the longest frame: 30 nodes, each with its cell.
    const ParsedJson& bounds = all.at("advice").at("world_bounds");
    EXPECT_NEAR(bounds.at("max")[0].get<double>() - bounds.at("min")[0].get<double>(), 1.5, 1e-6);
    EXPECT_EQ(all.at("sequence").at("largest"), ParsedJson({0.5, 1.0}));
    EXPECT_TRUE(says(all, "the largest value lies between 0.5 (frame 1003) and 1 (frame 1004)"));
}

TEST_F(Sequences, SayWhereTheirRangeFlickersAndWhatCannotBeRead) {
    frame(1, 20, 1);
    frame(2, 20, 10);
    frame(3, 20, 9);
    write("s_1004.vdb", "this is no volume");
    const ParsedJson json = info();
    EXPECT_TRUE(says(json, "changes by a factor of 10 from frame 1001 to frame 1002"));
    EXPECT_FALSE(says(json, "from frame 1002 to frame 1003"));
    EXPECT_TRUE(says(json, "A frame cannot be read: s_1004.vdb"));
    EXPECT_EQ(json.at("advice").at("map"), ParsedJson({"density"}));
}

TEST_F(Sequences, WithNothingInThemSaySo) {
    frame(1, 0);
    frame(2, 0);
    const ParsedJson json = info();
    EXPECT_TRUE(says(json, "No frame of the sequence holds anything to map"));
    EXPECT_EQ(json.at("sequence").at("empty"), ParsedJson({1001, 1002}));
    const test::ProgramResult text = run({"info", "s_####.vdb"});
    EXPECT_NE(text.out.find("hold nothing to map: 1001-1002"), std::string::npos) << text.out;
    expect_failure({"info", "s_####.vdb", "--scene"}, 3, "Nothing to map");
}

}  // namespace
}  // namespace uw
