// ctest labels: unit
#include "edit/document/scene_document.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace uw {
namespace {

TEST(TextHistory, UndoesAndRedoesEveryStep) {
    std::mt19937 random(3);
    TextHistory history("start");
    std::vector<std::string> texts{"start"};
    for (int i = 0; i < 5000; ++i) {
        std::string text = history.text();
        const std::size_t at = random() % (text.size() + 1);
        if (random() % 2 == 0 || text.empty())
            text.insert(at, std::string(1 + random() % 3, static_cast<char>('a' + random() % 3)));
        else
            text.erase(at, random() % 4);
        if (text == history.text()) continue;
        history.record(text, std::to_string(texts.size()));
        texts.push_back(text);
    }
    for (std::size_t i = texts.size() - 1; i > 0; --i) {
        ASSERT_EQ(history.undo_label(), std::to_string(i));
        history.undo();
        ASSERT_EQ(history.text(), texts[i - 1]);
    }
    EXPECT_FALSE(history.can_undo());
    EXPECT_EQ(history.undo_label(), "");
    for (std::size_t i = 1; i < texts.size(); ++i) {
        ASSERT_EQ(history.redo_label(), std::to_string(i));
        history.redo();
        ASSERT_EQ(history.text(), texts[i]);
    }
    EXPECT_FALSE(history.can_redo());
}

TEST(TextHistory, TakesAGroupAsOneStep) {
    TextHistory history("0");
    history.record("1", "name", "");
    for (const char* text : {"2", "3", "4"}) history.record(text, "move", "drag-1");
    history.record("5", "move", "drag-2");
    history.undo();
    EXPECT_EQ(history.text(), "4");
    history.undo();
    EXPECT_EQ(history.text(), "1");
    history.redo();
    EXPECT_EQ(history.text(), "4");
    // After undo or redo, or when it is ended, a group goes on as another step.
    history.record("6", "move", "drag-1");
    history.undo();
    EXPECT_EQ(history.text(), "4");
    history.record("7", "move", "drag-3");
    history.end_group();
    history.record("8", "move", "drag-3");
    history.undo();
    EXPECT_EQ(history.text(), "7");
}

TEST(TextHistory, ForgetsWhatWasUndoneAndWhatChangesNothing) {
    TextHistory history("0");
    history.record("0", "nothing");
    EXPECT_FALSE(history.can_undo());
    history.record("1", "one");
    history.record("2", "two");
    history.undo();
    history.record("3", "three");
    EXPECT_FALSE(history.can_redo());
    history.undo();
    EXPECT_EQ(history.text(), "1");
    // A lamp that was dragged back to where it was leaves no step behind.
    history.record("x", "move", "drag");
    history.record("1", "move", "drag");
    EXPECT_EQ(history.undo_label(), "one");
}

}  // namespace
}  // namespace uw
