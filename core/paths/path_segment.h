#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/light/half_tangent_density.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"

namespace uw {

/// In place of a lamp's index: light emitted by surfaces.
inline constexpr std::size_t k_no_lamp = std::numeric_limits<std::size_t>::max();

/// In place of an emitter's: the light is not that of a lamp, or of one that is seen itself.
inline constexpr std::size_t k_no_emitter = std::numeric_limits<std::size_t>::max();
/// In place of the number of a vertex: there is none before, or nobody keeps them.
inline constexpr int k_no_vertex = -1;

/// Where a light path begins or changes its direction, seen from the camera.
struct PathVertex {
    enum class Kind : std::uint8_t { camera, scattered, reflected, mirrored };

    Kind kind = Kind::camera;  // mirrored: by the water's surface
    Point3 position;
    const SurfaceHit* hit = nullptr;  // of a reflection
};

/// The light that one light path, or one bundle of them, brings to the camera.
struct PathContribution {
    std::size_t lamp = k_no_lamp;  // where it comes from, by index
    int scatterings = 0;           // in the water, on the way
    int reflections = 0;           // by surfaces
    bool from_water = false;       // it was last scattered by the water, not reflected or emitted
    double distance = 0;           // from the ray's origin to where that happened [m]
    /// Estimate of the radiance, one value per band of the scene [W m^-2 sr^-1].
    std::span<const double> radiance;

    // Its path, for those who were told of its vertices (ContributionSink::add_vertex):
    int vertex = k_no_vertex;            // the last before `place`
    Point3 place{};                      // of its last event: scattered, reflected or emitted
    const SurfaceHit* hit = nullptr;     // there; null in the water
    std::size_t emitter = k_no_emitter;  // which of LitScene::emitters lights it
    // What light that was scattered once was computed with, by constituent: the columns of its
    // whole way [unit m], and the concentrations at `place` [unit]. If empty, they are the field's.
    std::span<const double> columns{}, concentration{};
    bool is_met = false;  // light of an emissive volume, which lies on the path's way at `place`
};

/// Receives the contributions of paths one by one. Their sum is an unbiased estimate.
class ContributionSink {
  public:
    virtual ~ContributionSink() = default;
    virtual void add(const PathContribution& contribution) = 0;
    /// Is told of each vertex of a path, after the one with the number `before` and ahead of the
    /// contributions that come by way of it. Returns its number. Most sinks need not know.
    virtual int add_vertex(int /*before*/, const PathVertex& /*vertex*/) { return k_no_vertex; }
};

/// What the paths of one pixel may bring: rough means over the bands [W m^-2 sr^-1], to which the
/// splitting factor of a path relates what the path itself is expected to bring.
struct ExpectedLight {
    double pixel = 0;       // the pixel's radiance, without single scattering
    double ambient = 0;     // what a path may meet anywhere
    double of_surface = 0;  // the part of `pixel` that comes straight from the surface
    bool is_known = true;   // false: they stand for nothing but each other
};

/// All of a path from the camera that its next step depends on, beside the water ahead of it
/// (PathSegment): each step makes a new one of the last.
struct PathState {
    Ray ray;                 // of the path's current segment, away from the camera
    Spectrum throughput;     // radiance at the camera per radiance that arrives along the segment
    ExpectedLight expected;  // of the pixel, with what the path has found on its way
    int scatterings = 0, reflections = 0;
    bool from_water = false;      // its first vertex, seen from the camera, is a scattering
    bool was_scattered = false;   // its last vertex is a scattering
    bool meets_emission = true;   // of volumes, on its segments and around its surfaces
    bool stays_in_water = false;  // surfaces end it, and it leaves out what they emit and reflect
    double distance = 0;          // of the first vertex, along the camera ray [m]
    double splitting = 1;         // the product of its splitting factors
    int vertex = k_no_vertex;     // the last
    /// The surface by which it was reflected last.
    struct LeftSurface {
        Point3 position;
        Vector3 normal{0, 0, 1};
        double radiance = 0;  // that it is expected to reflect, mean over the bands
    } left;

    /// A contribution of light that arrives along the segment.
    PathContribution contribution(std::size_t lamp, std::span<const double> radiance) const {
        return {.lamp = lamp,
                .scatterings = scatterings,
                .reflections = reflections,
                .from_water = from_water,
                .distance = distance,
                .radiance = radiance,
                .vertex = vertex};
    }
};

/// A straight part of a light path through the water, from a point to the first surface. Reused
/// storage.
struct WaterSegment {
    Ray ray;
    double length = 0;  // [m]; k_far without a surface
    bool has_hit = false;
    SurfaceHit hit;                // at its end
    ConcentrationProfile profile;  // without knots where all of the water is uniform
    bool has_field = false;        // without a profile, the field is asked at every point
};

/// The state of the water at one point of a segment. Reused storage.
struct WaterPoint {
    double distance = 0;                // along the segment [m]
    std::vector<double> concentration;  // of the constituents
    std::vector<double> column;         // up to here [unit m]
    // WaterOptics::find_scattering: b_m [1/m], either `mixed` or the uniform water's.
    std::span<const Spectrum> scattering{};
    std::vector<Spectrum> mixed{};
};

/// What WaterSegments need to know of a scene. Thread safe.
class WaterOptics {
  public:
    /// Profiles are as fine as the field's own if `exact`; coarse ones are faster, and right on
    /// average.
    WaterOptics(const LitScene& scene, bool exact);

    const LitScene& scene() const { return scene_; }
    const AttenuationTable& attenuation() const { return attenuation_; }
    std::size_t bands() const { return bands_; }
    /// That in which the uniform water attenuates least.
    std::size_t clearest_band() const { return clearest_band_; }
    std::size_t constituents() const { return attenuation_.constituents.size(); }

    /// Finds the end of the segment that begins with `ray`, and the concentrations along it.
    void trace(const Ray& ray, WaterSegment& segment) const;
    /// The same as trace for a segment whose end is known: `hit`, or none if null.
    void set(const Ray& ray, const SurfaceHit* hit, WaterSegment& segment) const;

    /// Concentrations and columns at `distance`, without the scattering.
    void look_up(const WaterSegment& segment, double distance, WaterPoint& point) const;
    /// The scattering coefficients at a point.
    void find_scattering(WaterPoint& point) const;
    /// c in every band at a point [1/m].
    void attenuations(const WaterPoint& point, std::span<double> c) const;

    /// e^-tau of every band for a path of `length` [m] with these columns. Bands are computed four
    /// at a time: past the last, values up to a multiple of four are overwritten, too.
    void transmittances(double length, std::span<const double> columns, Spectrum& values) const;
    /// The sum over the bands of a, b and e^(-c length) of the uniform water.
    double attenuated_sum(const Spectrum& a, const Spectrum& b, double length) const;
    /// The distance at which the optical depth in `band` is `depth`; the segment's length if it is
    /// less everywhere.
    double distance_at_depth(const WaterSegment& segment, std::size_t band, double depth) const;

  private:
    double depth_at_knot(const WaterSegment& segment, std::size_t band, std::size_t knot) const;

    LitScene scene_;
    AttenuationTable attenuation_;
    bool exact_;
    std::size_t bands_, clearest_band_ = 0;
    Bounds bounds_;  // of the field
};

/// Numbers of light paths by what they look for: light that no surface has met, light of surfaces
/// that the water scatters on its way to the camera, and indirect light on the camera ray's own
/// surface.
struct PathCounts {
    double water = 1, lit = 1, surface = 1;
};

}  // namespace uw
