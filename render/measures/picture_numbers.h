#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/film.h"
#include "core/image/layers.h"
#include "render/measures/pixel_values.h"

/// The numbers by which a designer of lamps judges a picture. The light of a pixel is the mean of
/// its bands. What comes from surfaces is signal, what the water scatters on its way is
/// backscatter.
namespace uw {

/// The layers of a picture by what they mean; those of one kind are added up.
struct PictureLayers {
    int width = 0, height = 0;
    std::size_t bands = 0;
    std::vector<PicturePlane> signal;       // direct, forward; multiple.surface
    std::vector<PicturePlane> backscatter;  // backscatter; multiple.volume
    std::vector<PicturePlane> clean;        // perhaps none
    std::vector<PicturePlane> irradiance;   // perhaps none
    std::vector<PicturePlane> albedo;       // perhaps none
};

/// The layers that picture_layers reads: an argument of --layers.
inline constexpr const char* k_picture_layers =
    "direct,forward,backscatter,clean,irradiance,albedo";

/// A rendered image as its layers; those it lacks are left out. Refers to `film`.
PictureLayers picture_layers(const Film& film, const LayerPlan& plan);

/// How evenly surfaces are lit: irradiance at the pixels that see one, each pixel once [W m^-2]. In
/// pictures without albedo, surfaces in the dark, and black ones with it, do not count.
struct Evenness {
    double mean = 0, least = 0, greatest = 0;
    double percentile5 = 0, median = 0, percentile95 = 0;
    double least_to_mean = 0;  // the uniformity U0 of lighting engineers
    /// percentile5 / mean, which a single dark corner does not decide.
    double percentile5_to_mean = 0;
    std::size_t pixels = 0;
};

/// What a picture shows, of the whole or of a part.
struct PictureNumbers {
    double signal = 0, backscatter = 0;  // means over the pixels [W m^-2 sr^-1]
    /// signal / backscatter; infinite without backscatter, 0 without either.
    double signal_to_backscatter = 0;
    /// Michelson contrast (bright - dark) / (bright + dark) of the total light. Bright is the mean
    /// of the pixels between its percentiles 75 and 95, dark that between 5 and 25: of a black and
    /// white pattern that fills the part, however its squares lie, neither its edges nor single
    /// pixels matter. 0 in the dark.
    double contrast = 0;
    /// That of the same surfaces without water; none if the picture has no such layer.
    std::optional<double> clean_contrast;
    /// The share of the pixels whose signal is at least `ratio` times their backscatter.
    double share_above = 0;
    /// The share of the light from surfaces that the water takes on its way from the lamps and to
    /// the camera, 1 - signal / clean.
    std::optional<double> lost_to_water;
    std::optional<Evenness> evenness;
};

/// The pixels of a part of a picture, by their index row by row.
std::vector<std::size_t> pixels_within(const PixelWindow& part, int width);

/// The numbers of some pixels. Precondition: there are some, and all lie within the picture.
PictureNumbers measure_picture(const PictureLayers& picture, std::span<const std::size_t> pixels,
                               double ratio = 1);
/// The numbers of the pixels in `part`. Precondition: it is not empty and lies within the picture.
PictureNumbers measure_picture(const PictureLayers& picture, const PixelWindow& part,
                               double ratio = 1);

/// Where the surfaces are patterned most strongly: the square of `side` pixels in which their
/// albedo varies most (standard deviation), which on a checkerboard is on its squares. It does not
/// depend on the lamps. None if no surface is patterned, or the picture has no albedo.
std::optional<PixelWindow> patterned_part(const PictureLayers& picture, int side);

}  // namespace uw
