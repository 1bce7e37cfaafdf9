#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/water_desc.h"

namespace uw {

struct LoadedGrid;  // media/volumes/loaded_grid.h

/// The meaning of one unit of a grid's value: particles in ppm by volume, or its own optical
/// properties.
struct GridMappingDesc {
    std::string grid;                     ///< name in the file; name[i] if several share it
    double small_ppm = 0, large_ppm = 0;  ///< particles per unit of grid value [ppm]
    std::vector<SpeciesAmount> amounts;   ///< of the water's species, likewise
    /// Coefficients per unit of grid value.
    struct Optics {
        PerBand absorption, scattering;  ///< [1/m], >= 0
        std::optional<PhaseDesc> phase;  ///< the water's if omitted

        friend bool operator==(const Optics&, const Optics&) = default;
    };
    std::optional<Optics> optics;  ///< instead of ppm
    SourceLocation where;

    friend bool operator==(const GridMappingDesc&, const GridMappingDesc&) = default;
};

/// How a volume moves while the shutter is open.
struct MotionDesc {
    std::vector<std::string> grids;  ///< one vector grid, or three scalar grids: x, y, z
    std::filesystem::path file;      ///< that contains these grids
    bool is_sequence = false;        ///< as VolumeDesc::is_sequence
    std::optional<double> scale;     ///< m/s per unit, in the file's axes; automatic if omitted
    double shutter = 0;              ///< exposure time, centred on the frame's time [s]
    SourceLocation where;

    friend bool operator==(const MotionDesc&, const MotionDesc&) = default;
};

/// Whether a grid's values lie at its voxels' centres or at their corners. Automatic is decided
/// from the file (media/volumes/loaded_grid.h).
enum class Centering { automatic, cell, node };

/// Which of a file's axes points up; automatic as for Centering.
enum class UpAxis { automatic, x, y, z };

/// `up`: x, y or z.
UpAxis read_up_axis(const ConfigValue& value);

/// The treatment of level sets, whose values are distances to a surface: they are rejected, or
/// their interior becomes fog of value 1, which fades to 0 towards the surface within the narrow
/// band.
enum class LevelSets { refused, fog };

/// The light that a volume emits where one of its grids has a value. It is a lamp of the scene.
struct EmissionDesc {
    /// A hot gas or dust, whose temperature is the grid's value times `kelvin` plus `offset`.
    struct Blackbody {
        double kelvin = 1, offset = 0;  ///< [K per unit], [K]

        friend bool operator==(const Blackbody&, const Blackbody&) = default;
    };

    /// The light where the grid has this value.
    struct Row {
        double value = 0;  ///< >= 0
        PerBand light;     ///< emission of a cubic metre in each direction [W/(sr m^3)]

        friend bool operator==(const Row&, const Row&) = default;
    };

    /// Light that the water's motion stimulates, such as that of dinoflagellates: none up to a
    /// threshold, all of it from saturation on, linear in between. Needs VolumeDesc::motion.
    struct Stimulus {
        enum class Quantity : std::uint8_t {
            speed,  // [m/s]
            shear   // rate of shear, sqrt(2 E:E) with the rate of strain E [1/s]
        };
        Quantity quantity = Quantity::shear;
        double threshold = 0, saturation = 1;  ///< 0 <= threshold < saturation

        friend bool operator==(const Stimulus&, const Stimulus&) = default;
    };

    std::string name;  ///< of the lamp and its layers
    std::string grid;  ///< name in the file; name[i] if several share it
    /// The emission per unit of the grid's value [W/(sr m^3)]; for a blackbody, the fraction of its
    /// radiance that a metre adds (its absorption coefficient, in equilibrium) [1/m]; for a table,
    /// the greatest value of each band.
    PerBand per_unit;
    /// Instead: ascending values, linear in between; none below the first, constant beyond the
    /// last.
    std::vector<Row> table;
    std::optional<Blackbody> blackbody;
    std::optional<Stimulus> stimulus;  ///< with per_unit alone
    int samples = 16;  ///< number of points that represent it where it lights others, 1..1024
    SourceLocation where;

    friend bool operator==(const EmissionDesc&, const EmissionDesc&) = default;
};

/// A VDB or NanoVDB file whose grids add to the water, or a grid that is in memory already.
struct VolumeDesc {
    std::filesystem::path file;
    bool is_sequence = false;  ///< `file` has a pattern for the frame number (frame_pattern.h)
    std::shared_ptr<const LoadedGrid> array;  ///< instead of a file; then `grids` has one
    std::vector<GridMappingDesc> grids;
    std::vector<EmissionDesc> emission;
    Centering centering = Centering::automatic;
    UpAxis up = UpAxis::automatic;
    LevelSets level_sets = LevelSets::refused;
    std::optional<double> voxel_size;  ///< the edge of a voxel [m], instead of the file's
    Affine world_from_upright;         ///< `transform`, applied after `up` has been rotated to y
    std::optional<MotionDesc> motion;
    SourceLocation where;

    friend bool operator==(const VolumeDesc&, const VolumeDesc&) = default;
};

/// `volumes`. Their exposure time is not part of this section and stays 0.
std::vector<VolumeDesc> read_volumes(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
