#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/geometry/surfaces.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// A position in the image of a camera, and the point that is imaged there.
struct SeenPixel {
    ImagePoint pixel;
    Point3 point;  // camera frame [m]
};

/// The reprojection error of a model of a camera [pixels]. A point that the model does not image at
/// all counts with an error of the image's diagonal.
struct ModelError {
    double median = 0, rms = 0, worst = 0;

    friend bool operator==(const ModelError&, const ModelError&) = default;
};

/// `model` has no port; its pose is not used. Precondition: `seen` is not empty.
ModelError model_error(const CameraDesc& model, std::span<const SeenPixel> seen);

/// Fits a camera without a port, at the same position, to the images of these points in `camera`
/// through its port (least squares): COLMAP's OPENCV_FISHEYE of a fisheye lens, else OPENCV, whose
/// k3 is fitted as well if the lens has more than two radial coefficients. Throws InputError if the
/// points do not determine it.
CameraDesc fit_pinhole(const CameraDesc& camera, std::span<const SeenPixel> seen);

/// The model without a port of a camera with one, for the surfaces that are visible in a draw's
/// views.
struct PinholeFit {
    double nearest = 0, median = 0, farthest = 0;  // surfaces, without 5 % at either end [m]
    ModelError in_air;                             // of the camera's own lens
    ModelError fitted;
    IntrinsicsDesc intrinsics;  // fitted
    DistortionDesc distortion;

    friend bool operator==(const PinholeFit&, const PinholeFit&) = default;
};

/// The fits of a draw's cameras, in the order of the set; none for a camera without a port, and for
/// one in whose views no surface is visible.
using PinholeFits = std::vector<std::optional<PinholeFit>>;

/// Fits every camera that has a port to what it sees in up to 16 of its views, evenly over the
/// image and past the surfaces of the draw's first frame. `scene` is the draw's, as it was read.
PinholeFits fit_pinholes(const DatasetDefinition& definition, std::size_t draw,
                         const SceneDesc& scene, const Surfaces& surfaces);

/// The file of a draw's fits, relative to the set's folder.
std::string pinhole_file(const DatasetDefinition& definition, std::size_t draw);
std::string pinhole_text(const PinholeFits& fits);
/// Throws IoError, and InputError for anything but pinhole_text's of as many cameras.
PinholeFits read_pinholes(const std::filesystem::path& file, std::size_t cameras);

/// A camera as formats without ports describe it: fitted, if `is_fitted` and there is a fit, or
/// else with its lens in air.
CameraDesc without_port(CameraDesc camera, const std::optional<PinholeFit>& fit, bool is_fitted);

/// "28.5 px in the median, 31.3 px RMS, 66.2 px at most".
std::string error_text(const ModelError& error);

/// One line about the cameras of these fits in `formats`, which know no port and have them fitted,
/// for a run's messages: their errors as fitted, and in air. Empty if these do not matter.
std::string fitted_message(const std::string& formats, const PinholeFits& fits);

/// The same for `formats` that describe cameras as in air; --pinhole-fit fits, or would fit, those
/// of `fittable`.
std::string in_air_message(const std::string& formats, const std::string& fittable,
                           const PinholeFits& fits);

}  // namespace uw
