#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/image/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/passes/pixel_view.h"

namespace uw {

/// All values of one pixel. Radiometric values are means over the pixel's samples; ground truth
/// (`hit` and the depths) refers to the pixel's centre. W m^-2, metres, world space. Radiance
/// (direct, forward, backscatter, clean, lamps) is that in water, W m^-2 sr^-1; in the paper's
/// output it includes the distance-dependent factor (SensorModel::surface_factor).
struct PixelResult {
    double alpha = 0;         // fraction of the samples whose ray enters the water
    double pixel_factor = 1;  // on radiance in images: SensorModel::pixel_factor
    Spectrum direct;
    Spectrum forward;  // added to `direct` by forward scatter: 0 before that pass
    Spectrum backscatter;
    Spectrum backscatter_first;  // of the first slab
    /// All other light, 0 unless multiple scattering is rendered: what the water scattered last,
    /// and what surfaces reflected last.
    Spectrum multiple_volume, multiple_surface;
    /// What marine snow adds, less what it hides of the others; 0 without snow.
    Spectrum snow;
    Spectrum error;          // the standard error of the total, with the pixel's factor
    Spectrum irradiance;     // on the surface, 0 where there is none
    Spectrum exitance;       // of the surface: the part of the irradiance it reflects
    Spectrum clean;          // radiance of the surface without water
    Spectrum transmittance;  // surface to port, mean over the samples that hit a surface
    double lit = 0;          // mean fraction of the lamps that see the surface
    /// Radiance due to each lamp: direct + backscatter + multiple. Empty unless
    /// InScatterParts::lamps.
    std::vector<Spectrum> lamps;
    /// All radiance by how often it was scattered, and by how often it was reflected, as
    /// LayerPlan::order_count; empty unless requested.
    std::vector<Spectrum> orders, reflections;
    bool has_hit = false;  // whether the centre's ray hits a surface
    SurfaceHit hit;
    double depth_z = 0;  // camera-frame z of the hit
    double range = 0;    // from the camera's centre to the hit
    double path = 0;     // in water, from the outer glass surface to the hit
    // Where the centre's point is in other images (PointMatchers), relative to the pixel's centre
    // [pixels], and whether it is hidden there, as 0 or 1; NaN where there is no point or no such
    // image.
    std::array<double, 2> flow, flow_back;
    double flow_occluded = 0;
    /// In the image of the pair's first camera less in that of the other.
    std::array<double, 2> disparity;
    double disparity_occluded = 0;

    /// Resets to an empty pixel, with 0 for each of `lamp_count` lamps. Storage is reused. `bands`:
    /// as many as any pixel that it has held; clearing all costs a tenth of a simple image's time.
    void reset(std::size_t lamp_count, std::size_t bands = k_max_bands);
};

/// Functions that fill a layer's channels from a pixel.
namespace layer_channels {

/// Values as they are, one per band.
template <Spectrum PixelResult::*values>
void spectrum(const PixelResult& pixel, std::span<float> channels) {
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>((pixel.*values)[b]);
}
/// Radiance, which images hold multiplied by the pixel's factor.
template <Spectrum PixelResult::*values>
void radiance(const PixelResult& pixel, std::span<float> channels) {
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(pixel.pixel_factor * (pixel.*values)[b]);
}
/// One number.
template <double PixelResult::*value>
void number(const PixelResult& pixel, std::span<float> channels) {
    channels[0] = static_cast<float>(pixel.*value);
}
/// The sum of `multiple_volume` and `multiple_surface`, each rounded to float before the addition.
void multiple(const PixelResult& pixel, std::span<float> channels);
/// The sum of direct, forward, backscatter, `multiple` and snow, in this order, each rounded to
/// float before the addition, so that in the image they add up to the total to the bit; 0 where
/// snow hides all of them and rounding leaves less.
void total(const PixelResult& pixel, std::span<float> channels);
/// Several numbers.
template <std::array<double, 2> PixelResult::*values>
void pair(const PixelResult& pixel, std::span<float> channels) {
    for (std::size_t i = 0; i < 2; ++i) channels[i] = static_cast<float>((pixel.*values)[i]);
}
void albedo(const PixelResult& pixel, std::span<float> channels);
void normal(const PixelResult& pixel, std::span<float> channels);
void position(const PixelResult& pixel, std::span<float> channels);
void id(const PixelResult& pixel, std::span<float> channels);
void material(const PixelResult& pixel, std::span<float> channels);
/// Leaves them alone: they are filled once the whole image is there (core/sensor).
inline void later(const PixelResult&, std::span<float>) {}

}  // namespace layer_channels

/// How a layer is filled from a pixel.
struct PixelLayer {
    /// The effect of forward scatter, a second pass over the image, on a layer.
    enum class ForwardScatter { leaves, replaces, adds };

    Layer layer;
    void (*fill)(const PixelResult& pixel, std::span<float> channels);
    ForwardScatter forward_scatter = ForwardScatter::leaves;
    bool of_paths = false;          // a mean over light paths: merge_paths
    bool of_exposure = false;       // a mean over the exposure's time, else of its middle
    bool of_hit = false;            // 0 where the centre's ray hits no surface
    bool needs_first_slab = false;  // of the in-scatter
};

/// The contents of each layer, in the order of Layer: omitting one is a compile-time error.
inline constexpr std::array<PixelLayer, k_layer_count> k_pixel_layers{{
    {.layer = Layer::total,
     .fill = layer_channels::total,
     .forward_scatter = PixelLayer::ForwardScatter::replaces,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::direct,
     .fill = layer_channels::radiance<&PixelResult::direct>,
     .forward_scatter = PixelLayer::ForwardScatter::replaces,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::forward,
     .fill = layer_channels::radiance<&PixelResult::forward>,
     .forward_scatter = PixelLayer::ForwardScatter::replaces,
     .of_exposure = true},
    {.layer = Layer::backscatter,
     .fill = layer_channels::radiance<&PixelResult::backscatter>,
     .forward_scatter = PixelLayer::ForwardScatter::replaces,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::backscatter_first,
     .fill = layer_channels::radiance<&PixelResult::backscatter_first>,
     .forward_scatter = PixelLayer::ForwardScatter::adds,
     .of_paths = true,
     .of_exposure = true,
     .needs_first_slab = true},
    {.layer = Layer::multiple,
     .fill = layer_channels::multiple,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::multiple_volume,
     .fill = layer_channels::radiance<&PixelResult::multiple_volume>,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::multiple_surface,
     .fill = layer_channels::radiance<&PixelResult::multiple_surface>,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::snow,
     .fill = layer_channels::radiance<&PixelResult::snow>,
     .of_paths = true,
     .of_exposure = true},
    {.layer = Layer::error,
     .fill = layer_channels::spectrum<&PixelResult::error>,
     .of_exposure = true},
    {.layer = Layer::irradiance,
     .fill = layer_channels::spectrum<&PixelResult::irradiance>,
     .of_exposure = true},
    {.layer = Layer::exitance,
     .fill = layer_channels::spectrum<&PixelResult::exitance>,
     .of_exposure = true},
    {.layer = Layer::lit, .fill = layer_channels::number<&PixelResult::lit>, .of_exposure = true},
    {.layer = Layer::clean,
     .fill = layer_channels::radiance<&PixelResult::clean>,
     .of_exposure = true},
    {.layer = Layer::transmittance,
     .fill = layer_channels::spectrum<&PixelResult::transmittance>,
     .of_exposure = true},
    {.layer = Layer::albedo, .fill = layer_channels::albedo, .of_hit = true},
    {.layer = Layer::depth, .fill = layer_channels::number<&PixelResult::depth_z>, .of_hit = true},
    {.layer = Layer::range, .fill = layer_channels::number<&PixelResult::range>, .of_hit = true},
    {.layer = Layer::path, .fill = layer_channels::number<&PixelResult::path>, .of_hit = true},
    {.layer = Layer::normal, .fill = layer_channels::normal, .of_hit = true},
    {.layer = Layer::position, .fill = layer_channels::position, .of_hit = true},
    {.layer = Layer::id, .fill = layer_channels::id, .of_hit = true},
    {.layer = Layer::material, .fill = layer_channels::material, .of_hit = true},
    {.layer = Layer::sensor, .fill = layer_channels::later},
    {.layer = Layer::flow, .fill = layer_channels::pair<&PixelResult::flow>},
    {.layer = Layer::flow_back, .fill = layer_channels::pair<&PixelResult::flow_back>},
    {.layer = Layer::flow_occluded, .fill = layer_channels::number<&PixelResult::flow_occluded>},
    {.layer = Layer::disparity, .fill = layer_channels::pair<&PixelResult::disparity>},
    {.layer = Layer::disparity_occluded,
     .fill = layer_channels::number<&PixelResult::disparity_occluded>},
}};
static_assert(has_every_layer(k_pixel_layers));

/// Which parts of the in-scatter the layers of `plan` need.
InScatterParts in_scatter_parts(const LayerPlan& plan);

/// Writes a pixel into the channels of `plan`: colour, coverage, and every layer. `channels` are
/// those of a film made with the plan's names.
void store_pixel(const PixelResult& pixel, const LayerPlan& plan, const BandColour& colour,
                 std::span<float> channels);

/// Adds more light paths to channels filled by store_pixel: what is a mean over paths becomes that
/// of all, in which those of `pixel` have the share `weight`. Everything else stays.
void merge_paths(const PixelResult& pixel, double weight, const LayerPlan& plan,
                 const BandColour& colour, std::span<float> channels);

/// Writes what belongs to the middle of an exposure alone, its ground truth: layers not
/// PixelLayer::of_exposure.
void store_truth(const PixelResult& pixel, const LayerPlan& plan, std::span<float> channels);

/// Whether light of these kinds is in an image; else it is 0.
struct LightTerms {
    bool forward = false, multiple = false, snow = false;
};

/// Makes sums of layers, as far as the image holds all of their terms, sums to the bit, in the
/// order of layer_channels::total: after the terms were averaged and rounded.
void restore_sums(const LayerPlan& plan, const LightTerms& terms, const BandColour& colour,
                  std::span<float> channels);

/// Writes the changes due to forward scatter into channels previously filled by store_pixel, except
/// for the lamps. `pixel` holds the light after forward scatter, but in `backscatter_first` only
/// the light added.
void store_forward_scatter(const PixelResult& pixel, const LayerPlan& plan,
                           const BandColour& colour, std::span<float> channels);

/// Adds the contribution of forward scatter to the light of one lamp: `forward` and `backscatter`
/// of `pixel`.
void add_forward_scatter_of_lamp(const PixelResult& pixel, const LayerPlan& plan, std::size_t lamp,
                                 std::span<float> channels);

/// The image of an exposure as the mean over images of its parts. Light is averaged, and sums of
/// layers stay sums to the bit; the transmittance is the mean over what hits a surface. Layers of
/// the exposure's middle are left alone.
class ExposureMean {
  public:
    /// The share of a row's exposure that a part has, 0 to 1; those of all parts add up to 1.
    using RowShare = std::function<double(int row)>;

    /// Adds to `mean`, whose values are 0; it outlives this object, as do `plan` and `colour`.
    /// `terms`: of the images. Throws InputError if there is not enough memory.
    ExposureMean(const LayerPlan& plan, const LightTerms& terms, const BandColour& colour,
                 Film& mean);

    /// Includes the image of a part: with the same channels, and of the window all rows that have
    /// a share.
    void add(const Film& part, const RowShare& share);

    /// After the last part.
    void finish();

  private:
    void add_pixel(std::span<const float> part, float share, float share_so_far,
                   std::span<float> mean) const;
    void add_transmittance(std::span<const float> part, float share, std::span<float> mean,
                           float& on_surface) const;

    const LayerPlan& plan_;
    LightTerms terms_;
    const BandColour& colour_;
    Film& mean_;
    std::vector<std::size_t> channels_;  // that are means
    std::vector<float> shares_;          // so far, of each row of the window
    Grid2D<float> on_surface_;           // share of the exposure that shows a surface
};

}  // namespace uw
