#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/affine.h"
#include "core/motion/trajectory.h"
#include "core/scene/source_location.h"

namespace uw {

/// The formats of files of poses (core/motion/files).
enum class PoseFormat {
    tum,         ///< timestamp tx ty tz qx qy qz qw
    euroc,       ///< CSV: nanoseconds, position, quaternion with w first
    colmap,      ///< images.txt
    nerfstudio,  ///< transforms.json
};

/// How something moves: its poses over time, world_from_body.
struct TrajectoryDesc {
    std::vector<TimedPose> keyframes;  ///< written in the scene; none: in the file
    std::filesystem::path file;
    PoseFormat format = PoseFormat::tum;
    /// The file's time that is the scene's time 0 [s]; if omitted, that of its first pose. Files
    /// without times count frames instead, the scene's own.
    std::optional<double> start;
    double scale = 1;        ///< of the file's positions: metres per unit, > 0
    Affine world_from_file;  ///< rigid; applies after the scale
    Interpolation interpolation = Interpolation::smooth;
    Pacing pacing;
    SourceLocation where;
    /// The poses of all this as a trajectory, made when the scene is loaded (load_trajectory).
    std::shared_ptr<const Trajectory> trajectory;

    /// Whether the descriptions are the same; files may have changed in between.
    friend bool operator==(const TrajectoryDesc& a, const TrajectoryDesc& b) {
        return a.keyframes == b.keyframes && a.file == b.file && a.format == b.format &&
               a.start == b.start && a.scale == b.scale && a.world_from_file == b.world_from_file &&
               a.interpolation == b.interpolation && a.pacing == b.pacing;
    }
};

}  // namespace uw
