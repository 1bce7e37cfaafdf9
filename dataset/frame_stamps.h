#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/pose_file.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The times of a scene's frames in whole nanoseconds [ns]: those of the clock of the file that the
/// rig or the camera has its poses from, to the last digit where frames are poses; without such a
/// file, those since the scene's time 0.
class FrameStamps {
  public:
    /// Reads the file. Throws as read_pose_clock.
    explicit FrameStamps(const SceneDesc& scene);

    /// The stamp of a frame, which shows the moment `time` of the scene [s]. Throws InputError for
    /// one after the year 2116.
    std::int64_t at(std::optional<int> frame, double time) const;

  private:
    PoseClock clock_;
    bool are_poses_ = false;  // RenderDesc::Times::trajectory
};

/// A stamp in seconds, to the last digit: "1403636579.763555584".
std::string seconds_text(std::int64_t stamp);

/// A stamp as EuRoC has it, with 19 digits: below 10^18 ns, 1 400 000 000 s are added.
std::int64_t euroc_stamp(std::int64_t stamp);

}  // namespace uw
