#include "edit/document/scene_document.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/text.h"
#include "core/scene/yaml_document.h"

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

namespace {

namespace fs = std::filesystem;

std::string origin_of_scene(const fs::path& file) {
    return printable(file.string(), 300);
}

std::string read(const fs::path& file) {
    return read_text_file(file, origin_of_scene(file), YamlLimits{}.bytes, "scene");
}

std::string name_of(const fs::path& file) {
    return printable(file.filename().string(), 300);
}

[[noreturn]] void fail_to_write(const fs::path& file, std::string_view why) {
    throw IoError(fmt::format("{}: cannot write: {}", file.string(), why));
}

/// Writes all of `text` and waits until it is on the disk: after a power cut there is the old scene
/// or the new one.
void write_through(const fs::path& file, std::string_view text, const fs::path& target) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail_to_write(target, std::generic_category().message(errno));
    int error = 0;
    while (!text.empty() && error == 0) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written >= 0)
            text.remove_prefix(static_cast<std::size_t>(written));
        else if (errno != EINTR)
            error = errno;
    }
    if (error == 0 && ::fsync(descriptor) != 0 && errno != EINVAL) error = errno;
    if (::close(descriptor) != 0 && error == 0) error = errno;
    if (error != 0) fail_to_write(target, std::generic_category().message(error));
}

}  // namespace

SceneDocument::SceneDocument(fs::path file)
    : file_(std::move(file)),
      stamp_(stamp_of(file_)),
      on_disk_(read(file_)),
      scene_(on_disk_, origin_of_scene(file_)),
      history_(on_disk_) {}

std::optional<SceneDocument::FileStamp> SceneDocument::stamp_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return FileStamp{status.st_dev, status.st_ino, static_cast<std::uintmax_t>(status.st_size),
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void SceneDocument::record(SceneText scene, std::string label, std::string group) {
    scene_ = std::move(scene);
    history_.record(scene_.text(), std::move(label), std::move(group));
}

void SceneDocument::show(const std::string& text) {
    scene_ = SceneText(text, origin_of_scene(file_));
}

void SceneDocument::undo() {
    history_.undo();
    show(history_.text());
}

void SceneDocument::redo() {
    history_.redo();
    show(history_.text());
}

DiskState SceneDocument::disk_state() {
    const std::optional<FileStamp> now = stamp_of(file_);
    if (!now) return DiskState::missing;
    if (now == stamp_) return DiskState::same;
    if (read(file_) != on_disk_) return DiskState::changed;
    stamp_ = now;  // touched, but the same
    return DiskState::same;
}

void SceneDocument::reload() {
    const std::optional<FileStamp> stamp = stamp_of(file_);
    const std::string text = read(file_);
    SceneText scene(text, origin_of_scene(file_));
    stamp_ = stamp;
    on_disk_ = text;
    record(std::move(scene), "reload");
}

void SceneDocument::save(Overwrite overwrite) {
    if (overwrite == Overwrite::no && disk_state() == DiskState::changed)
        throw ConflictError(
            fmt::format("{}: has been changed by another program since it was "
                        "read; reload it, overwrite it, or save under another name",
                        name_of(file_)));
    write(file_, true);
}

void SceneDocument::save_as(const fs::path& file, Overwrite overwrite) {
    std::error_code ignored;
    const fs::file_status status = fs::symlink_status(file, ignored);
    if (file.filename() != file_.filename() && fs::is_symlink(status))
        throw ConflictError(
            fmt::format("{}: is a symbolic link; choose another name", name_of(file)));
    if (fs::equivalent(file, file_, ignored)) {
        save(overwrite);
        return;
    }
    const auto folder_of = [](const fs::path& name) {
        std::error_code error;
        const fs::path folder = name.has_parent_path() ? name.parent_path() : fs::path(".");
        const fs::path whole = fs::weakly_canonical(folder, error);
        return error ? folder : whole;
    };
    if (folder_of(file) != folder_of(file_))
        fail_to_write(file,
                      "names of files in a scene are relative to its folder; choose a name "
                      "in the scene's own folder");
    if (overwrite == Overwrite::no && fs::exists(status))
        throw ConflictError(
            fmt::format("{}: exists; choose another name, or overwrite it", name_of(file)));
    write(file, false);
    file_ = file;
    show(history_.text());  // its messages name the new file
}

void SceneDocument::write(const fs::path& file, bool is_own) {
    AtomicFile output(file, is_own ? ReadTarget::replace : ReadTarget::refuse);
    write_through(output.temporary_path(), history_.text(), file);
    output.commit();
    remember_input(file);  // it is what the scene is read from
    on_disk_ = history_.text();
    stamp_ = stamp_of(file);
}

}  // namespace uw
