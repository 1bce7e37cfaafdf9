#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/json.h"
#include "core/base/ray.h"
#include "core/scene/geometry_desc.h"
#include "core/scene/yaml_document.h"
#include "edit/session/edited_scene.h"

namespace uw {

/// A straight edge in the world [m].
struct OutlineSegment {
    std::array<float, 3> from{}, to{};
};

/// Edges by which the shapes of a scene can be recognised in a plan. A mesh has those at its rims
/// and where faces meet at more than 30 degrees, a box all, a sphere three great circles, and a
/// plane, which has no end, none. If there are more than `most`, the longest are kept. A mesh that
/// cannot be read has none: rendering reports that.
std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most = 20000);

/// Data about a scene once it has been assembled.
struct SceneShapes {
    std::vector<OutlineSegment> outlines;
    std::vector<Bounds> volumes;  // world; one per volume, perhaps empty
};

Json outline_segments_json(const std::vector<OutlineSegment>& outlines);

// The state:
//
//   {"revision": 12,                    // grows with every change of the scene
//    "scene": "plume.yaml", "folder": "/home/...", "unsaved": true,
//    "changed_on_disk": false, "deleted_on_disk": false,
//    "can_undo": true, "can_redo": false, "undo_label": "move left", "redo_label": null,
//    "error": null,                     // or {"message", "line", "column"}
//    "warnings": ["..."],
//    "light": ["multiple"],             // of "forward", "multiple", "snow" those of the scene
//    "light_note": null,                // or what single scattering leaves out
//    "not_shown": ["..."],              // how the picture differs from that of render
//    "view": null,                      // or {"name", "key", "side", "least", "octaves"}
//    "image": {"width", "height", "bands": [620, 540, 450], "bands_are_rgb": true},
//    "camera": {"name", "position", "forward", "right", "up",
//               "frustum": [4 points, 1 m into the water, clockwise from the top left],
//               "port": null},          // or {"type": "flat", ..., "path": "camera.port" or null,
//                                       //     "materials": {"n_air", "n_glass", "n_water"}}
//    "rig": false, "cameras": ["left", "right"],           // of a rig, else none
//    "moment": null,                    // or {"first", "last", "frame", "time"}: what moves
//    "lamps": [...],
//    "ies_files": ["..."], "spectra": [{"type": "led", "name": "LED-B3"}, ...],
//    "water": {"preset", "presets", "particles": {"small", "large"}, "salinity", "temperature",
//              "path": "water", "keys": {...}},            // keys: what the file says
//    "volumes": [{"index", "file", "path", "bounds": {"min", "max"} or null,
//                 "concentrations": {"density": {"small": 2, "large": 10}}}],
//    "outlines": {"key": 1, "count": 318}}
//
// While no version of the scene could be read yet, only the members up to "error" are there; later
// the last good one stays. A lamp:
//
//   {"index": 0, "name": "left", "path": "lamps[0]" or null, "editable": true, "why_not": null,
//    "on": true,                        // not part of the scene file
//    "frame": "camera",                 // or "rig", "world", "trajectory"
//    "position": [3], "direction": [3], // in its frame
//    "world_position": [3], "world_direction": [3],
//    "profile": {"type": "spot", "beam": 60, "edge": 5}, "half_angle": 30 or null,
//    "extent": null,                    // or {"type": "rectangle", "width", "height", "rotate",
//                                       //     "samples"}, or {"type": "disk" | "sphere", "radius",
//                                       //     "samples"}
//    "sun": null or {"angle", "samples"},   // positions and handles of a sun mean nothing
//    "brightness": {"kind": "intensity" | "power" | "lumens" | "profile" | "irradiance" | "lux",
//                   "unit", "value", "spectrum"},
//    "band_intensity": [...],           // on the axis [W/sr], per band; a sun's irradiance
//    "rgb_scale": [3],                  // to compare with lamp_brightness of a picture
//    "handle": {"point": [3], "pixel": [u, v] or null, "inside": true, "rim": [u, v]},
//    "axis_handle": {...},              // the same, of the point 1 m ahead of the lamp
//    "cone": [[u, v], ...]}             // outline of the beam up to there; perhaps empty
//
// Pixels are those of the full image, (0, 0) its corner. "pixel" is null where the camera cannot
// see the point; "rim" is the pixel, or where the line from the image's centre to it leaves the
// image.

/// The parts of the state that describe the scene: "image", "camera", "lamps", "water", "volumes"
/// and so on. `tree` is the scene file's; `shapes` may be null.
Json scene_json(const EditedScene& edited, const ConfigNode& tree, const SceneShapes* shapes);

}  // namespace uw
