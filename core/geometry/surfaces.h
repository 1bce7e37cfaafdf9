#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"

namespace uw {

/// The name of an object or material of a scene's surfaces.
struct SurfaceName {
    std::string name;                  // as in the file; not unique
    std::optional<std::size_t> entry;  // of `geometry`, from 0; none: of the water's surface
};

/// The names of the numbers in the layers `id` and `material`: the first has number 1.
struct SurfaceNames {
    std::vector<SurfaceName> objects, materials;
};

/// Material properties beyond diffuse reflection (SurfaceHit::reflectance).
struct SurfaceMaterial {
    Spectrum emission{};     // emitted radiance, the same in all directions [W m^-2 sr^-1]
    bool is_glossy = false;  // has a specular lobe as well (core/geometry/surface_reflection.h)
    double roughness = 1;    // perceptual, 0..1
    Spectrum f0{};           // reflectance at normal incidence, in water
};

/// The footprint of a hit: the parallelogram around it that is spanned by two tangents of the
/// surface, in world space [m]. Both zero: the hit is a point.
struct SurfaceSpread {
    Vector3 across{0.0}, down{0.0};
};

/// Where a ray hits a surface. World space.
struct SurfaceHit {
    double distance = 0;  // along the ray [m]
    Point3 position;
    Vector3 normal{0, 0, 1};            // shading normal, unit, on the side the ray comes from
    Vector3 geometric_normal{0, 0, 1};  // of the true surface, unit, same side
    Spectrum reflectance{};             // diffuse reflectance rho per band, 0..1
    std::uint32_t object_id = 0;        // in Surfaces::names, from 1
    std::uint32_t material_id = 0;      // likewise; 0: none of a file's
    bool has_material = false;          // more than diffuse reflection: see Surfaces::material
    bool is_water_surface = false;      // viewed from below (core/light/submerged.h)
    /// The number of its glass in GlassSurfaces, from 1; 0: it is not of glass.
    std::uint32_t glass = 0;
    // For Surfaces::material and corners: the triangle and the position on it.
    std::uint32_t geometry = 0, triangle = 0;
    double u = 0, v = 0;
    SurfaceSpread spread{};  // over which its textures were taken
};

/// Whether a ray goes on from a hit in directions that follow from its own: at the water's surface
/// and at glass, which reflect and emit no light of their own as matt surfaces do.
inline bool is_specular(const SurfaceHit& hit) {
    return hit.is_water_surface || hit.glass != 0;
}

/// The surfaces of a scene, which stop camera rays and cast shadows. Those of glass (GlassSurfaces)
/// are hit, but cast none. Thread safe.
class Surfaces {
  public:
    virtual ~Surfaces() = default;

    /// The nearest surface along `ray` within (0, s_end]; false if there is none.
    virtual bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const = 0;

    /// Material properties beyond diffuse reflection at a hit; none unless
    /// SurfaceHit::has_material, and none by default.
    virtual SurfaceMaterial material(const SurfaceHit& /*hit*/) const { return {}; }

    /// The vertices of the triangle of a hit, by their numbers in its mesh (TriangleMesh); none for
    /// other shapes, for instances, and by default.
    virtual std::optional<std::array<std::uint32_t, 3>> corners(const SurfaceHit& /*hit*/) const {
        return std::nullopt;
    }

    /// Whether any surface may emit light; true where that is not known.
    virtual bool may_emit() const { return true; }

    /// Distance to the nearest opaque surface from the ray's origin, infinity if there is none.
    /// Cheaper than closest_hit: no shading.
    virtual double hit_distance(const Ray& ray) const = 0;

    /// Whether an opaque surface lies between `from` and `to`. Surfaces on which either point lies
    /// (within 1e-5 of the distance) are ignored.
    virtual bool occluded(const Point3& from, const Point3& to) const = 0;

    /// The three queries above for many rays at once, with bit-identical results (except for
    /// triangles as small as 1000 times the float rounding of their coordinates, where rounding may
    /// differ). Faster if consecutive groups of 8 rays are coherent; slower if they are not. All
    /// spans of a call have the same length.
    ///
    /// `found[i]` is closest_hit(rays[i], s_end, hits[i]), as 0 or 1.
    virtual void closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                              std::span<char> found) const;
    /// `distances[i]` is hit_distance({origin, directions[i]}); unit directions.
    virtual void hit_distances(const Point3& origin, std::span<const Vector3> directions,
                               std::span<double> distances) const;
    /// `blocked[i]` is occluded(from, to[i]), as 0 or 1.
    virtual void occluded_many(const Point3& from, std::span<const Point3> to,
                               std::span<char> blocked) const;
    /// `blocked[i]` is occluded(from[i], to[i]), as 0 or 1.
    virtual void occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                               std::span<char> blocked) const;

    /// The names behind SurfaceHit's ids; none by default.
    virtual const SurfaceNames& names() const;

    /// World bounds of all finite surfaces, a little loose around instances; empty if there are
    /// none.
    virtual Bounds bounds() const = 0;
    /// Counts the triangles of instances once per instance.
    virtual std::uint64_t triangle_count() const = 0;
    virtual bool empty() const = 0;
};

/// A surface point hit by a camera ray.
struct SurfaceSample {
    Ray ray;
    SurfaceHit hit;
    double x = 0, y = 0;  // image position of the ray [pixels]
};

}  // namespace uw
