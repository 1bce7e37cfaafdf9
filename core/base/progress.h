#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

namespace uw {

/// What is being computed for an image.
enum class Stage : std::uint8_t {
    particles,
    volumes,
    geometry,
    splat,
    multiple_scattering,
    snow,
    render,
    forward_scatter,
    reflection,
    derivatives,
};

/// The name under which users see a stage: "multiple scattering".
std::string_view name_of(Stage stage);

/// Receives the progress of a stage of the work (0 to 1), from any thread. To stop the work, set
/// the flag of its StopScope; an exception that the callback throws ends it, too.
using StageProgressCallback = std::function<void(Stage stage, double fraction)>;

/// The same for work of a single stage.
using ProgressCallback = std::function<void(double fraction)>;

}  // namespace uw
