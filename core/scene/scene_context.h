#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/trajectory.h"

namespace uw {

/// One value per band of the scene, in the order of WaterDesc::bands_nm.
using PerBand = std::vector<double>;

struct WavesDesc;  // core/scene/waves_desc.h

/// The surface of the water: a plane, through which sunlight enters.
struct WaterSurfaceDesc {
    Point3 point;             ///< on it, world [m]
    Vector3 normal{0, 1, 0};  ///< out of the water, world, unit
    /// The water's refractive index relative to that of the air. None: the surface neither refracts
    /// nor reflects, and suns are given as they are below it.
    std::optional<double> n{};
    std::shared_ptr<const WavesDesc> waves{};  ///< null: calm; only with `n`

    friend bool operator==(const WaterSurfaceDesc&, const WaterSurfaceDesc&) = default;
};

struct LoadedGrid;    // media/volumes/loaded_grid.h
struct TriangleMesh;  // core/geometry/mesh.h
struct SpeciesDesc;   // core/scene/species_desc.h

/// Data that a scene refers to by name instead of reading it from files: grids of volumes as
/// `array`, meshes of geometry as `mesh`.
struct SceneArrays {
    std::map<std::string, std::shared_ptr<const LoadedGrid>> grids;
    std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes;
};

/// A key of the scene file that names a file.
struct FileKey {
    std::string_view path;  ///< "lamps[*].profile.file": a * stands for any text
    std::string_view what;  ///< for messages: "a lamp profile of the scene"
    /// Whether the file's content is part of SceneDesc::hash: a change shows without its date.
    bool is_hashed = false;
};

/// All of them. A file that a scene names is read by read_existing_file or
/// read_existing_file_or_sequence, which know no others.
inline constexpr std::array k_file_keys = std::to_array<FileKey>({
    {"camera*.calibration", "a calibration of the scene", true},
    {"camera*.calibration.file", "a calibration of the scene", true},
    {"camera*.sensor.quantum_efficiency", "the quantum efficiency of a sensor"},
    {"camera*.sensor.quantum_efficiency.file", "the quantum efficiency of a sensor"},
    {"camera*.sensor.image.response", "the response curve of a camera"},
    {"camera*.trajectory.file", "a trajectory of the scene", true},
    {"rig.trajectory.file", "a trajectory of the scene", true},
    {"water.scattering.phase.file", "a phase function of the scene"},
    {"water.species.*.size.file", "a species of the water"},
    {"water.species.*.coat.index.file", "a species of the water"},
    {"water.species.*.index.file", "a species of the water"},
    {"water.species.*.vsf", "a species of the water"},
    {"water.species.*.absorption.file", "a species of the water"},
    {"water.profile", "the profile of the water"},
    {"water.surface.waves.file", "the waves of the water"},
    {"volumes[*].file", "a volume of the scene"},
    {"volumes[*].velocity.file", "a velocity file of the scene"},
    {"volumes[*].grids.*.phase.file", "a phase function of the scene"},
    {"geometry[*].file", "a mesh of the scene"},
    {"geometry[*].trajectory.file", "a trajectory of the scene", true},
    {"lamps[*].profile.file", "a lamp profile of the scene"},
    {"lamps[*].spectrum.file", "a lamp spectrum of the scene"},
    {"lamps[*].trajectory.file", "a trajectory of the scene", true},
    {"sensors[*].file", "a sensor of the scene"},
    {"sky.file", "the sky of the scene"},
    {"sky.spectrum.file", "the sky of the scene"},
    {"render.response", "the response of the scene"},
    {"render.white.file", "the white light of the scene"},
    {"render.view.config", "the OpenColorIO view of the scene"},
    {"variations.*table", "the values of variations"},
});

/// A file that a scene names.
struct NamedFile {
    const FileKey* key;
    std::filesystem::path file;
    bool is_sequence = false;  ///< `file` has the pattern of a frame's number
};

/// Shared by the readers of a scene's sections. Each reads and fully checks one section, and throws
/// InputError "file:line:column: key path: what; hint" for invalid input.
struct SceneContext {
    std::filesystem::path folder;        // of the scene file; file names are relative to it
    std::size_t band_count = 0;          // of water.bands, which is read first
    std::vector<std::string>* warnings;  // one line each
    std::optional<WaterSurfaceDesc> water_surface{};  // of water, which is read before the lamps
    /// For a scene with a rig, which is read before its lamps.
    struct RigFrames {
        Affine world_from_rig, world_from_camera;  // the first camera's
    };
    std::optional<RigFrames> rig{};
    std::optional<TrajectoryDesc> rig_trajectory{};  // likewise
    /// The species of the water, which is read before the volumes; null: there are none.
    const std::vector<SpeciesDesc>* species = nullptr;
    const SceneArrays* arrays = nullptr;  // null: the scene has files alone
    std::vector<NamedFile>* files =
        nullptr;  // to which those that keys name are added; may be null

    /// Adds the warning "<location>: <what>".
    void warn(const ConfigValue& value, const std::string& what) const {
        warnings->push_back(value.location() + ": " + what);
    }
};

/// A file name, resolved against the scene's folder; the file is admitted as an input
/// (admit_input). Throws InputError if no such file exists.
std::filesystem::path read_existing_file(const ConfigValue& value, const SceneContext& context);

/// The same, but a name with patterns for the frame number that is not itself a file denotes a
/// sequence; its files are not checked.
std::filesystem::path read_existing_file_or_sequence(const ConfigValue& value,
                                                     const SceneContext& context,
                                                     bool& is_sequence);

/// Throws InputError: nothing in memory has this name.
[[noreturn]] void fail_not_in_memory(const ConfigValue& value, const std::string& name);

/// The element of `known` that `value` names. `known` is null if the scene has only files. Throws
/// InputError if there is no such element.
template <class T>
std::shared_ptr<const T> read_in_memory(
    const ConfigValue& value, const std::map<std::string, std::shared_ptr<const T>>* known) {
    const std::string name = value.text("give its name in memory");
    if (known != nullptr)
        if (const auto found = known->find(name); found != known->end()) return found->second;
    fail_not_in_memory(value, name);
}

/// A name that becomes part of `of` ("a layer's name"): up to 64 letters, digits, _ and -.
std::string read_short_name(const ConfigValue& value, std::string_view of, std::string_view hint);

}  // namespace uw
