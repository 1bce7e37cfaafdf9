#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "edit/document/scene_text.h"
#include "edit/document/text_history.h"

namespace uw {

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
    /// IoError if that is impossible, or if the file is not as it was when it was last read or
    /// written and `overwrite` is no.
    void save(Overwrite overwrite = Overwrite::no);

    /// Writes the text to another file of the same folder, to which the document then belongs:
    /// names of files in a scene are relative to its folder. Throws IoError like save; also if
    /// there is such a file and `overwrite` is no, and if it is one that the program has read.
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
