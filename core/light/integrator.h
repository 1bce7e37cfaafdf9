#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/light/lamp.h"
#include "core/light/medium.h"

namespace uw {

struct LampSurface;
struct SceneEmission;
class GlassOptics;
class WaterSurface;

/// Everything that integrators operate on; all of it must outlive them.
struct LitScene {
    const Medium* medium = nullptr;
    const ConcentrationField* field = nullptr;
    const Surfaces* surfaces = nullptr;
    /// The points that emit light, in the order of the scene's lamps: one for each lamp, or several
    /// for a lamp with an extent (Lamp::index).
    const std::vector<Lamp>* emitters = nullptr;
    /// The luminous surfaces of lamps with an extent; null if there are none.
    const std::vector<LampSurface>* lamp_surfaces = nullptr;
    /// The volumes that emit light; null if there are none.
    const std::vector<SceneEmission>* emissions = nullptr;

    /// The water's surface, at which light is reflected; null: the water is infinite.
    const WaterSurface* water_surface = nullptr;

    /// What light does at the surfaces of glass; null: there are none.
    const GlassOptics* glass = nullptr;

    /// How many lamps the scene has.
    std::size_t lamp_count() const { return emitters->empty() ? 0 : emitters->back().index() + 1; }
};

/// Visibility and column concentrations along the light paths of one emitter, precomputed by
/// splatting so that integrators need not trace shadow rays. Thread safe.
class DeepShadow {
  public:
    virtual ~DeepShadow() = default;

    /// The parts of the interval `interval` of `ray` that the lamp illuminates, ascending and
    /// disjoint. Precondition: the interval lies within the lamp's beam (Lamp::beam); elsewhere the
    /// map is empty.
    virtual void lit_intervals(const Ray& ray, const Interval& interval,
                               std::vector<Interval>& lit) const = 0;

    /// Appends distances along `ray` inside `interval` between which the lamp's columns are nearly
    /// linear; nothing where its light has crossed no grid.
    virtual void append_column_breaks(const Ray& ray, const Interval& interval,
                                      std::vector<double>& s) const = 0;

    /// Column concentrations from the lamp to each point, [i * constituent_count + k], [unit m].
    virtual void columns(std::span<const Point3> x, std::span<double> column) const = 0;

    /// The memory that it takes [bytes].
    virtual std::size_t bytes() const = 0;
};

/// In-scattered radiance [W m^-2 sr^-1] up to each of several distances along one ray, by lamp.
class InScatter {
  public:
    /// Resets to zero for the given numbers of distances and lamps.
    void reset(std::size_t distances, std::size_t lamps) {
        lamps_ = lamps;
        values_.assign(distances * lamps, Spectrum{});
    }
    std::size_t lamp_count() const { return lamps_; }
    /// In-scatter up to the distance with index `distance`, due to the lamp with index `lamp`.
    Spectrum& at(std::size_t distance, std::size_t lamp) {
        return values_[distance * lamps_ + lamp];
    }
    const Spectrum& at(std::size_t distance, std::size_t lamp) const {
        return values_[distance * lamps_ + lamp];
    }

  private:
    std::size_t lamps_ = 0;
    std::vector<Spectrum> values_;
};

/// Single scattering along camera rays (physics section 5). Thread safe.
class Integrator {
  public:
    virtual ~Integrator() = default;

    /// The radiance that the water between the ray's origin and each of `distances` scatters
    /// towards the origin, for each lamp. `distances` [m] ascend; the last may be k_far, for a ray
    /// that hits nothing.
    virtual void in_scatter(const Ray& ray, std::span<const double> distances,
                            InScatter& result) const = 0;

    /// The same for the water between `begin` [m] and each of `distances`, all of which lie beyond
    /// `begin`. The default takes the difference of in_scatter at the two ends; integrators that
    /// can skip the water before `begin` override it.
    virtual void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                                 InScatter& result) const;
};

/// Denotes "no surface": no lamp's light returns from beyond this distance [m].
inline constexpr double k_far = 1e4;

}  // namespace uw
