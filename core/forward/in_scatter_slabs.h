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

/// A way through the water: its length [m] and the columns along it [unit m].
struct WaterPath {
    double length = 0;
    std::vector<double> columns;  // one per constituent

    void reset(std::size_t constituents) {
        length = 0;
        columns.assign(constituents, 0.0);
    }
    /// Adds `share` times another path.
    void add(double share, double other_length, std::span<const double> other_columns) {
        length += share * other_length;
        for (std::size_t k = 0; k < columns.size(); ++k) columns[k] += share * other_columns[k];
    }
};

/// Columns from a lamp to points of the water, and their means over the lamps.
class LampPaths {
  public:
    /// `column` fills those from one lamp to a point; `scene` outlives this.
    using PointColumn =
        std::function<void(std::size_t lamp, const Point3& x, std::span<double> column)>;
    LampPaths(const LitScene& scene, PointColumn column)
        : scene_(scene), column_(std::move(column)) {}

    /// Adds `share` times the mean over all lamps of the paths from the lamp to `x`, whether it
    /// is lit by them or not: the paper's mean distance.
    void add_mean(double share, const Point3& x, WaterPath& path) const;

  private:
    LitScene scene_;
    PointColumn column_;
};

/// In-scatter of one layer of water in one pixel.
struct SlabLight {
    std::vector<Spectrum> lamps;  // radiance at the camera by each lamp [W m^-2 sr^-1]
    /// int e^-tau ds over what the pixel sees of the layer [m], in the paper's output weighted by
    /// distance as the radiance is (SensorModel::surface_factor): the radiance over this is the
    /// light that the layer scatters to the camera, E_s of the paper's equation 17.
    Spectrum weight{};
    /// From the lamps to the middle of the light in the layer, and from there to the glass.
    WaterPath to_lamps, to_camera;
};

/// Splits the in-scatter of camera rays into layers of water.
class InScatterSlabs {
  public:
    /// `faces`: camera z of the layers' faces [m], ascending; or, where the layers are `shells`,
    /// their distances along the water rays, for views that planes do not reach around. Inside a
    /// layer, the middle of its light is found from `cells` parts of it. `sensor` says how
    /// `integrator` weights light by distance. All references outlive this.
    InScatterSlabs(const LitScene& scene, const Integrator& integrator, const LampPaths& paths,
                   const Affine& world_from_camera, std::vector<double> faces, bool shells,
                   int cells, const SensorModel& sensor);

    std::size_t count() const { return faces_.size() - 1; }
    /// Camera z, or distance, in the middle of layer `i` [m].
    double middle(std::size_t i) const { return 0.5 * (faces_[i] + faces_[i + 1]); }
    const AttenuationTable& attenuation() const { return attenuation_; }

    /// Layers `first` to `last` - 1 of the water along `ray`, of which `shares[i]` ends at
    /// `ends[i]` (PixelView). Thread safe.
    void gather(const Ray& ray, std::span<const double> ends, std::span<const double> shares,
                std::size_t first, std::size_t last, std::vector<SlabLight>& layers) const;

  private:
    struct Cells;
    void place_cells(const Ray& ray, std::span<const double> ends, std::span<const double> shares,
                     std::size_t first, std::size_t last, Cells& cells) const;
    void fill_layers(const Ray& ray, const Cells& cells, std::vector<SlabLight>& layers) const;
    // Adds `share` of the weight of `part`, which goes on where `path` ends.
    void add_weight(const WaterPath& path, const WaterPath& part, double share,
                    Spectrum& weight) const;
    // Adds the light of cell `i` and returns its sum over lamps and bands.
    static double add_light(const Cells& cells, std::size_t i, std::vector<Spectrum>& lamps);

    LitScene scene_;
    const Integrator& integrator_;
    const LampPaths& paths_;
    Affine camera_from_world_;
    std::vector<double> faces_;
    bool shells_;
    int cells_;
    AttenuationTable attenuation_;
    SensorModel sensor_;
};

}  // namespace uw
