#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/passes/pixel_layers.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/multiple_nodes.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/surface_glow.h"

namespace uw {

/// IntervalWeights all over a window of an image: found on rays of a lattice that depends on the
/// whole image alone, linear in between. One set of weights serves uniform water.
class WeightLattice {
  public:
    WeightLattice() = default;
    /// Reads its arguments only here.
    WeightLattice(const RaySource& rays, const IntervalWeights& weights, const PixelWindow& window);

    /// At an image position [pixels] in the window: [interval * bands + band]. Thread safe.
    void find(double x, double y, std::vector<float>& weights) const;

  private:
    int spacing_ = 1, column_ = 0, row_ = 0;  // [pixels]; the first ray's place
    std::vector<float> uniform_;
    Grid2D<std::vector<float>> rays_;  // empty: uniform everywhere
};

/// The radiance of surfaces that SurfaceGlow blurs: by direct light and emission, which are exact,
/// and roughly by the light that has been scattered or reflected before: as much as in proportion
/// to the direct light and, beside it, from an even ambient light explains most of it.
class GlowSource {
  public:
    /// Estimates the rough part for each group and band. Both references must outlive this object.
    GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator);

    /// The radiance at the camera of `sample`, number `index` of `light`, by group and band. Thread
    /// safe.
    void find_radiance(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                       std::span<double> radiance) const;

  private:
    struct Indirect {
        double per_direct = 0;
        double ambient = 0;  // what a white surface would reflect [W m^-2 sr^-1]
    };

    void find_indirect();
    void add_direct(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                    std::span<double> radiance) const;

    const PixelRenderer& pixels_;
    const MultipleNodes& estimator_;
    std::size_t bands_;
    std::vector<Indirect> indirect_;  // by group and band
};

/// How much is spent on the light that was scattered or reflected more than once.
struct MultipleLightOptions {
    int paths = 0;       // in the whole image, of each kind, at its nodes, at most
    double error = 0;    // standard error for which fewer will do, relative to the image's mean
    int nodes = 0;       // about as many
    int cells = 0;       // of the surfaces' glow, at most
    bool lamps = false;  // each lamp's light by itself
};

/// Light that was scattered or reflected more than once, for the fast integrator: estimated by
/// light paths at the nodes of a lattice over the image (MultipleNodes), smoothed between them
/// (LatticeFit), and interpolated: the water's by image position and distance, that on surfaces by
/// position among nodes that see the same surface. The reflectance and the water in front of the
/// surface are the pixel's own. Of the water's light, the surfaces' glow (SurfaceGlow) is as sharp
/// as they are: it is computed for all pixels, and what light paths find beside it is smoothed.
///
/// Nodes, their random numbers and the number of their paths depend on the whole image, so that
/// crops hold the same pixels, and a still camera does not flicker.
class MultipleLight {
  public:
    /// Receives the share that is done, on any thread; returns false to stop.
    using Progress = std::function<bool(double share)>;

    /// `pixels` must outlive this object; its transport has paths.
    MultipleLight(const PixelRenderer& pixels, const MultipleLightOptions& options);

    /// Estimates the light of the pixels of `window`. Throws Interrupted if `progress` returned
    /// false, InputError if the nodes do not fit into free memory.
    void prepare(const PixelWindow& window, const Progress& progress);

    /// Adds a pixel's light to multiple_volume, multiple_surface and the lamps of `result`. The
    /// samples of `view` begin at `first_sample` of `light`. Thread safe.
    void add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
             PixelResult& result) const;

    /// The standard error of this light: the RMS over the nodes over the mean of all light.
    double error() const { return error_; }

  private:
    struct Corner {
        const SmoothNode* node;
        double weight;
    };

    void limit_paths(double error);
    void take_away_glow(Grid2D<MultipleNode>& raw);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_matches(double x, double y, const SurfaceHit& hit,
                      std::vector<Corner>& matches) const;
    void find_matches(double x, double y, const SurfaceHit& hit, double least_cosine,
                      std::vector<Corner>& matches) const;
    void add_water(const PixelView& view, std::span<double> light) const;
    void add_volume(const PixelView& view, PixelResult& result) const;
    void add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                     PixelResult& result) const;
    void give(std::size_t group, std::size_t band, double radiance, PixelResult& result) const;

    const PixelRenderer& pixels_;
    std::size_t bands_;
    int spacing_ = 1;           // of the nodes [pixels]
    int column_ = 0, row_ = 0;  // of the first node of nodes_
    DistanceIntervals intervals_;
    IntervalWeights weights_;
    MultipleNodes estimator_;
    WeightLattice weight_lattice_;  // from prepare on, as the following
    Grid2D<SmoothNode> nodes_;
    int cells_ = 0;
    std::optional<SurfaceGlow> glow_;
    double error_ = 0;
};

}  // namespace uw
