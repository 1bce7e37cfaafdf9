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
    Spectrum lamps_in_view;  // the part of `direct` that comes from lamps themselves
    Spectrum forward;        // added to `direct` by forward scatter: 0 before that pass
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
    /// What the samples see of surfaces, by the identifiers of mattes (core/image/cryptomatte.h).
    struct SeenSurface {
        float object = 0, material = 0;
        double share = 0;  // of the pixel
    };
    std::vector<SeenSurface> seen;
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

    /// Multiplies all light by a factor per band, but that of the first slab, of which there is
    /// none: what is seen in a mirror.
    void dim(const Spectrum& factor);

    bool shows_lamp = false;  // whether any sample sees a lamp's surface
    /// Resets to an empty pixel, with 0 for each of `lamp_count` lamps. Storage is reused. `bands`:
    /// as many as any pixel that it has held; clearing all costs a tenth of a simple image's time.
    void reset(std::size_t lamp_count, std::size_t bands = k_max_bands);
};

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
/// LayerKind::of_exposure.
void store_truth(const PixelResult& pixel, const LayerPlan& plan, std::span<float> channels);

/// Writes the changes due to forward scatter into channels previously filled by store_pixel, except
/// for the lamps. `pixel` holds the light after forward scatter, but in `backscatter_first` only
/// the light added.
void store_forward_scatter(const PixelResult& pixel, const LayerPlan& plan,
                           const BandColour& colour, std::span<float> channels);

/// Adds the contribution of forward scatter to the light of one lamp: `forward` and `backscatter`
/// of `pixel`.
void add_forward_scatter_of_lamp(const PixelResult& pixel, const LayerPlan& plan, std::size_t lamp,
                                 std::span<float> channels);

/// Takes the light of `bands` into `film` from an image of the same pixels that another camera
/// sees, that of their wavelength. The colour of each film is the share of its own bands
/// (BandColour::of): they are added. What is not of a band stays: coverage, mattes and ground
/// truth.
void take_bands(const Film& from, std::span<const std::size_t> bands, const LayerPlan& plan,
                Film& film);

/// Adds the light of the image of the same pixels that the camera sees in the water's surface.
/// Ground truth stays that of what is seen without it. Sums of layers stay sums to the bit.
void add_mirrored(const Film& mirrored, const LayerPlan& plan, const BandColour& colour,
                  Film& film);

/// The image of an exposure as the mean over images of its parts. Light is averaged, and sums of
/// layers stay sums to the bit; the transmittance is the mean over what hits a surface. Layers of
/// the exposure's middle are left alone.
class ExposureMean {
  public:
    /// The share of a row's exposure that a part has, 0 to 1; those of all parts add up to 1.
    using RowShare = std::function<double(int row)>;

    /// Whether the errors of an exposure's parts are independent, as those of light paths are, or
    /// may all be alike.
    enum class Errors { independent, alike };

    /// Adds to `mean`, whose values are 0; it outlives this object, as do `plan` and `colour`.
    /// Throws as require_memory.
    ExposureMean(const LayerPlan& plan, const BandColour& colour, Errors errors, Film& mean);

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
    const BandColour& colour_;
    Errors errors_;
    Film& mean_;
    std::vector<std::size_t> channels_;  // that are means
    std::vector<float> shares_;          // so far, of each row of the window
    Grid2D<float> on_surface_;           // share of the exposure that shows a surface
};

}  // namespace uw
