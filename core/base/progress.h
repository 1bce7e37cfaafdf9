#pragma once

#include <functional>
#include <string>

namespace uw {

/// Receives the progress of a stage of the work (0 to 1), from any thread. To stop the work, set
/// the flag of its StopScope; an exception that the callback throws ends it, too.
using StageProgressCallback = std::function<void(const std::string& stage, double fraction)>;

/// The same for work of a single stage.
using ProgressCallback = std::function<void(double fraction)>;

}  // namespace uw
