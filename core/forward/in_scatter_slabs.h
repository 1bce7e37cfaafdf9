#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/integrators/integrator.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/sensor.h"
#include "core/integrators/slabs.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// A path through the water: its length [m] and the columns along it [unit m].
struct WaterPath {
    double length = 0;
    std::vector<double> columns;  // one per constituent

    void reset(std::size_t constituents) {
        length = 0;
        columns.assign(constituents, 0.0);
    }
    /// Adds `weight` times another path.
    void add(double weight, double other_length, std::span<const double> other_columns) {
        length += weight * other_length;
        for (std::size_t k = 0; k < columns.size(); ++k) columns[k] += weight * other_columns[k];
    }
};

/// Columns from the lamps to points in the water, and their means over the lamps.
class LampPaths {
  public:
    /// `column` computes those from one lamp to a point; `scene` must outlive this object.
    using PointColumn =
        std::function<void(std::size_t lamp, const Point3& x, std::span<double> column)>;
    LampPaths(const LitScene& scene, PointColumn column)
        : scene_(scene), column_(std::move(column)) {}

    /// Adds `weight` times the mean of the paths from each lamp to `x`, whether or not the lamp
    /// illuminates it: the paper's mean distance.
    void add_mean(double weight, const Point3& x, WaterPath& path) const;

  private:
    LitScene scene_;
    PointColumn column_;
};

/// In-scatter of one slab of water in one pixel.
struct SlabLight {
    std::vector<Spectrum> lamps;  // radiance at the camera due to each lamp [W m^-2 sr^-1]
    /// int e^-tau ds over the part of the slab that the pixel sees [m], in the paper's output
    /// weighted by distance like the radiance (SensorModel::surface_factor). The radiance divided
    /// by this is the light that the slab scatters towards the camera, E_s of the paper's equation
    /// 17.
    Spectrum weight;
    /// From the lamps to the centroid of the light in the slab, and from there to the glass.
    WaterPath to_lamps, to_camera;
};

/// Splits the in-scatter along camera rays into slabs of water.
class InScatterSlabs {
  public:
    /// `faces`: camera z of the slab boundaries [m], ascending; or, if the slabs are `shells`,
    /// their distances along the water rays, for views too wide for planes. `sensor` determines how
    /// `integrator` weights light by distance. All references must outlive this object.
    InScatterSlabs(const LitScene& scene, const Integrator& integrator, const LampPaths& paths,
                   const Affine& world_from_camera, std::vector<double> faces, bool shells,
                   const SensorModel& sensor);

    std::size_t count() const { return faces_.size() - 1; }
    /// Camera z, or distance, of the centre of slab `i` [m].
    double middle(std::size_t i) const { return 0.5 * (faces_[i] + faces_[i + 1]); }
    const AttenuationTable& attenuation() const { return attenuation_; }

    /// Integrates slabs `first` to `last` - 1 along `ray`; the fraction `weights[i]` of its samples
    /// extends to `distances[i]` (PixelView). Thread safe.
    void integrate(const Ray& ray, std::span<const double> distances,
                   std::span<const double> weights, std::size_t first, std::size_t last,
                   std::vector<SlabLight>& slabs) const;

  private:
    struct Stretches;
    void split(const Ray& ray, std::span<const double> distances, std::span<const double> weights,
               std::size_t first, std::size_t last, Stretches& stretches) const;
    void fill_slabs(const Ray& ray, const Stretches& stretches,
                    std::vector<SlabLight>& slabs) const;
    // Adds `part`, which continues `path`, to the weight, multiplied by its `visible` fraction.
    void add_weight(const WaterPath& path, const WaterPath& part, double visible,
                    Spectrum& weight) const;
    // Adds the light of segment `i` and returns its sum over lamps and bands.
    static double add_light(const Stretches& stretches, std::size_t i,
                            std::vector<Spectrum>& lamps);

    LitScene scene_;
    const Integrator& integrator_;
    const LampPaths& paths_;
    Affine camera_from_world_;
    std::vector<double> faces_;
    bool shells_;
    AttenuationTable attenuation_;
    SensorModel sensor_;
};

}  // namespace uw
