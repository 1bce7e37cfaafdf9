#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/scene/volume_desc.h"
#include "render/image_scene.h"
#include "render/light_left_out.h"
#include "render/scene_assembly.h"

namespace uw {

/// How clearly the volumes of a scene are visible, from two pictures of it. Light is that of the
/// picture's R, G and B as luminance, so water and backscatter before the volumes count.
struct DraftContrast {
    /// The contrast of a pixel is |with - without| / max(without, mean of the picture without);
    /// this is the 99th percentile over the pixels whose rays pass through the volumes.
    double contrast = 0;
    /// The median of these pixels: far below it where a few of them carry the contrast.
    double median_contrast = 0;
    /// Fraction of the image whose rays pass through the volumes before any surface.
    double seen = 0;
    /// Median luminance of these pixels, relative to the 99th percentile of the whole picture,
    /// which previews show as 0.8.
    double brightness = 0;
    /// 90th percentile of the optical depth of the volumes along these rays, in the middle band.
    double depth = 0;
};

/// Compares a picture of `scene` with one of the same scene without its volumes: same camera, same
/// size.
DraftContrast compare_drafts(const AssembledScene& scene, const Film& with, const Film& without);

/// The scene of a draft by the fast integrator, with the light that the scene asks for, scattered
/// once or all of it, at most `width` pixels wide (render/run/draft.h).
ImageScene quick_draft_of(const ImageScene& scene, int width);

/// The width of drafts, and of the finer ones for volumes that are too small to be visible in them.
inline constexpr int k_draft_width = 128, k_fine_draft_width = 512;
/// Volumes that cover less of the image than this fraction need the finer draft.
inline constexpr double k_min_seen = 0.002;

/// A plume with less contrast than the first is hardly noticeable; from the second on it is clearly
/// visible.
inline constexpr double k_hardly_seen = 0.05, k_plain_to_see = 0.3;

/// A lamp with a beam just wide enough for its target.
struct ProposedLamp {
    std::string name;
    Point3 position;       // world [m]
    Vector3 direction;     // world, unit
    double beam = 0;       // full angle [degrees]
    double intensity = 0;  // on the axis [W/sr], the same in all bands
};

/// A view of the contents of a box: camera, lamps, a floor under it and the water.
struct SceneProposal {
    Point3 eye, target;
    std::vector<ProposedLamp> lamps;
    double floor = 0;   // world y [m]
    std::string water;  // preset
    double size = 0;    // of the box, by which lengths are rounded when written [m]
};

/// The camera that proposals have [pixels, degrees].
inline constexpr int k_proposed_width = 960, k_proposed_height = 540;
inline constexpr double k_proposed_fov = 60;
/// The picture that `--picture` shows. A proposal is judged by it or, in all light, which takes
/// longer, by one of half its size.
inline constexpr int k_picture_width = k_proposed_width / 2,
                     k_picture_height = k_proposed_height / 2;

/// Views the broad side of the box from a little above, so near that it just fits into nine tenths
/// of the picture. One lamp is beside the camera and one behind the box, both out of the picture,
/// so that they light the box and little of the water in front of it.
SceneProposal propose_scene(const Bounds& bounds);

/// The scene file without its volumes: `uwvdb: 2`, camera, water, geometry and lamps.
std::string proposal_yaml(const SceneProposal& proposal);

/// A length as text: to a thousandth of `size`, however large it is.
std::string length_text(double length, double size);

/// A proposed scene and how well it shows its volume.
struct PlumeView {
    SceneProposal proposal;
    double factor = 1;    // by which the volume's concentrations are to be multiplied
    DraftContrast draft;  // of the picture, in the light that the proposal asks for
    std::optional<LightLeftOut> left_out;  // by single scattering, with these concentrations

    /// Whether the proposal asks for all light.
    bool needs_all_light() const { return left_out && left_out->matters(); }
};

/// Receives the progress of the work on a file, 0 to 1, and the next step.
using InfoProgress = std::function<void(double done, const std::string& next)>;
inline void ignore_progress(double /*done*/, const std::string& /*next*/) {}

/// Proposes a scene around `bounds`, those of the contents of `volume`, and searches by drafts for
/// concentrations, and only then for clearer water, at which the volume is clearly visible but not
/// opaque: first by small drafts with single scattering, then, if that leaves out much light, by
/// the picture in all light. At most some thirty drafts are rendered, whatever the volume. `volume`
/// names a file, not a sequence. Throws InputError if it cannot be loaded.
PlumeView view_plume(const VolumeDesc& volume, const Bounds& bounds,
                     const InfoProgress& progress = ignore_progress);

}  // namespace uw
