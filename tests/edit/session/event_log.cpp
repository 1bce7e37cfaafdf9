// ctest labels: unit threads
#include "edit/session/edit_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace {

using namespace uw;

TEST(EventLog, WindowsFollowAtTheirOwnPace) {
    EventLog log;
    log.publish("state", "1");
    log.publish("image", "2");
    const auto all = log.wait(0, 10);
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].name, "state");
    EXPECT_EQ(all[1].data, "2");
    const auto rest = log.wait(all[0].number, 10);
    ASSERT_EQ(rest.size(), 1U);
    EXPECT_EQ(rest[0].name, "image");
    EXPECT_EQ(log.last(), all[1].number);
    EXPECT_TRUE(log.wait(log.last(), 0.01).empty());
}

TEST(EventLog, WaitingEndsWithAnEventOrTheLog) {
    EventLog log;
    std::thread publisher([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        log.publish("state", "1");
    });
    EXPECT_EQ(log.wait(0, 60).size(), 1U);
    publisher.join();
    std::thread closer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        log.close();
    });
    EXPECT_TRUE(log.wait(log.last(), 60).empty());
    EXPECT_TRUE(log.is_closed());
    closer.join();
}

TEST(EventLog, KeepsTheLatest) {
    EventLog log;
    for (int i = 0; i < 1000; ++i) log.publish("progress", std::to_string(i));
    const auto kept = log.wait(0, 10);
    EXPECT_EQ(kept.size(), 256U);
    EXPECT_EQ(kept.back().data, "999");
}

}  // namespace
