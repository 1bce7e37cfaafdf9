#pragma once

#include <functional>
#include <string>

namespace uw {

/// Receives how far a stage of the work is (0..1), from any thread. It is told and not asked: who
/// wants the work to stop sets the flag of its StopScope. What it throws ends the work, too.
using ProgressCallback = std::function<void(const std::string& stage, double fraction)>;

/// The same for work of a single stage.
using ShareCallback = std::function<void(double share)>;

}  // namespace uw
