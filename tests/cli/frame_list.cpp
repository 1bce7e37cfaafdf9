// ctest labels: unit
#include "cli/image_choice.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace uw {
namespace {

using Frames = std::vector<int>;

TEST(FrameList, RangesStepsAndOrder) {
    EXPECT_EQ(parse_frame_list("7"), Frames{7});
    EXPECT_EQ(parse_frame_list("0"), Frames{0});
    EXPECT_EQ(parse_frame_list("0008"), Frames{8});
    EXPECT_EQ(parse_frame_list("1-4"), (Frames{1, 2, 3, 4}));
    EXPECT_EQ(parse_frame_list("5-5"), Frames{5});
    EXPECT_EQ(parse_frame_list("1-3,20-26:2"), (Frames{1, 2, 3, 20, 22, 24, 26}));
    EXPECT_EQ(parse_frame_list("20-25:2"), (Frames{20, 22, 24}));
    EXPECT_EQ(parse_frame_list("1-9:4,1-5"), (Frames{1, 5, 9, 2, 3, 4}));  // coarse first
    EXPECT_EQ(parse_frame_list("999999999"), Frames{999999999});
    EXPECT_EQ(parse_frame_list("0-999999999:999999999"), (Frames{0, 999999999}));
}

TEST(FrameList, WhatIsNoneIsRefusedWithTheMend) {
    const auto refusal = [](const char* text) -> std::string {
        try {
            parse_frame_list(text);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "accepted";
    };
    for (const char* text : {"", ",", "1,", ",1", "a", "1-", "-1", "1--2", "1-2-3", "1:2",
                             "1-5:", "1-5:x", "1.5", "1 2", "1-4:-1", "0x10", "1-\n"}) {
        EXPECT_NE(refusal(text).find("expected frames such as 7, 1-10 or 20-40:2"),
                  std::string::npos)
            << text << ": " << refusal(text);
    }
    EXPECT_EQ(refusal("1-3,10-1"), "--frames: '10-1': begins after its end; write 1-10");
    EXPECT_EQ(refusal("1-9:0"),
              "--frames: '1-9:0': a step of 0 leads nowhere; write 1 or more after the colon");
    EXPECT_NE(refusal("1000000000").find("0 to 999999999"), std::string::npos);
    EXPECT_NE(refusal("99999999999999999999").find("0 to 999999999"), std::string::npos);
    EXPECT_NE(refusal("0-999999999").find("more than a million"), std::string::npos);
}

TEST(FrameList, IsWrittenShort) {
    EXPECT_EQ(format_frame_list({}), "");
    EXPECT_EQ(format_frame_list({4}), "4");
    EXPECT_EQ(format_frame_list({9, 3, 5, 4}), "3-5,9");
    EXPECT_EQ(format_frame_list({1, 2, 4, 6, 7}), "1-2,4,6-7");
    Frames even;
    for (int i = 0; i < 60; ++i) even.push_back(2 * i);
    EXPECT_TRUE(format_frame_list(even).ends_with(",96,98 and 10 more"));
    for (const char* text : {"1-10", "1-3,8,10-12"})
        EXPECT_EQ(format_frame_list(parse_frame_list(text)), text);
}

}  // namespace
}  // namespace uw
