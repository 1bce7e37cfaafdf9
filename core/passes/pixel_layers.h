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

/// All values of one pixel, in W m^-2, metres and world space. Radiometric values are means over
/// the pixel's samples; ground truth (`hit` and the depths) is that of the pixel's centre. Radiance
/// (direct, forward, backscatter, clean, lamps) is that in water, W m^-2 sr^-1; in the paper's
/// output, it includes the factor that depends on distance (SensorModel::surface_factor).
struct PixelResult {
    double alpha = 0;         // fraction of the samples whose ray enters the water
    double pixel_factor = 1;  // factor on radiance in images: SensorModel::pixel_factor
    Spectrum direct;
    Spectrum lamps_in_view;  // the part of `direct` that comes from lamps themselves
    Spectrum forward;        // added by forward scatter; 0 before that pass
    Spectrum backscatter;
    Spectrum backscatter_first;  // of the first slab
    /// Multiple scattering, 0 unless it is rendered: light that was last scattered by the water,
    /// and light that was last reflected by a surface.
    Spectrum multiple_volume, multiple_surface;
    /// The light of marine snow minus what it hides of the rest; 0 without snow.
    Spectrum snow;
    Spectrum error;          // the standard error of the total, with the pixel's factor
    Spectrum irradiance;     // on the surface, 0 where there is none
    Spectrum exitance;       // of the surface: the part of the irradiance that it reflects
    Spectrum clean;          // radiance of the surface without water
    Spectrum transmittance;  // surface to port, mean over the samples that hit a surface
    double lit = 0;          // mean visibility of the lamps from the surface
    /// Radiance due to each lamp: direct + backscatter + multiple. Empty unless
    /// InScatterParts::lamps.
    std::vector<Spectrum> lamps;
    /// All radiance by the number of its scatterings, and by that of its reflections
    /// (LayerPlan::order_count); empty unless requested.
    std::vector<Spectrum> orders, reflections;
    /// The surfaces that the samples see, by their identifiers in mattes
    /// (core/image/cryptomatte.h).
    struct SeenSurface {
        float object = 0, material = 0;
        double fraction = 0;  // of the pixel
    };
    std::vector<SeenSurface> visible_surfaces;
    bool has_hit = false;  // whether the centre's ray hits a surface
    SurfaceHit hit;
    double depth_z = 0;  // camera-frame z of the hit
    double range = 0;    // from the camera's centre to the hit
    double path = 0;     // in water, from the outer glass surface to the hit
    // The particles of volumes along the centre's ray up to the hit, 0 unless they are wanted
    // (PixelRenderer::find_plume): their optical depth, 1 - the mean over the bands of their
    // transmittance, and the distances from the camera's centre to where that mean has fallen to
    // 0.5 and 0.1, 0 where it does not fall so far [m].
    Spectrum plume_optical_depth;
    double plume_opacity = 0, plume_range_50 = 0, plume_range_10 = 0;
    // The apparent motion of the plume at half of that opacity until the next frame [pixels]; NaN
    // without a plume.
    std::array<double, 2> plume_flow;
    // The position of the centre's point in other images (PointMatchers), relative to the pixel's
    // centre [pixels], and whether it is hidden there, as 0 or 1; NaN if there is no point or no
    // such image.
    std::array<double, 2> flow, flow_back;
    double flow_occluded = 0;
    /// Position in the image of the pair's first camera minus that in the other image.
    std::array<double, 2> disparity;
    double disparity_occluded = 0;

    /// Multiplies all light by a factor per band, for the light in a mirror image. That of the
    /// first slab, of which a mirror image has none, is set to 0.
    void dim(const Spectrum& factor);

    bool shows_lamp = false;  // whether any sample sees a lamp's surface
    /// Resets to an empty pixel, with 0 for each of `lamp_count` lamps. Storage is reused. Only the
    /// first `bands` are cleared, which must include all that were ever used: clearing all of them
    /// takes a tenth of the time of a simple image.
    void reset(std::size_t lamp_count, std::size_t bands = k_max_bands);
};

/// Returns the parts of in-scattered light that the layers of `plan` need.
InScatterParts in_scatter_parts(const LayerPlan& plan);

/// Writes a pixel into the channels of `plan`: colour, coverage and every layer. `channels` are
/// those of a film with the channel names of the plan.
void store_pixel(const PixelResult& pixel, const LayerPlan& plan, const BandColour& colour,
                 std::span<float> channels);

/// Merges further light paths into channels that store_pixel filled: means over paths become those
/// over all paths, of which those of `pixel` are the fraction `weight`. Everything else stays.
void merge_paths(const PixelResult& pixel, double weight, const LayerPlan& plan,
                 const BandColour& colour, std::span<float> channels);

/// Writes ground truth, which is that of the middle of an exposure: the layers that are not
/// is_of_exposure.
void store_truth(const PixelResult& pixel, const LayerPlan& plan, std::span<float> channels);

/// Writes the changes by forward scatter into channels that store_pixel filled, except those of the
/// lamps. `pixel` contains the light after forward scatter, except that `backscatter_first` is only
/// the light added.
void store_forward_scatter(const PixelResult& pixel, const LayerPlan& plan,
                           const BandColour& colour, std::span<float> channels);

/// Adds the contribution of forward scatter to the light of one lamp, which is `forward` and
/// `backscatter` of `pixel`.
void add_forward_scatter_of_lamp(const PixelResult& pixel, const LayerPlan& plan, std::size_t lamp,
                                 std::span<float> channels);

/// Copies the light of `bands` into `film` from an image of the same pixels by another camera,
/// whose rays are those of these bands' wavelength. The colour of each film is the contribution of
/// its own bands (BandColour::of), so that colours are added. Coverage, mattes and ground truth
/// stay.
void take_bands(const Film& from, std::span<const std::size_t> bands, const LayerPlan& plan,
                Film& film);

/// Adds the light of the mirror image that the same pixels see in the water's surface. Ground truth
/// stays that without the mirror image. Sums of layers stay exact to the bit.
void add_mirrored(const Film& mirrored, const LayerPlan& plan, const BandColour& colour,
                  Film& film);

/// Computes the image of an exposure as the mean over images of its parts. Light is averaged, and
/// sums of layers stay exact to the bit; the transmittance is the mean over the parts that show a
/// surface. Layers of the exposure's middle are not changed.
class ExposureMean {
  public:
    /// The fraction of a row's exposure that belongs to a part, 0 to 1; over all parts, it sums to
    /// 1.
    using RowFraction = std::function<double(int row)>;

    /// Whether the errors of an exposure's parts are independent, as those of path tracing, or may
    /// all be equal.
    enum class Errors { independent, alike };

    /// Accumulates in `mean`, whose values are 0. All references must outlive this object. Throws
    /// as require_memory.
    ExposureMean(const LayerPlan& plan, const BandColour& colour, Errors errors, Film& mean);

    /// Includes the image of a part. It has the same channels, and all rows of the window whose
    /// fraction is not 0.
    void add(const Film& part, const RowFraction& fraction);

    /// Completes the mean after the last part.
    void finish();

  private:
    void add_pixel(std::span<const float> part, float fraction, float fraction_so_far,
                   std::span<float> mean) const;
    void add_transmittance(std::span<const float> part, float fraction, std::span<float> mean,
                           float& on_surface) const;

    const LayerPlan& plan_;
    const BandColour& colour_;
    Errors errors_;
    Film& mean_;
    std::vector<std::size_t> channels_;  // indices of those that are means
    std::vector<float> fractions_;       // of each row of the window, summed over the parts so far
    Grid2D<float> on_surface_;           // fraction of the exposure that shows a surface
};

}  // namespace uw
