#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "edit/document/scene_text.h"

namespace uw {

/// A text and all that was done to it. A step is kept as what it replaced, so that thousands of
/// them need no more memory than the text changed.
class TextHistory {
  public:
    explicit TextHistory(std::string text) : text_(std::move(text)) {}

    const std::string& text() const { return text_; }

    /// Makes `text` the text, as a step called `label`; the steps that had been undone are
    /// forgotten. A change of the same `group`, unless that is empty, as the one before belongs to
    /// its step: a lamp that was dragged is back at its place with one undo. A change
    /// that leaves the text as it is makes no step.
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

/// Reports, in one line, a request that was right, but not for the scene, or its file, as it has
/// become.
class ConflictError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A scene's file compared with what was last read from it or written to it.
enum class DiskState { same, changed, missing };

/// Whether saving may replace what others have written.
enum class Overwrite { no, yes };

/// A scene file that is open for editing: its text with its history, and what is on disk.
///
///     SceneText next = document.scene();
///     next.set("lamps.left.position", "[0, 1, 0]");
///     load_scene_text(next.text(), document.file());  // throws if that is no scene
///     document.record(std::move(next), "move left", "drag-17");
///
/// Not thread safe.
class SceneDocument {
  public:
    /// Reads the file. Throws IoError if it cannot be read, InputError if it is not YAML.
    explicit SceneDocument(std::filesystem::path file);

    const std::filesystem::path& file() const { return file_; }
    const SceneText& scene() const { return scene_; }

    /// A step of the history (TextHistory::record).
    void record(SceneText scene, std::string label, std::string group = {});
    const TextHistory& history() const { return history_; }
    void end_group() { history_.end_group(); }
    void undo();
    void redo();

    bool is_unsaved() const { return history_.text() != on_disk_; }
    /// Reads the file only if its date or size has changed.
    DiskState disk_state();

    /// Takes the text from the file again, as a step of the history. Throws as the constructor and
    /// then changes nothing.
    void reload();

    /// Writes the text to its file, whole or not at all; the file keeps its permissions. Throws
    /// ConflictError if the file is not as it was when it was last read or written and `overwrite`
    /// is no, IoError if it cannot be written.
    void save(Overwrite overwrite = Overwrite::no);

    /// Writes the text to another file of the same folder, to which the document then belongs:
    /// names of files in a scene are relative to its folder. Throws like save; ConflictError also
    /// if there is such a file and `overwrite` is no, and if the name is a symbolic link, through
    /// which writing would go wherever it leads; IoError if it is a file that the program has read.
    void save_as(const std::filesystem::path& file, Overwrite overwrite = Overwrite::no);

  private:
    /// A file's identity, size and date.
    struct FileStamp {
        std::uintmax_t device = 0, number = 0, size = 0;
        std::intmax_t seconds = 0, nanoseconds = 0;

        friend bool operator==(const FileStamp&, const FileStamp&) = default;
    };
    static std::optional<FileStamp> stamp_of(const std::filesystem::path& file);
    void show(const std::string& text);
    void write(const std::filesystem::path& file, bool is_own);

    std::filesystem::path file_;
    std::optional<FileStamp> stamp_;  // of the file when it was last compared with `on_disk_`
    std::string on_disk_;             // what was last read or written
    SceneText scene_;
    TextHistory history_;
};

}  // namespace uw
