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

/// In-scatter of one slab of water along one ray.
struct SlabLight {
    bool visible = false;  // whether the ray enters the slab before it ends; all else 0 if not
    /// Due to each lamp, the mean of the light that the slab scatters towards the camera as far as
    /// the ray goes, E_s of the paper's equation 17 [W m^-3 sr^-1].
    std::vector<Spectrum> lamps;
    /// int e^-tau ds over the whole slab [m], in the paper's output weighted by distance like the
    /// radiance (SensorModel::surface_factor): the radiance at the camera per E_s.
    Spectrum weight;
    /// From the lamps to the middle of what the ray sees of the slab, and from there to the glass.
    WaterPath to_lamps, to_camera;
};

/// Splits the in-scatter along camera rays into slabs of water.
class InScatterSlabs {
  public:
    /// `faces`: camera z of the slab boundaries [m], ascending; or, if the slabs are `shells`,
    /// their distances along the water rays, for views too wide for planes. `sensor` determines how
    /// `integrate` weights light by distance. All references must outlive this object.
    InScatterSlabs(const LitScene& scene, const Integrator& integrator, const LampPaths& paths,
                   const Affine& world_from_camera, std::vector<double> faces, bool shells,
                   const SensorModel& sensor);

    /// Joins slabs in pairs before camera z `end`, or that distance, but not across the ends of
    /// `kept`.
    void join_pairs(double end, const Interval& kept);

    std::size_t count() const { return faces_.size() - 1; }
    /// Camera z, or distance, of face `i` and of the centre of slab `i` [m].
    double face(std::size_t i) const { return faces_[i]; }
    double middle(std::size_t i) const { return 0.5 * (faces_[i] + faces_[i + 1]); }
    /// Where a point of a ray lies among the faces.
    RayDepth depth(const Ray& ray) const {
        return shells_ ? RayDepth::from_origin() : RayDepth(camera_from_world_, ray);
    }

    /// Integrates slabs `first` to `last` - 1 along `ray` up to the distance `end` [m]. Thread
    /// safe.
    void integrate(const Ray& ray, double end, std::size_t first, std::size_t last,
                   std::vector<SlabLight>& slabs) const;

  private:
    // Fills in what depends on the water between `begin` and `end`, but for the lamps' light.
    void fill_slab(const Ray& ray, double begin, double end, double behind, WaterPath& path,
                   SlabLight& slab) const;
    // int e^-tau ds over `part`, which continues `path`.
    Spectrum weight(const WaterPath& path, const WaterPath& part) const;

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
