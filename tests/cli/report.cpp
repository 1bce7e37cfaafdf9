// ctest labels: unit
#include "cli/report.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

Report report_on_fish() {
    Report report;
    report.set({{"version", 1}});
    Report pond("pond");
    pond.say("3 m deep");
    pond.set({{"depth", 3}, {"size", {4, 5}}});
    report.add("pond", pond);
    std::vector<Report> fish;
    for (const char* name : {"carp", "pike"}) {
        Report& one = fish.emplace_back();
        one.say(name);
        one.set({{"name", name}});
    }
    report.add("fish", fish, "fish");
    report.say("\nafter a blank line\n");
    return report;
}

TEST(Report, TextHasLinesBelowTheirHeadings) {
    EXPECT_EQ(report_on_fish().text(),
              "pond\n  3 m deep\nfish\n  carp\n  pike\n\nafter a blank line\n");
}

TEST(Report, WithoutAHeadingLinesStandWhereItWouldBe) {
    Report report("outer");
    Report inner;
    inner.say("one\n  two");
    report.add("inner", inner);
    report.add("none", std::vector<Report>{});
    EXPECT_EQ(report.text(), "outer\n  one\n    two\n");
}

TEST(Report, JsonHasValuesInTheOrderInWhichTheyWereAdded) {
    EXPECT_EQ(Json::parse(report_on_fish().json()).dump(),
              R"({"version":1,"pond":{"depth":3,"size":[4,5]},)"
              R"("fish":[{"name":"carp"},{"name":"pike"}]})");
    EXPECT_EQ(report_on_fish().printed(true), report_on_fish().json());
}

TEST(Report, JsonOfAnEmptyListOrSectionIsEmpty) {
    Report report, section;
    section.say("text alone");
    report.add("section", section);
    report.add("list", std::vector<Report>{});
    EXPECT_EQ(Json::parse(report.json()).dump(), R"({"section":{},"list":[]})");
}

TEST(AlignedRows, AreAsWideAsTheirWidestCells) {
    EXPECT_EQ(
        aligned_rows({{"name", "value"}, {"a", "1"}, {"long name", "10"}}, 1),
        (std::vector<std::string>{"name       value", "a              1", "long name     10"}));
    EXPECT_EQ(aligned_rows({{"1", "2"}}, 0, 3), std::vector<std::string>{"  1    2"});
}

}  // namespace
}  // namespace uw
