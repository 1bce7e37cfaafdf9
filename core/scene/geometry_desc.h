#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory.h"
#include "core/scene/volume_desc.h"

namespace uw {

struct TriangleMesh;  // core/geometry/mesh.h

/// The unit of a glTF file's light intensities (Blender's exporter offers these three).
enum class LightUnits {
    standard,  ///< candela, as the format defines: W/sr times 683
    compat,    ///< W/sr
    raw,       ///< W in all directions
};

/// What to take from a glTF file besides its meshes (core/geometry/gltf_import.h).
struct GltfImportDesc {
    bool camera = false;
    std::string camera_name;  ///< empty: the file's only one
    SourceLocation camera_where;
    bool all_lamps = false;
    std::vector<std::string> lamps;  ///< by name; empty with all_lamps
    SourceLocation lamps_where;
    LightUnits units = LightUnits::standard;

    bool any_lamps() const { return all_lamps || !lamps.empty(); }
    friend bool operator==(const GltfImportDesc&, const GltfImportDesc&) = default;
};

/// The grid of a VDB or NanoVDB file whose surface is shown (media/volumes/level_set_mesh.h).
struct LevelSetDesc {
    std::string grid;
    UpAxis up = UpAxis::automatic;

    friend bool operator==(const LevelSetDesc&, const LevelSetDesc&) = default;
};

/// Glass: `material: {type: glass}`. Smooth and transparent.
struct GlassDesc {
    double n = 1.5;        ///< refractive index, 1 (air) to 3
    bool is_thin = false;  ///< a surface is a whole pane; else surfaces enclose the glass
    double thickness = 0;  ///< of a thin pane [m]
    PerBand absorption;    ///< [1/m]; empty: none

    friend bool operator==(const GlassDesc&, const GlassDesc&) = default;
};

/// A span of time [s], both ends included.
struct TimeRange {
    double first = 0, last = 0;

    friend bool operator==(const TimeRange&, const TimeRange&) = default;
};

/// One entry of the scene's geometry: the meshes of a file, or a shape.
struct GeometryDesc {
    enum class Type { file, plane, box, sphere };
    Type type = Type::file;
    std::filesystem::path file;
    std::shared_ptr<const TriangleMesh> mesh;  ///< of type file: in memory, instead of one
    std::string mesh_name;
    std::optional<LevelSetDesc> level_set;  ///< of type file: `file` is a VDB file
    bool is_sequence = false;               ///< `file` has a pattern for the frame number
    /// When the nodes of a glTF file move, unless it is one of a sequence (load_scene).
    std::optional<TimeRange> animation;
    std::optional<double> time;  ///< of the animation [s]; none: as its nodes are written
    Affine world_from_object;    ///< of a file's meshes or a shape, in metres
    /// How it moves; then world_from_object is that of the scene's moment.
    std::optional<TrajectoryDesc> trajectory;
    Point3 point;                        ///< of a plane, world [m]
    Vector3 normal{0, 0, 1};             ///< of a plane, world, unit
    Point3 min, max;                     ///< of a box, world [m]
    Point3 center;                       ///< of a sphere, world [m]
    double radius = 0;                   ///< of a sphere [m]
    std::optional<PerBand> reflectance;  ///< 0..1; replaces the file's colours; 0.5 without either
    GltfImportDesc import;
    bool is_pbr =
        false;  ///< a glTF or OBJ file's metallic-roughness materials; else all is diffuse
    bool is_material_given = false;  ///< which of them is written in the scene
    std::optional<GlassDesc> glass;  ///< all of it is of glass
    SourceLocation where;

    friend bool operator==(const GeometryDesc&, const GeometryDesc&) = default;
};

/// `geometry`.
std::vector<GeometryDesc> read_geometry(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
