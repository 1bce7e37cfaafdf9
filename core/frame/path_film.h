#pragma once

#include <functional>
#include <optional>

#include "core/frame/path_pixels.h"
#include "core/frame/render_film.h"

namespace uw {

/// When an image of light paths is done.
struct PathGoal {
    int samples = 16;  // paths per pixel
    /// Instead: the greatest PathAccuracy::error. No more than k_most_paths are traced for it.
    std::optional<double> error{};
};

/// What an image of light paths has reached.
struct PathAccuracy {
    int samples = 0;  // paths per pixel
    /// The standard error of the image: the RMS over pixels and bands of that of the total, over
    /// the total's mean. None for a single path.
    std::optional<double> error{};
};

/// Receives what has been reached, after each round, while no pixel is being rendered.
using AccuracyCallback = std::function<void(const PathAccuracy& so_far)>;

/// The number of paths per pixel to trace next for an image that has reached `so_far`; 0: it is
/// done. For an error that must not be exceeded, the number follows from the error so far, and is
/// at most twice that of the paths so far.
int samples_of_next_round(const PathGoal& goal, const PathAccuracy& so_far);

/// Renders every pixel of the film's window by light paths, round after round, on all permitted
/// threads. The result does not depend on their number, and pixels do not depend on the window
/// unless it is an error that is to be reached. Throws Interrupted if `progress` returned false;
/// InputError if there is not enough memory.
PathAccuracy render_path_film(const PixelRenderer& renderer, const PathGoal& goal,
                              const LayerPlan& plan, const BandColour& colour, Film& film,
                              const ProgressCallback& progress,
                              const AccuracyCallback& reached = {});

}  // namespace uw
