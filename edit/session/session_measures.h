#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/json.h"
#include "edit/session/edit_session.h"
#include "edit/session/suggest.h"
#include "render/image_scene.h"
#include "render/meters/target_probe.h"

namespace uw {

/// A window's request for the numbers of the picture.
struct NumbersRequest {
    std::optional<PixelWindow> part;  // of the full image; none: the whole image
    double ratio = 1;                 // of PictureNumbers::fraction_above
    bool with_curves = false;
};

/// Numbers of a session's scene, and the search for better places of its lamps. Thread safe.
class SessionMeasures {
  public:
    /// `session` outlives this.
    explicit SessionMeasures(EditSession& session) : session_(session) {}
    ~SessionMeasures();
    SessionMeasures(const SessionMeasures&) = delete;
    SessionMeasures& operator=(const SessionMeasures&) = delete;
    SessionMeasures(SessionMeasures&&) = delete;
    SessionMeasures& operator=(SessionMeasures&&) = delete;

    /// The numbers of the newest picture, and those of a target at 0.5 to 10 m (docs/edit.md
    /// defines them). Lamps that are off do not count; null stands for a number that is infinite or
    /// does not exist:
    ///
    ///     {"key": 7, "revision": 12, "quality": "final", "ratio": 1,    // of the picture measured
    ///      "image": {"signal", "backscatter", "signal_to_backscatter", "contrast",
    ///                "clean_contrast", "share_above", "lost_to_water",
    ///                "evenness": null or {"mean", "least", "greatest", "percentile5", "median",
    ///                    "percentile95", "least_to_mean", "percentile5_to_mean", "pixels"}},
    ///      "patch": {...the same, "kind": "pixels" | "checkerboard" | "image",
    ///                "window": {"x0", "y0", "x1", "y1"}},
    ///      "curves": {"distance": [...], "contrast": [...], "signal_to_backscatter": [...],
    ///                 "irradiance": [...]}}
    ///
    /// The patch is the part asked for; without one it is the most strongly patterned square, or
    /// the image. Throws UsageError for a part outside the image, ConflictError before the first
    /// picture and, with curves, if a newer request has come.
    Json numbers(const NumbersRequest& request);
    /// All of that as CSV.
    std::string numbers_csv(const NumbersRequest& request);
    /// The whole scene as uwvdb render makes it, without the lamps that are off: a PNG. Without
    /// `exposure` it has its automatic one.
    std::string picture_png(std::optional<double> exposure);
    /// ViewTable of the scene's view. Throws ConflictError if there is none.
    std::string view_table();

    /// Starts a search and cancels a running one. Throws UsageError if there is nothing to search.
    /// The request:
    ///
    ///     {"lamp": "left", "mirror": "right" or null,
    ///      "along": {"from": [3], "to": [3]} or "box": {"min": [3], "max": [3]},  // its frame [m]
    ///      "distance": 3, "objective": "contrast" | "signal_to_backscatter" | "irradiance",
    ///      "aim": false,                      // turn the lamp towards the target
    ///      "least_light": 0, "samples": 150}  // 12 to 10000
    ///
    /// The answer is {"id": 1}. Events `suggest` follow, all with "id" and "state": "searching"
    /// with "tried", "samples" and "best"; then "found", "cancelled", or "failed" with "message".
    /// "found" has
    ///
    ///     {"map": {"counts": [20, 1, 1], "points": [{"position", "value", "allowed"}, ...]},
    ///      "before": {"position", "value", "allowed", "numbers"}, "best": {...},
    ///      "lamps": [{"lamp", "position", "direction"}, ...], "tried": 150}
    ///
    /// with x fastest in the map. To apply it, positions and directions of "lamps" are `set`.
    Json suggest(const Json& request);
    void cancel_suggest();

  private:
    Json curves(const EditedScene& scene);
    void search(std::int64_t id, const ImageScene& scene, const SuggestRequest& request);
    void tell(Json event);

    EditSession& session_;
    std::mutex probe_mutex_;
    TargetProbe probe_;
    std::atomic<std::int64_t> newest_curves_ = 0;
    std::atomic<bool> are_curves_outdated_ = false;  // those being made

    std::mutex search_mutex_;
    std::int64_t last_search_ = 0;
    std::atomic<bool> is_cancelled_ = false;
    std::thread searching_;
};

}  // namespace uw
