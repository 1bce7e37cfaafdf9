#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/lamp_desc.h"
#include "render/meters/target_probe.h"

namespace uw {

/// A search for the position of a lamp that gives the best view of a target at a chosen distance.
struct SuggestRequest {
    /// The objective: the target's contrast, the ratio of its signal to the backscatter, or the
    /// light on it.
    enum class Objective { contrast, signal_to_backscatter, irradiance };
    /// Whether the lamp keeps its direction, or is always turned towards the target's centre.
    enum class Aim { keep, target };

    std::size_t lamp = 0;                // index in the scene
    std::optional<std::size_t> partner;  // a lamp kept at the mirrored place, left for right
    /// The permitted positions of the lamp, in its own frame: on the straight line between the two
    /// [m], or, in a box, between the two along each axis.
    Point3 from, to;
    bool in_box = false;
    double distance = 3;  // of the target [m]
    Objective objective = Objective::contrast;
    Aim aim = Aim::keep;
    /// Positions whose target has less than this fraction of the light that falls on it now are
    /// left out; 0: none.
    double min_light = 0;
    /// The greatest number of positions to try, 12..10000: two thirds of them on a grid, the rest
    /// about the best.
    std::size_t samples = 150;
};

/// One position that was tried.
struct SuggestPoint {
    Point3 position;   // of the lamp, in its frame [m]
    double value = 0;  // the objective
    TargetNumbers numbers;
    bool allowed = true;  // by SuggestRequest::min_light
};

/// The result of a search.
struct Suggestion {
    std::array<std::size_t, 3> counts{};  // of the grid along x, y, z; a line has its own, 1, 1
    std::vector<SuggestPoint> map;        // of the grid, x fastest
    /// The lamp where it is, its partner where that is; and the best place found, which is not
    /// allowed only if none is.
    SuggestPoint before, best;
    /// The lamp at its best position, and its partner.
    LampDesc lamp;
    std::optional<LampDesc> partner;
    std::size_t tried = 0;
};

/// Called after each position tried, with its map and best so far.
using SuggestProgress = std::function<void(const Suggestion& so_far)>;

/// Throws UsageError for a request that makes no sense among these lamps.
void check_suggest_request(const SuggestRequest& request, const std::vector<LampDesc>& lamps);

/// Tries positions on a grid, and then goes from the best of them along its axes, in steps halved
/// where none is better, until they are below 1 cm or the request's positions are used up. The same
/// request gives the same result. `probe` keeps what is rendered. Throws as check_suggest_request,
/// Interrupted, and as Renderer.
Suggestion suggest_position(TargetProbe& probe, const ImageScene& scene,
                            const SuggestRequest& request, const SuggestProgress& progress = {});

/// `lamp` on the other side of the camera: its position and direction mirrored, left for right, in
/// the plane through the camera's centre perpendicular to its x axis. The frame, the profile and
/// the brightness stay.
LampDesc mirrored_lamp(const LampDesc& lamp, const Affine& world_from_camera);

}  // namespace uw
