#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/surface_lighting.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/point_spread.h"

namespace uw {

/// Light of surfaces that the water scatters by small angles on its way to the camera
/// (PointSpread), all over an image: the surfaces as the camera sees them, blurred. Light is taken
/// to reach a pixel if it is scattered last before the pixel's own surface.
///
/// Computed for cells of one or some pixels of the whole image, whatever part of it is rendered;
/// those of small images, whose pixels show more than one cell tells, are parts of pixels.
class SurfaceHalo {
  public:
    /// Sets the radiance at the camera of a sample, which is number `index` of `light`, by channel.
    using Radiance = std::function<void(const SurfaceSample&, const SurfaceLight& light,
                                        std::size_t index, std::span<double> radiance)>;
    struct Position {
        double x, y;  // in the image [pixels]
    };

    /// For `channels` channels, each of a band: channel % band_count. `cells`: at most. Reads the
    /// references only here.
    SurfaceHalo(const RaySource& rays, const LitScene& scene, const SurfaceLighting& lighting,
                const DistanceIntervals& intervals, std::size_t channels, int cells,
                const Radiance& radiance, std::span<const Position> nodes);

    /// The number of intervals in which there is such light.
    std::size_t interval_count() const { return intervals_; }
    /// The light that is scattered last in each of them, by interval and channel, at the position
    /// of number `node`.
    std::span<const float> of_node(std::size_t node) const {
        return std::span(node_light_)
            .subspan(node * intervals_ * channels_, intervals_ * channels_);
    }
    /// Whether the water changes with depth, and the light is that of water as it is in the mean.
    bool is_of_mean_water() const { return mean_water_.has_value(); }
    /// How much even light, of radiance 1, the mean water scatters towards the camera up to a
    /// distance. Precondition: is_of_mean_water().
    double scattered_by_mean_water(double distance, std::size_t band) const {
        const double c = mean_water_->attenuation[band];
        const double depth = c * distance;
        return mean_water_->scattering[band] *
               (depth > 1e-6 ? (1 - std::exp(-depth)) / c : distance);
    }
    /// Adds the mean light of the pixel around an image position [pixels], along its rays up to
    /// `distance`, times `weight`, to `radiance`, by channel.
    void add(double x, double y, double distance, double weight, std::span<double> radiance) const;

  private:
    struct Cell {
        float distance = 0;  // of the surface [m], infinity if there is none
        float place = 0;     // among the distances of PointSpread
        float scale = 0;     // place of its angle among the angles
    };
    class Spreading;
    struct Corner {
        std::size_t cell;
        double weight;
    };

    void trace(const RaySource& rays, const LitScene& scene, const SurfaceLighting& lighting,
               const Radiance& radiance);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_cells_of_pixel(double x, double y, std::vector<Corner>& cells) const;

    struct MeanWater {
        Spectrum scattering, attenuation;  // [1/m]
    };

    std::optional<MeanWater> mean_water_;  // none: it is the same everywhere
    std::size_t channels_ = 0, intervals_ = 0;
    int cells_of_pixel_ = 1;  // in each direction
    double spacing_ = 1;      // of the cells [pixels]
    Grid2D<Cell> cells_;
    std::vector<double> angles_;  // of cells [rad], ascending
    std::vector<float> source_;   // by channel and cell
    std::vector<float> light_;    // by cell and channel
    std::vector<float> node_light_;
};

}  // namespace uw
