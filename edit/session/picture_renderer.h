#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "edit/session/picture.h"
#include "render/renderer.h"

namespace uw {

/// Callbacks about pictures; called on the rendering thread.
struct PictureCallbacks {
    std::function<void(const Picture& picture)> done;
    std::function<void(PictureQuality quality, double fraction)> progress;
    std::function<void(const std::string& message)> failed;
    /// Called after the first picture of a scene whose surroundings are new.
    std::function<void(const Renderer& renderer)> assembled;
    /// Called before the final picture of a scene, with a note on the light that it leaves out
    /// (left_out_note); empty if that is little or nothing.
    std::function<void(const EditedScene& scene, const std::string& note)> light_left_out;
};

/// Renders pictures of the scene as it is edited, in a thread of its own: from small to final, and
/// of each lamp by itself, so that lamps which have not changed are not rendered again, and a
/// change of brightness or name renders nothing.
///
/// A change cancels the current rendering at once, except that of the smallest pictures: while a
/// lamp is dragged, each of those is finished, as otherwise none ever would be.
class PictureRenderer {
  public:
    explicit PictureRenderer(PictureCallbacks callbacks);
    ~PictureRenderer();
    PictureRenderer(const PictureRenderer&) = delete;
    PictureRenderer& operator=(const PictureRenderer&) = delete;
    PictureRenderer(PictureRenderer&&) = delete;
    PictureRenderer& operator=(PictureRenderer&&) = delete;

    /// The scene to render from now on.
    void show(std::shared_ptr<const EditedScene> scene);
    /// The newest picture; none before the first.
    std::shared_ptr<const Picture> picture() const;
    /// Images of single lamps rendered so far.
    std::size_t rendered() const { return rendered_; }

  private:
    using Layers = std::shared_ptr<const LightLayers>;

    void run();
    bool has_next() const;
    void render_all(const std::shared_ptr<const EditedScene>& scene);
    void forget(const EditedScene& scene);
    Layers find(PictureQuality quality, const std::string& key) const;
    bool is_known(const EditedScene& scene, PictureQuality quality) const;
    bool is_step(const EditedScene& scene, PictureQuality quality) const;
    double fraction_of_paths(const EditedScene& scene, PictureQuality quality,
                             std::optional<std::size_t> lamp) const;
    Layers render(const EditedScene& scene, PictureQuality quality,
                  std::optional<std::size_t> lamp);
    void make(const std::shared_ptr<const EditedScene>& scene, PictureQuality quality);
    void publish(const std::shared_ptr<const EditedScene>& scene, PictureQuality quality);
    void estimate_light_left_out(const EditedScene& scene);

    PictureCallbacks callbacks_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::shared_ptr<const EditedScene> current_, next_;  // being rendered, to be rendered
    std::shared_ptr<const Picture> picture_;
    std::atomic<bool> is_stopping_ = false;
    std::atomic<bool> is_outdated_ = false;  // stopping, or the next picture is another one
    std::atomic<std::size_t> rendered_ = 0;
    std::atomic<PictureQuality> quality_ = PictureQuality::small;  // being rendered

    // The following members are used by the thread only.
    Renderer renderer_;
    std::string surrounding_;  // of what is known
    bool is_announced_ = false;
    std::vector<Layers> known_[k_picture_qualities];
    std::int64_t last_number_ = 0;
    std::atomic<std::size_t> part_ = 0, parts_ = 1;  // of the picture being rendered

    std::thread thread_;
};

}  // namespace uw
