#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>

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

/// The stage of this name. Precondition: it is one of name_of.
Stage stage_named(std::string_view name);

/// Receives the progress of a stage of the work (0 to 1), from any thread. To stop the work, set
/// the flag of its StopScope; an exception that the callback throws ends it, too.
class StageProgressCallback {
  public:
    template <std::invocable<Stage, double> Tell>
    StageProgressCallback(Tell tell) : tell_(std::move(tell)) {}

    void operator()(Stage stage, double fraction) const { tell_(stage, fraction); }
    /// Reports the progress of the stage of this name, which is how a pass knows its stage.
    void operator()(std::string_view name, double fraction) const {
        tell_(stage_named(name), fraction);
    }

  private:
    std::function<void(Stage stage, double fraction)> tell_;
};

/// The same for work of a single stage.
using ProgressCallback = std::function<void(double fraction)>;

}  // namespace uw
