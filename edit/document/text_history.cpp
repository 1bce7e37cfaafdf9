#include "edit/document/text_history.h"

#include <algorithm>

namespace uw {

TextHistory::Step TextHistory::difference(const std::string& before, const std::string& after) {
    const std::size_t most = std::min(before.size(), after.size());
    std::size_t front = 0, back = 0;
    while (front < most && before[front] == after[front]) ++front;
    while (back < most - front &&
           before[before.size() - 1 - back] == after[after.size() - 1 - back])
        ++back;
    return {"", "", front, before.substr(front, before.size() - back - front),
            after.substr(front, after.size() - back - front)};
}

void TextHistory::record(const std::string& text, std::string label, std::string group) {
    const bool joins = is_group_open_ && !group.empty() && can_undo() && !can_redo() &&
                       steps_.back().group == group;
    is_group_open_ = true;
    std::string before = text_;
    if (joins) {
        const Step& last = steps_.back();
        before.replace(last.offset, last.after.size(), last.before);
    }
    if (text == text_) return;
    if (joins) steps_.pop_back();
    steps_.resize(std::min(done_, steps_.size()));
    text_ = text;
    if (text != before) {
        steps_.push_back(difference(before, text));
        steps_.back().label = std::move(label);
        steps_.back().group = std::move(group);
    }
    done_ = steps_.size();
}

void TextHistory::undo() {
    const Step& step = steps_[--done_];
    text_.replace(step.offset, step.after.size(), step.before);
    is_group_open_ = false;
}

void TextHistory::redo() {
    const Step& step = steps_[done_++];
    text_.replace(step.offset, step.before.size(), step.after);
    is_group_open_ = false;
}

}  // namespace uw
