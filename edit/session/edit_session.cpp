#include "edit/session/edit_session.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "edit/session/edited_scene.h"
#include "edit/session/request_members.h"

namespace uw {

namespace {

// Every event can be fetched again as part of the state: a window that falls further behind than
// this misses nothing that lasts.
constexpr std::size_t k_max_events = 256;

}  // namespace

void EventLog::publish(std::string name, std::string data) {
    const std::lock_guard lock(mutex_);
    events_.push_back({++last_, std::move(name), std::move(data)});
    if (events_.size() > k_max_events) events_.pop_front();
    changed_.notify_all();
}

std::uint64_t EventLog::last() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

std::vector<Event> EventLog::wait(std::uint64_t after, double seconds) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                      [&] { return is_closed_ || last_ > after; });
    std::vector<Event> found;
    if (is_closed_) return found;
    for (const Event& event : events_)
        if (event.number > after) found.push_back(event);
    return found;
}

void EventLog::close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
}

namespace {

// A file is written in several steps: it is looked at once nothing has happened for so long [ms].
constexpr int k_settle = 50;

}  // namespace

FileWatch::FileWatch(const std::filesystem::path& folder, std::function<void()> changed)
    : changed_(std::move(changed)),
      notified_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
      stop_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    // Without watches, files are still compared when they are saved.
    inotify_add_watch(notified_, folder.c_str(),
                      IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE);
    thread_ = std::thread([this] { run(); });
}

FileWatch::~FileWatch() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(stop_, &one, sizeof one);
    thread_.join();
    if (notified_ >= 0) close(notified_);
    close(stop_);
}

void FileWatch::run() const {
    std::array<pollfd, 2> polled{{{stop_, POLLIN, 0}, {notified_, POLLIN, 0}}};
    std::array<char, 4096> ignored{};
    bool is_news = false;
    for (;;) {
        const int count = poll(polled.data(), polled.size(), is_news ? k_settle : -1);
        if (polled[0].revents != 0) return;
        if (count == 0 && std::exchange(is_news, false)) changed_();
        while (read(notified_, ignored.data(), ignored.size()) > 0) is_news = true;
    }
}

namespace {

constexpr std::chrono::milliseconds k_progress_interval{100};
constexpr std::size_t k_max_changes = 100;

// A message about a scene file as {"message", "line", "column"}, the last two null where it does
// not say "scene.yaml:14:7: ...".
Json located_message(const std::string& message, const std::string& file_name) {
    Json located = {{"message", message}, {"line", nullptr}, {"column", nullptr}};
    const std::string begin = file_name + ":";
    const std::size_t at = message.find(begin);
    if (at == std::string::npos) return located;
    const char* const end = message.data() + message.size();
    const char* next = message.data() + at + begin.size();
    for (const char* key : {"line", "column"}) {
        int number = 0;
        const auto [rest, error] = std::from_chars(next, end, number);
        if (error != std::errc() || rest == end || *rest != ':') break;
        located[key] = number;
        next = rest + 1;
    }
    return located;
}

// Whether a change of one of these paths concerns the other: "lamps.left" is all of that lamp.
bool overlap(const std::string& a, const std::string& b) {
    const auto& [shorter, longer] = a.size() < b.size() ? std::tie(a, b) : std::tie(b, a);
    return longer.starts_with(shorter) &&
           (longer.size() == shorter.size() || longer[shorter.size()] == '.' ||
            longer[shorter.size()] == '[');
}

}  // namespace

EditSession::EditSession(std::filesystem::path file)
    : file_(std::move(file)),
      pictures_(picture_callbacks()),
      watch_(folder_of(file_), [this] { file_changed(); }) {
    admit_input(file_, printable(file_.string(), 300), "scene");
    const std::lock_guard lock(mutex_);
    open();
}

EditSession::~EditSession() {
    events_.close();
}

// Reads the file, for the first time or again.
void EditSession::open() {
    try {
        SceneDocument fresh(file_);
        // The camera and frame of the previous version may not exist in this one.
        if (document_ && document_->disk_state() != DiskState::same) choice_.frame.reset();
        auto scene = read(fresh);
        if (document_)
            document_->reload();
        else
            document_.emplace(std::move(fresh));
        error_.clear();
        disk_ = DiskState::same;
        all_touched_ = revision_ + 1;
        take(std::move(scene));
    } catch (const std::exception& error) {
        error_ = line_of(error);
        announce();
    }
}

void EditSession::file_changed() {
    const std::lock_guard lock(mutex_);
    if (!document_) return open();
    const DiskState before = std::exchange(disk_, document_->disk_state());
    if (disk_ == DiskState::same && before == DiskState::same && error_.empty()) return;
    if (disk_ != DiskState::changed) error_.clear();
    if (disk_ == DiskState::changed && !document_->is_unsaved()) return open();
    announce();
}

// Makes `scene`, whose revision is the next one, the scene from now on.
void EditSession::take(std::shared_ptr<const EditedScene> scene) {
    scene_ = std::move(scene);
    revision_ = scene_->revision;
    picture_error_.clear();
    light_note_.clear();
    pictures_.show(scene_);
    announce();
}

// Reads the scene from the document's current text; its revision is the next one.
std::shared_ptr<const EditedScene> EditSession::read(const SceneDocument& document) const {
    const SceneText& scene = document.scene();
    return make_edited_scene(scene.text(), scene.tree(), file_, off_, revision_ + 1, choice_);
}

// Reads the scene again after undo or redo has changed the document's text.
void EditSession::read_document() {
    all_touched_ = revision_ + 1;
    take(read(document()));
}

const SceneDocument& EditSession::document() const {
    if (!document_)
        throw ConflictError(fmt::format("the scene cannot be read; mend it first: {}", error_));
    return *document_;
}

std::shared_ptr<const EditedScene> EditSession::scene() const {
    const std::lock_guard lock(mutex_);
    return scene_;
}

void EditSession::announce() {
    events_.publish("state", Json{{"revision", revision_}}.dump());
}

Json EditSession::error_json() const {
    const std::string& error = error_.empty() ? picture_error_ : error_;
    if (error.empty()) return nullptr;
    return located_message(error, file_.filename().string());
}

Json EditSession::state() const {
    const std::lock_guard lock(mutex_);
    const auto label = [](const std::string& text) {
        return text.empty() ? Json(nullptr) : Json(text);
    };
    Json state = {
        {"revision", revision_},
        {"scene", file_.filename().string()},
        {"folder", std::filesystem::absolute(folder_of(file_)).lexically_normal().string()},
        {"unsaved", document_ && document_->is_unsaved()},
        {"changed_on_disk", disk_ == DiskState::changed},
        {"deleted_on_disk", disk_ == DiskState::missing},
        {"can_undo", document_ && document_->history().can_undo()},
        {"can_redo", document_ && document_->history().can_redo()},
        {"undo_label", document_ ? label(document_->history().undo_label()) : nullptr},
        {"redo_label", document_ ? label(document_->history().redo_label()) : nullptr},
        {"error", error_json()}};
    if (!scene_) return state;
    state["light_note"] = label(light_note_);
    state.update(scene_json(*scene_, document_->scene().tree(), has_shapes_ ? &shapes_ : nullptr));
    state["outlines"] = {{"key", outlines_key_}, {"count", shapes_.outlines.size()}};
    return state;
}

Json EditSession::outlines() const {
    const std::lock_guard lock(mutex_);
    return {{"key", outlines_key_}, {"segments", outline_segments_json(shapes_.outlines)}};
}

// Rejects the request of a window that does not know of another one's change to the same path.
void EditSession::check_conflicts(std::int64_t revision, const std::string& group,
                                  const std::vector<std::string>& touched) const {
    if (revision > revision_)
        throw ConflictError("revision: of another session; fetch the state again");
    bool is_late = revision < all_touched_;
    for (const auto& [path, touch] : touches_) {
        const bool is_own = !group.empty() && touch.group == group;
        is_late =
            is_late || (revision < touch.revision && !is_own &&
                        std::ranges::any_of(touched, [&path = path](const std::string& other) {
                            return overlap(path, other);
                        }));
    }
    if (is_late)
        throw ConflictError("this has been changed in another window; look at it and try again");
}

void EditSession::edit(const Json& request) {
    const std::lock_guard lock(mutex_);
    const Json revision = request.value("revision", Json());
    if (!revision.is_number_integer()) throw UsageError("revision: expected that of the state");
    const Json changes = request.value("changes", Json());
    if (!changes.is_array() || changes.empty() || changes.size() > k_max_changes)
        throw UsageError(fmt::format("changes: expected a list of 1 to {}", k_max_changes));
    const std::string label = optional_text_member(request, "label"),
                      group = optional_text_member(request, "group");

    SceneChanges made(document().scene(), file_, scene_, off_);
    made.apply(changes);
    const std::vector<std::string> touched(made.touched().begin(), made.touched().end());
    check_conflicts(revision.get<std::int64_t>(), group, touched);
    refuse_files_elsewhere(*scene_, *made.scene());

    auto scene = std::make_shared<EditedScene>(*made.scene());
    scene->revision = revision_ + 1;
    document_->record(made.text(), label.empty() ? "change" : label, group);
    off_ = made.off();
    for (const std::string& path : touched) touches_[path] = {revision_ + 1, group};
    take(std::move(scene));
}

void EditSession::undo() {
    const std::lock_guard lock(mutex_);
    if (!document().history().can_undo()) throw ConflictError("there is nothing to undo");
    document_->undo();
    read_document();
}

void EditSession::redo() {
    const std::lock_guard lock(mutex_);
    if (!document().history().can_redo()) throw ConflictError("there is nothing to redo");
    document_->redo();
    read_document();
}

void EditSession::show(const Json& request) {
    const std::lock_guard lock(mutex_);
    document();  // refuses while nothing is shown
    const ImageChoice before = choice_;
    if (request.contains("camera")) {
        const std::string name = text_member(request, "camera");
        const auto& cameras = scene_->scene.whole().cameras;
        const auto found = std::ranges::find(cameras, name, &RigCameraDesc::name);
        if (found == cameras.end())
            throw UsageError(fmt::format("camera: the rig has no '{}'", printable(name)));
        choice_.camera = static_cast<std::size_t>(found - cameras.begin());
    }
    if (request.contains("frame")) {
        const double frame = number_member(request, "frame");
        const std::optional<FrameRange> frames = frames_of(scene_->scene.whole());
        if (!frames || !(frame >= frames->first && frame <= frames->last) ||
            frame != std::floor(frame))
            throw UsageError("frame: the scene has no such one");
        choice_.frame = static_cast<int>(frame);
    }
    try {
        take(read(*document_));
    } catch (...) {
        choice_ = before;
        throw;
    }
}

void EditSession::reload() {
    const std::lock_guard lock(mutex_);
    open();
}

void EditSession::save(const Json& request) {
    const std::lock_guard lock(mutex_);
    const bool overwrites = flag_member(request, "overwrite", false);
    document();  // refuses to save what could not be read
    document_->save(overwrites ? Overwrite::yes : Overwrite::no);
    document_->end_group();
    disk_ = DiskState::same;
    error_.clear();
    announce();
}

void EditSession::save_as(const Json& request) {
    const std::lock_guard lock(mutex_);
    const bool overwrites = flag_member(request, "overwrite", false);
    const std::filesystem::path file = file_.parent_path() / new_file_member(request);
    document();
    document_->save_as(file, overwrites ? Overwrite::yes : Overwrite::no);
    document_->end_group();
    file_ = file;
    disk_ = DiskState::same;
    error_.clear();
    read_document();
}

PictureCallbacks EditSession::picture_callbacks() {
    PictureCallbacks callbacks;
    callbacks.done = [this](const Picture& picture) {
        events_.publish("image", Json{{"key", picture.number},
                                      {"revision", picture.scene->revision},
                                      {"width", picture.width},
                                      {"height", picture.height},
                                      {"quality", name_of(picture.quality)}}
                                     .dump());
    };
    callbacks.progress = [this](PictureQuality quality, double fraction) {
        const Clock::time_point now = Clock::now();
        const std::lock_guard lock(progress_mutex_);
        if (now - last_progress_ < k_progress_interval) return;
        last_progress_ = now;
        events_.publish("progress",
                        Json{{"stage", name_of(quality)}, {"fraction", fraction}}.dump());
    };
    callbacks.failed = [this](const std::string& message) {
        const std::lock_guard lock(mutex_);
        picture_error_ = message;
        events_.publish("error", Json{{"message", message}}.dump(-1, ' ', false,
                                                                 Json::error_handler_t::replace));
        announce();
    };
    callbacks.light_left_out = [this](const EditedScene& scene, const std::string& note) {
        const std::lock_guard lock(mutex_);
        // The scene may have changed while its light was estimated.
        if (scene.revision != revision_ || note == light_note_) return;
        light_note_ = note;
        announce();
    };
    callbacks.assembled = [this](const Renderer& renderer) { take_shapes(renderer); };
    return callbacks;
}

void EditSession::take_shapes(const Renderer& renderer) {
    const AssembledScene& assembled = renderer.assembled();
    const std::vector<GeometryDesc>& geometry = assembled.desc().geometry;
    const bool is_other = !has_shapes_ || shapes_geometry_ != geometry;
    std::vector<OutlineSegment> outlines;
    if (is_other) outlines = scene_outlines(geometry);
    std::vector<Bounds> volumes;
    for (const LoadedVolume& volume : assembled.volumes) {
        Bounds bounds;
        for (const VolumeReport& report : volume.reports) bounds.extend(report.bounds);
        volumes.push_back(bounds);
    }
    const std::lock_guard lock(mutex_);
    if (is_other) {
        shapes_.outlines = std::move(outlines);
        shapes_geometry_ = geometry;
        ++outlines_key_;
    }
    shapes_.volumes = std::move(volumes);
    has_shapes_ = true;
    announce();
}

}  // namespace uw
