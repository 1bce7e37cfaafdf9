#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"

namespace uw {

/// Bands that share their rays.
struct ColourGroup {
    double wavelength_nm = 0;        ///< of the rays
    std::vector<std::size_t> bands;  ///< ascending
};

/// How far apart two wavelengths show the same point of the water, where that is most of the image.
struct LateralColour {
    double pixels = 0;
    ImagePoint at;  ///< in the image of the first wavelength [pixels]
};

/// The lateral colour of a camera's port between two wavelengths, over the image and for points
/// from 0.25 m to 1 km from the glass. 0 where no index depends on the wavelength.
LateralColour lateral_colour(const CameraDesc& camera, double from_nm, double to_nm);

/// The shift of a band in the image relative to light of the camera's wavelength: the lateral
/// colour between the two.
struct BandShift {
    double wavelength_nm = 0;
    double pixels = 0;
};

/// The shifts of bands, in their order; none where no index depends on the wavelength.
std::vector<BandShift> band_shifts(const CameraDesc& camera, std::span<const double> bands_nm);

/// "up to 1.93 pixels at 620 nm, 3.01 at 450 nm", without the camera's own wavelength.
std::string text_of(std::span<const BandShift> shifts);

/// Lateral colour up to which bands share their rays [pixels].
inline constexpr double k_shared_rays = 0.1;

/// Divides the bands of a scene into groups that share rays, each of whose bands is imaged within
/// `tolerance` pixels of its group. The first group's rays are those of the camera's own
/// wavelength; a single one if no index depends on the wavelength.
std::vector<ColourGroup> colour_groups(const CameraDesc& camera, std::span<const double> bands_nm,
                                       double tolerance = k_shared_rays);

}  // namespace uw
