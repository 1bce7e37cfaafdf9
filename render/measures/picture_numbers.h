#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/scene/scene_desc.h"
#include "render/renderer.h"

namespace uw {

/// One layer of a picture, perhaps of a single lamp. Its value for pixel i (row by row) and band b
/// is `gain[b] * values[i * stride + b]`, so that lamps can be mixed without rendering again.
struct PicturePlane {
    std::span<const float> values;
    std::size_t stride = 0;
    Spectrum gain;
};

/// Returns the planes of those of `layers` that an image has, times `gain`. They refer to `film`.
std::vector<PicturePlane> layer_planes(const Film& film, const LayerPlan& plan,
                                       std::initializer_list<Layer> layers, double gain = 1);

/// Computes the mean over a pixel's bands of a sum of layers.
class GreyLayers {
  public:
    /// `planes` must outlive this object.
    GreyLayers(const std::vector<PicturePlane>& planes, std::size_t bands)
        : planes_(planes), bands_(bands) {}

    bool empty() const { return planes_.empty(); }
    double at(std::size_t pixel) const {
        double sum = 0;
        for (const PicturePlane& plane : planes_)
            for (std::size_t b = 0; b < bands_; ++b)
                sum += plane.gain[b] * static_cast<double>(plane.values[pixel * plane.stride + b]);
        return sum / static_cast<double>(bands_);
    }

  private:
    const std::vector<PicturePlane>& planes_;
    std::size_t bands_;
};

/// Returns the mean of `values`, 0 without any.
double mean_of(std::span<const double> values);

/// Returns the mean of the values between the quantiles `low` and `high`, 0 to 1, or the value in
/// the middle of these if there is none between them. Reorders the values.
double mean_between(std::span<double> values, double low, double high);

/// Returns the value below which a `fraction` of the values lies, interpolated between its
/// neighbours. Reorders the values. Precondition: there is a value.
double percentile(std::span<double> values, double fraction);

/// The numbers by which a designer of lamps judges a picture. The light of a pixel is the mean over
/// its bands. Light from surfaces is the signal; in-scattered light is backscatter.

/// The layers of a picture by their meaning; those of one kind are summed.
struct PictureLayers {
    int width = 0, height = 0;
    std::size_t bands = 0;
    std::vector<PicturePlane> signal;       // direct, forward; multiple.surface
    std::vector<PicturePlane> backscatter;  // backscatter, snow; multiple.volume
    std::vector<PicturePlane> clean;        // may be empty
    std::vector<PicturePlane> irradiance;   // may be empty
    std::vector<PicturePlane> albedo;       // may be empty
};

/// The layers that picture_layers reads: an argument of --layers.
inline constexpr const char* k_picture_layers =
    "direct,forward,backscatter,clean,irradiance,albedo";

/// Returns the layers of a rendered image, apart from those it does not have. Refers to `film`.
PictureLayers picture_layers(const Film& film, const LayerPlan& plan);

/// How evenly surfaces are lit: the irradiance at the pixels that see a surface [W m^-2]. In
/// pictures without albedo, surfaces in the dark do not count; in pictures with it, black ones do
/// not.
struct Evenness {
    double mean = 0, least = 0, greatest = 0;
    double percentile5 = 0, median = 0, percentile95 = 0;
    double min_to_mean = 0;  // the uniformity U0 of lighting engineers
    /// percentile5 / mean, which does not depend on a single dark corner.
    double percentile5_to_mean = 0;
    std::size_t pixels = 0;
};

/// Numbers of a picture, or of a part of it.
struct PictureNumbers {
    double signal = 0, backscatter = 0;  // means over the pixels [W m^-2 sr^-1]
    /// signal / backscatter; infinite without backscatter, 0 without either.
    double signal_to_backscatter = 0;
    /// Michelson contrast (bright - dark) / (bright + dark) of the total light; 0 in the dark. If
    /// surfaces are patterned, it is a mean over tiles of a sixteenth of the picture's shorter
    /// side, or 8 pixels: in each, bright is the mean over the quarter of its pixels with the
    /// greatest albedo (and over all with the same), dark that over the quarter with the least,
    /// without pixels at edges. Uneven lighting does not add to it. Without a pattern or a layer of
    /// albedo, bright is the mean of the pixels between the light's percentiles 75 and 95, dark
    /// that between 5 and 25.
    double contrast = 0;
    /// The contrast of the same surfaces without water; none if the picture has no such layer.
    std::optional<double> clean_contrast;
    /// The fraction of pixels whose signal is at least `ratio` times their backscatter.
    double fraction_above = 0;
    /// The fraction of the light from surfaces that the water attenuates on its path from the lamps
    /// and to the camera, 1 - signal / clean.
    std::optional<double> lost_to_water;
    std::optional<Evenness> evenness;
};

/// Returns the indices, row by row, of the pixels in a part of a picture.
std::vector<std::size_t> pixels_within(const PixelWindow& part, int width);

/// Computes the numbers of some pixels. Precondition: there is a pixel, and all lie within the
/// picture.
PictureNumbers measure_picture(const PictureLayers& picture, std::span<const std::size_t> pixels,
                               double ratio = 1);
/// Computes the numbers of the pixels in `part`. Precondition: it is not empty and lies within the
/// picture.
PictureNumbers measure_picture(const PictureLayers& picture, const PixelWindow& part,
                               double ratio = 1);

/// Finds the part with the strongest pattern: the square of `side` pixels in which the albedo has
/// the greatest standard deviation, such as on a checkerboard. It does not depend on the lamps.
/// None if no surface is patterned, or the picture has no albedo.
std::optional<PixelWindow> patterned_part(const PictureLayers& picture, int side);

/// The distribution of the light of some pixels, each the mean over its bands [W m^-2 sr^-1].
struct Distribution {
    double mean = 0, percentile5 = 0, median = 0, percentile95 = 0;
};

/// The light of some pixels of an image, or of one lamp in it, by its origin
/// (docs/edit.md).
struct LightNumbers {
    std::size_t pixels = 0;
    Distribution direct, forward, backscatter;
    std::optional<Distribution> multiple;  // with multiple scattering
    PictureNumbers picture;
};

/// An image that has the layers to measure.
struct MeasuredImage {
    const Film& film;
    const LayerPlan& plan;
    /// The emission of surfaces, to be subtracted: the same scene without lamps, with the same
    /// layers.
    const Film* emitted = nullptr;
};

/// Returns the layers that light_numbers reads of an image: an argument of --layers.
std::string layers_to_measure(const ImageScene& scene);

/// Computes the numbers of some pixels, whose indices count the film's window row by row.
/// Precondition: there is a pixel, and all lie within the window.
LightNumbers light_numbers(const MeasuredImage& image, std::span<const std::size_t> pixels);

/// Some pixels of an image, by their indices in its window.
struct PicturePart {
    std::string name;
    std::vector<std::size_t> pixels;
};

/// The numbers of one part of an image, of all its light or of one lamp's.
struct PartNumbers {
    std::string part;
    std::string lamp;  // empty: all light
    LightNumbers numbers;
};

/// Computes the numbers of all light in an image that has the layers to measure.
std::vector<PartNumbers> part_numbers(const MeasuredImage& image,
                                      const std::vector<PicturePart>& parts,
                                      const std::string& lamp = {});

/// Computes the numbers of each lamp's light. Renders `scene`, to whose image the parts refer, with
/// each of its lamps alone, and once without lamps for the emission of surfaces. `options` are
/// those of the image; their layers do not matter. `begin` is called before each image with its
/// index, 0 to the number of lamps. Throws as Renderer.
std::vector<PartNumbers> lamp_numbers(Renderer& renderer, const ImageScene& scene,
                                      const RenderOptions& options,
                                      const std::vector<PicturePart>& parts,
                                      const std::function<void(std::size_t image)>& begin = {});

}  // namespace uw
