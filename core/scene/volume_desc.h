#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "core/scene/per_band.h"
#include "core/scene/phase_desc.h"
#include "core/scene/source_location.h"

namespace uw {

/// What one unit of a grid's value means: particles in ppm by volume, or optics of its own.
struct GridMappingDesc {
    std::string grid;                     ///< name in the file; name[i] where several share one
    double small_ppm = 0, large_ppm = 0;  ///< particles per unit of grid value [ppm]
    /// Coefficients per unit of grid value.
    struct Optics {
        PerBand absorption, scattering;  ///< [1/m], >= 0
        std::optional<PhaseDesc> phase;  ///< the water's if left out

        friend bool operator==(const Optics&, const Optics&) = default;
    };
    std::optional<Optics> optics;  ///< instead of ppm
    SourceLocation where;

    friend bool operator==(const GridMappingDesc&, const GridMappingDesc&) = default;
};

/// How a volume moves while the shutter is open.
struct MotionDesc {
    std::vector<std::string> grids;  ///< one of vectors, or three of numbers: x, y, z
    std::filesystem::path file;      ///< that holds these grids
    bool is_sequence = false;        ///< as VolumeDesc::is_sequence
    std::optional<double> scale;     ///< m/s per unit, in the file's axes; automatic if left out
    double shutter = 0;              ///< how long it is open, around the frame's moment [s]
    SourceLocation where;

    friend bool operator==(const MotionDesc&, const MotionDesc&) = default;
};

/// Whether a grid's values are those of its voxels' centres or of their corners. Automatic is
/// decided from the file (media/vdb/placement.h).
enum class Centering { automatic, cell, node };

/// Which of a file's axes points up; automatic as with Centering.
enum class UpAxis { automatic, y, z };

/// A VDB or NanoVDB file whose grids add to the water.
struct VolumeDesc {
    std::filesystem::path file;
    bool is_sequence = false;  ///< `file` has a place for the frame's number (frame_pattern.h)
    std::vector<GridMappingDesc> grids;
    Centering centering = Centering::automatic;
    UpAxis up = UpAxis::automatic;
    Affine world_from_upright;  ///< `transform`, applied after `up` has been brought to y
    std::optional<MotionDesc> motion;
    SourceLocation where;

    friend bool operator==(const VolumeDesc&, const VolumeDesc&) = default;
};

}  // namespace uw
