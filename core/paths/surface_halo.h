#pragma once

#include <algorithm>
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

/// The halo of lit surfaces: their light that the water scatters by small angles on its way to the
/// camera, i.e. the surfaces as the camera sees them, blurred by the PointSpread (Wells 1973), all
/// over an image. It reaches a pixel if its scattering nearest to the camera is in front of the
/// pixel's own surface.
///
/// It is computed for cells of one or more pixels of the whole image, whatever part of it is
/// rendered. In small images, whose pixels vary more than that, cells are parts of pixels.
class SurfaceHalo {
  public:
    /// Sets the radiance at the camera of a sample, which has the index `index` in `light`, by
    /// channel.
    using Radiance = std::function<void(const SurfaceSample&, const SurfaceLight& light,
                                        std::size_t index, std::span<double> radiance)>;
    struct Position {
        double x, y;  // in the image [pixels]
    };

    /// Each of `channels` channels belongs to the band channel % band_count. `cells`: their maximum
    /// number. The references are used only during construction.
    SurfaceHalo(const RaySource& rays, const LitScene& scene, const SurfaceLighting& lighting,
                const DistanceIntervals& intervals, std::size_t channels, int cells,
                const Radiance& radiance, std::span<const Position> nodes);

    /// The number of intervals in which the halo is scattered.
    std::size_t interval_count() const { return intervals_; }
    /// The halo by interval of the scattering nearest to the camera and channel, at nodes[node].
    std::span<const float> of_node(std::size_t node) const {
        return std::span(node_light_)
            .subspan(node * intervals_ * channels_, intervals_ * channels_);
    }
    /// Whether the water changes with depth, so that the halo is that of the mean water.
    bool is_of_mean_water() const { return mean_water_.has_value(); }
    /// The fraction of the halo that a ray has whose water scatters `scattered` of uniform light
    /// towards the camera up to a distance, relative to what the mean water scatters:
    /// b (1 - e^(-c distance)) / c. 1 if the water is the same everywhere.
    double fraction(double scattered, double distance, std::size_t band) const {
        if (!mean_water_) return 1;
        const double c = mean_water_->attenuation[band];
        const double depth = c * distance;
        const double mean =
            mean_water_->scattering[band] * (depth > 1e-6 ? (1 - std::exp(-depth)) / c : distance);
        return mean > 0 ? std::min(1.0, scattered / mean) : 1;
    }
    /// Adds `weight` times the mean halo of the pixel around an image position [pixels] to
    /// `radiance`, by channel, for rays up to `distance` [m].
    void add(double x, double y, double distance, double weight, std::span<double> radiance) const;

  private:
    struct Corner {
        std::size_t cell;
        double weight;
    };

    Grid2D<float> trace(const RaySource& rays, const LitScene& scene,
                        const SurfaceLighting& lighting, const Radiance& radiance);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_cells_of_pixel(double x, double y, std::vector<Corner>& cells) const;

    struct MeanWater {
        Spectrum scattering, attenuation;  // [1/m]
    };

    std::optional<MeanWater> mean_water_;  // none: the water is the same everywhere
    std::size_t channels_ = 0, intervals_ = 0;
    int cells_of_pixel_ = 1;     // in each direction
    double spacing_ = 1;         // of the cells [pixels]
    Grid2D<float> cells_;        // the distance of the surface [m], infinity if there is none
    std::vector<float> source_;  // by channel and cell
    std::vector<float> light_;   // by cell and channel
    std::vector<float> node_light_;
};

}  // namespace uw
