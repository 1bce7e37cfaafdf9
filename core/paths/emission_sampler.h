#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/light/emission.h"
#include "core/light/integrator.h"
#include "core/paths/path_segment.h"

namespace uw {

/// Finds the light of emissive volumes that light paths meet on their segments, without points that
/// stand for them: line integration (Simon et al. 2017, "Line integration for rendering
/// heterogeneous emissive volumes"). Along a segment the path estimates
///
///     int emission e^-tau ds,
///
/// and a direction towards the light is sampled by a point of it: with the density p_V of points
/// [1/m^3], that of directions is int p_V r^2 dr. Each volume is described by cells of its mean
/// emission, which decide on the variance alone. Thread safe.
class EmissionSampler {
  public:
    /// Takes the volumes whose emitters are met by paths (Lamp::is_met_by_paths). What `scene`
    /// refers to must outlive this object.
    explicit EmissionSampler(const LitScene& scene);

    bool empty() const { return volumes_.empty(); }

    /// A volume as a sphere, for guiding: where its light is, the mean square distance of that from
    /// its centre [m^2], and the fraction of it that leaves the volume's bounds without an event.
    struct Sphere {
        Point3 centre;
        double square = 0, escaping = 0;
    };
    /// That of the lamp with this index. Precondition: it is a volume that paths meet.
    const Sphere& sphere(std::size_t lamp) const { return spheres_[lamp]; }

    /// A direction from `x` to a point of the light, by three random numbers in [0, 1).
    /// Precondition: not empty.
    Vector3 sample(const Point3& x, double u, double v, double w) const;
    /// The radiance that arrives along a ray without an event on the way, a rough mean over the
    /// bands [W m^-2 sr^-1], and the density of `sample` in its direction [1/sr].
    struct Towards {
        double radiance = 0, pdf = 0;
    };
    Towards towards(const Ray& ray) const;
    /// The mean over all directions of the radiance that arrives at `x` without an event on the
    /// way, for guiding: that around the centre of a coarse cell of the particles' bounds, 0
    /// elsewhere.
    double mean(const Point3& x) const;

    /// Memory in which `estimate` works.
    struct Scratch {
        struct Piece {
            double begin = 0, length = 0, mass = 0;
        };
        std::vector<Piece> pieces;
        WaterPoint point;
    };
    /// Estimates the light of the volumes that arrives along a segment of a path. Uses one random
    /// number per volume.
    void estimate(const WaterOptics& optics, const WaterSegment& segment, const PathState& state,
                  PathRandom& random, ContributionSink& sink, Scratch& scratch) const;

  private:
    struct Cell {
        float emission = 0;     // mean over the cell and the bands [W/(sr m^3)]
        float attenuation = 0;  // of the water and its particles, mean over the bands [1/m]
    };
    struct Volume {
        std::size_t lamp = 0;
        std::shared_ptr<const EmissiveVolume> light;
        Bounds bounds;
        Vector3 edge;  // of a cell [m]
        std::array<int, 3> count{};
        std::vector<Cell> cells;         // x fastest
        std::vector<std::size_t> lit;    // those with light
        std::vector<double> cumulative;  // of their emission
        double power = 0;                // int emission dV, mean over the bands [W/sr]
        double uniform_attenuation = 0;  // outside, of the clearest band [1/m]

        /// The point of cell `n` at `place` in the unit cube.
        Point3 at(std::size_t n, const Vector3& place) const;
        /// The lit cell at which the running sum of the emission exceeds `target`, an index into
        /// `lit`.
        std::size_t lit_at(double target) const;
    };

    static Volume make_volume(const LitScene& scene, const SceneEmission& emission);
    static void fill_cells(const LitScene& scene, Volume& volume);
    static void add_faint_edge(Volume& volume);
    static double escaping_fraction(const Volume& volume);
    void fill_means(const LitScene& scene);
    static Sphere sphere_of(const Volume& volume);
    double weight(const Volume& volume, const Point3& x) const;

    std::vector<Volume> volumes_;
    std::vector<Sphere> spheres_;  // by lamp
    Bounds means_bounds_;
    std::vector<float> means_;  // in a lattice over these bounds, x fastest
};

}  // namespace uw
