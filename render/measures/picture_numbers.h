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

/// One layer of a picture, perhaps of a single lamp: for pixel i (row by row) and band b the value
/// `gain[b] * values[i * stride + b]`. Lamps are mixed by their gains without being rendered again.
struct PicturePlane {
    std::span<const float> values;
    std::size_t stride = 0;
    Spectrum gain;
};

/// The planes of those of `layers` that an image has, times `gain`. They refer to `film`.
std::vector<PicturePlane> layer_planes(const Film& film, const LayerPlan& plan,
                                       std::initializer_list<Layer> layers, double gain = 1);

/// The mean of a pixel's bands in a sum of layers.
class GreyLayers {
  public:
    /// `planes` outlive it.
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

/// 0 of no values.
double mean_of(std::span<const double> values);

/// The mean of the values between two shares of their number, from the least on; the value in the
/// middle of the two if there is none between them. Orders the values as it needs.
double mean_between(std::span<double> values, double low, double high);

/// The value below which a share of the values lies, between its neighbours. Orders the values as
/// it needs. Precondition: there are some.
double percentile(std::span<double> values, double share);

/// The numbers by which a designer of lamps judges a picture. The light of a pixel is the mean of
/// its bands. What comes from surfaces is signal, what the water scatters on its way is
/// backscatter.

/// The layers of a picture by what they mean; those of one kind are added up.
struct PictureLayers {
    int width = 0, height = 0;
    std::size_t bands = 0;
    std::vector<PicturePlane> signal;       // direct, forward; multiple.surface
    std::vector<PicturePlane> backscatter;  // backscatter, snow; multiple.volume
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
    double min_to_mean = 0;  // the uniformity U0 of lighting engineers
    /// percentile5 / mean, which a single dark corner does not decide.
    double percentile5_to_mean = 0;
    std::size_t pixels = 0;
};

/// What a picture shows, of the whole or of a part.
struct PictureNumbers {
    double signal = 0, backscatter = 0;  // means over the pixels [W m^-2 sr^-1]
    /// signal / backscatter; infinite without backscatter, 0 without either.
    double signal_to_backscatter = 0;
    /// Michelson contrast (bright - dark) / (bright + dark) of the total light. Where surfaces are
    /// patterned it is a mean over tiles of a sixteenth of the picture's shorter side, or 8 pixels:
    /// in each, bright is the mean of the quarter of its pixels with the greatest albedo (and of
    /// all with the same), dark of that with the least, without those at edges. However unevenly
    /// the picture is lit, that adds nothing. Without a pattern or a layer of albedo, bright is the
    /// mean of the pixels between the light's percentiles 75 and 95, dark that between 5 and 25. 0
    /// in the dark.
    double contrast = 0;
    /// The contrast of the same surfaces without water; none if the picture has no such layer.
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

/// How the light of some pixels, the mean of each one's bands, is spread [W m^-2 sr^-1].
struct Distribution {
    double mean = 0, percentile5 = 0, median = 0, percentile95 = 0;
};

/// The light of some pixels of an image, or of one lamp in it, by where it comes from; definitions
/// in docs/edit-numbers.md.
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
    /// What surfaces emit, to be taken away: the same scene without lamps, with the same layers.
    const Film* emitted = nullptr;
};

/// The layers that light_numbers reads, of an image: an argument of --layers.
std::string layers_to_measure(const ImageScene& scene);

/// Precondition: there are pixels, and all lie within the film's window, by whose rows they are
/// counted.
LightNumbers light_numbers(const MeasuredImage& image, std::span<const std::size_t> pixels);

/// Some pixels of an image, by their index within its window.
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

/// The numbers of all light in an image that has the layers to measure.
std::vector<PartNumbers> part_numbers(const MeasuredImage& image,
                                      const std::vector<PicturePart>& parts,
                                      const std::string& lamp = {});

/// The numbers of each lamp's light: `scene`, whose image the parts are of, is rendered again for
/// each of its lamps alone, and once without any for what surfaces emit. `options` are those of the
/// image; the layers in them do not matter. `begin` is called before each with its index, 0 to the
/// number of lamps. Throws as Renderer.
std::vector<PartNumbers> lamp_numbers(Renderer& renderer, const ImageScene& scene,
                                      const RenderOptions& options,
                                      const std::vector<PicturePart>& parts,
                                      const std::function<void(std::size_t image)>& begin = {});

}  // namespace uw
