#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/json.h"
#include "edit/document/scene_document.h"
#include "edit/session/edited_scene.h"
#include "edit/session/picture_renderer.h"
#include "edit/session/state_json.h"

namespace uw {

/// An event for the windows.
struct Event {
    std::uint64_t number = 0;  // from 1
    std::string name;
    std::string data;  // JSON, one line
};

/// The latest events, for any number of windows to follow at their own pace. Thread safe.
class EventLog {
  public:
    void publish(std::string name, std::string data);

    /// The number of the last event; 0 before the first.
    std::uint64_t last() const;
    /// The events after number `after` that are still kept, in their order; waits up to `seconds`
    /// for one. Empty if none has come, or the log is closed.
    std::vector<Event> wait(std::uint64_t after, double seconds) const;

    /// Ends all waiting.
    void close();
    /// Set once it is closed: for a StopScope around work whose result is no longer needed.
    const std::atomic<bool>& is_closed() const { return is_closed_; }

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::deque<Event> events_;
    std::uint64_t last_ = 0;
    std::atomic<bool> is_closed_ = false;
};

/// Calls back, on a thread of its own, shortly after a file of a folder was written, replaced or
/// removed. Costs nothing meanwhile.
class FileWatch {
  public:
    FileWatch(const std::filesystem::path& folder, std::function<void()> changed);
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;
    FileWatch(FileWatch&&) = delete;
    FileWatch& operator=(FileWatch&&) = delete;

  private:
    void run() const;

    std::function<void()> changed_;
    int notified_ = -1, stop_ = -1;
    std::thread thread_;
};

/// A scene that is being edited, by any number of windows: its document, its pictures, and what the
/// windows are told. Thread safe; changes are made one after the other.
///
/// A scene that cannot be read does not end the session: the state says why, and it is read again
/// when its file has changed. The last valid scene is kept meanwhile.
class EditSession {
  public:
    /// Throws IoError if there is no such file.
    explicit EditSession(std::filesystem::path file);
    ~EditSession();
    EditSession(const EditSession&) = delete;
    EditSession& operator=(const EditSession&) = delete;
    EditSession(EditSession&&) = delete;
    EditSession& operator=(EditSession&&) = delete;

    /// @name Requests (edit/server/edit_server.h)
    /// Requests that are rejected change nothing: InputError and UsageError of one line, IoError,
    /// and ConflictError for a request that another window, or another program, has outrun.
    /// @{
    Json state() const;
    Json outlines() const;
    /// {"revision", "label", "group", "changes": [...]}
    void edit(const Json& request);
    void undo();
    void redo();
    /// {"camera": "right", "frame": 12}, either alone: what is shown of a rig, or of what moves.
    void show(const Json& request);
    /// Takes the scene from its file again.
    void reload();
    /// {"overwrite": false}
    void save(const Json& request);
    /// {"file": "x.yaml", "overwrite": false}
    void save_as(const Json& request);
    /// @}

    /// The newest picture; null before the first.
    std::shared_ptr<const Picture> picture() const { return pictures_.picture(); }
    /// The current scene; null if none could be read yet.
    std::shared_ptr<const EditedScene> scene() const;
    const PictureRenderer& pictures() const { return pictures_; }
    EventLog& events() { return events_; }

  private:
    using Clock = std::chrono::steady_clock;

    void open();
    void file_changed();
    void take(std::shared_ptr<const EditedScene> scene);
    std::shared_ptr<const EditedScene> read(const SceneDocument& document) const;
    void read_document();
    void check_conflicts(std::int64_t revision, const std::string& group,
                         const std::vector<std::string>& touched) const;
    const SceneDocument& document() const;
    Json error_json() const;
    void announce();
    PictureCallbacks picture_callbacks();
    void take_shapes(const Renderer& renderer);

    mutable std::mutex mutex_;
    std::filesystem::path file_;
    std::optional<SceneDocument> document_;  // none: the file could not be read yet
    std::shared_ptr<const EditedScene> scene_;
    std::vector<std::string> off_;  // names of lamps
    ImageChoice choice_;            // what is shown
    std::string error_;             // why the file on disk cannot be read; empty: it can
    std::string picture_error_;     // why its picture cannot be rendered
    std::int64_t revision_ = 0;
    DiskState disk_ = DiskState::same;  // of the file, when it was looked at last
    std::string light_note_;  // what the scene's light lacks (left_out_note); empty: little

    // The last window to change each path.
    struct Touch {
        std::int64_t revision = 0;
        std::string group;
    };
    std::map<std::string, Touch> touches_;
    std::int64_t all_touched_ = 0;  // by undo, redo, reload

    SceneShapes shapes_;
    std::vector<GeometryDesc> shapes_geometry_;  // of which they are
    bool has_shapes_ = false;
    std::int64_t outlines_key_ = 0;

    EventLog events_;
    std::mutex progress_mutex_;
    Clock::time_point last_progress_;
    PictureRenderer pictures_;
    FileWatch watch_;  // last: calls back
};

}  // namespace uw
