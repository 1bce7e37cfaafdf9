#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace uw {

/// A text and all that was done to it. A step is kept as what it replaced, so that thousands of
/// them need no more memory than the text changed.
class TextHistory {
  public:
    explicit TextHistory(std::string text) : text_(std::move(text)) {}

    const std::string& text() const { return text_; }

    /// Makes `text` the text, as a step called `label`; the steps that had been undone are
    /// forgotten. A change of the same `group`, unless that is empty, as the one before belongs to
    /// its step: a lamp that was dragged is back at its place with one undo. A step that changes
    /// nothing is none.
    void record(const std::string& text, std::string label, std::string group = {});
    /// Ends the group: the next change is a step of its own.
    void end_group() { is_group_open_ = false; }

    bool can_undo() const { return done_ > 0; }
    bool can_redo() const { return done_ < steps_.size(); }
    /// What undo and redo would do; empty if there is nothing.
    std::string undo_label() const { return can_undo() ? steps_[done_ - 1].label : ""; }
    std::string redo_label() const { return can_redo() ? steps_[done_].label : ""; }
    /// Precondition: can_undo(), can_redo().
    void undo();
    void redo();

  private:
    /// At `offset`, `before` was replaced by `after`.
    struct Step {
        std::string label, group;
        std::size_t offset = 0;
        std::string before, after;
    };
    static Step difference(const std::string& before, const std::string& after);

    std::string text_;
    std::vector<Step> steps_;
    std::size_t done_ = 0;  // the first of `steps_` that are part of `text_`
    bool is_group_open_ = false;
};

}  // namespace uw
