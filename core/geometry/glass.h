#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/glass_material.h"
#include "core/geometry/surfaces.h"
#include "core/geometry/textured_surfaces.h"
#include "core/geometry/water_surface.h"

namespace uw {

/// Which of a scene's objects and materials are of glass.
struct GlassTable {
    std::vector<GlassMaterial> materials;
    /// The numbers of their materials, from 1, by SurfaceHit::object_id and, where that has none,
    /// by SurfaceHit::material_id; 0: no glass. Ids beyond the end have none.
    std::vector<std::uint32_t> of_object, of_material;
    bool has_planes = false;  ///< some glass is unbounded
};

/// Surfaces of which some are of glass: these are hit like others (SurfaceHit::glass), but block no
/// light.
class GlassSurfaces final : public Surfaces, public TexturedSurfaces {
  public:
    /// `opaque` and `glass` have the same names and numbers of objects and materials.
    GlassSurfaces(std::unique_ptr<const Surfaces> opaque, std::unique_ptr<const Surfaces> glass,
                  GlassTable table);

    /// The surfaces that are not of glass, and those that are.
    const Surfaces& opaque() const { return *opaque_; }
    const Surfaces& glass() const { return *glass_; }
    const std::vector<GlassMaterial>& materials() const { return table_.materials; }
    bool has_planes() const { return table_.has_planes; }
    /// The number of the material at a hit of glass().
    std::uint32_t material_number(const SurfaceHit& hit) const;

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override;
    SurfaceMaterial material(const SurfaceHit& hit) const override;
    std::optional<std::array<std::uint32_t, 3>> corners(const SurfaceHit& hit) const override {
        return (hit.glass != 0 ? glass_ : opaque_)->corners(hit);
    }
    bool may_emit() const override { return opaque_->may_emit(); }
    double hit_distance(const Ray& ray) const override { return opaque_->hit_distance(ray); }
    bool occluded(const Point3& from, const Point3& to) const override {
        return opaque_->occluded(from, to);
    }
    void closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                      std::span<char> found) const override;
    void hit_distances(const Point3& origin, std::span<const Vector3> directions,
                       std::span<double> distances) const override {
        opaque_->hit_distances(origin, directions, distances);
    }
    void occluded_many(const Point3& from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        opaque_->occluded_many(from, to, blocked);
    }
    void occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        opaque_->occluded_many(from, to, blocked);
    }
    const SurfaceNames& names() const override { return opaque_->names(); }
    Bounds bounds() const override;
    std::uint64_t triangle_count() const override {
        return opaque_->triangle_count() + glass_->triangle_count();
    }
    bool empty() const override { return opaque_->empty() && glass_->empty(); }
    bool has_textures() const override { return textures_ != nullptr; }
    bool is_textured(const SurfaceHit& hit) const override;
    void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const override;
    void add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                        TextureGradient& gradient) const override;

  private:
    // Makes a hit of the glass what others see of it: black.
    void mark(SurfaceHit& hit) const;

    std::unique_ptr<const Surfaces> opaque_, glass_;
    const TexturedSurfaces* textures_;  // of `opaque_`; null: there are none
    GlassTable table_;
};

/// The solid glass around a point of a ray. Where several overlap, the object that comes last in
/// the scene takes the place of the others: nested dielectrics by priority (Schmidt and Budge
/// 2002). A ray that enters more of them than it can hold forgets the first.
class GlassAround {
  public:
    bool empty() const { return count_ == 0; }
    /// The number of the glass at the point; 0: water.
    std::uint32_t glass() const;
    /// The same on the other side of a surface of an object: it is entered, or left if the point
    /// lies in it.
    GlassAround across(std::uint32_t object, std::uint32_t glass) const;
    bool contains(std::uint32_t object, std::uint32_t glass) const;

  private:
    struct Object {
        std::uint32_t object = 0, glass = 0;
        friend bool operator==(const Object&, const Object&) = default;
    };
    std::array<Object, 6> objects_{};
    std::size_t count_ = 0;
};

/// A ray in a scene with glass, and what is around it.
struct GlassRay {
    Ray ray;
    GlassAround around;
};

/// Where a ray goes from a surface of glass.
struct GlassSplit {
    GlassRay reflected, transmitted;
    /// The fraction of its light that comes from each of them, by band; 0: nothing does.
    Spectrum reflectance{}, transmittance{};
    bool is_thin = false;  ///< a pane, whose other face `transmitted` has passed, too
};

/// Reflection, refraction and absorption of light at the glass of a scene, which is smooth: Snell's
/// law and Fresnel's equations for unpolarised light. World space.
///
/// Fractions are those of the basic radiance L / n^2, which refraction preserves.
class GlassOptics {
  public:
    /// `n_water`: the index of the water around. `water_surface`: that at which lines from above
    /// are unfolded (SubmergedSurfaces); null: there is none. Both are referred to.
    GlassOptics(std::shared_ptr<const Surfaces> surfaces, double n_water, std::size_t bands,
                const std::optional<WaterSurface>& water_surface);

    double n_water() const { return n_water_; }
    /// The bounds of all glass; empty if some of it is unbounded.
    Bounds bounds_of_all() const { return has_planes_ ? Bounds{} : bounds_; }
    const GlassSurfaces& surfaces() const { return *glass_; }
    /// Whether its absorption depends on the band.
    bool is_coloured() const { return is_coloured_; }
    /// The refractive index of what is around.
    double index(const GlassAround& around) const { return n_of(around.glass()); }

    /// The solid glass in which a point lies: its surfaces are crossed an odd number of times on
    /// the way out.
    GlassAround around(const Point3& x) const;

    /// What becomes of a ray at `hit`, its first, which is on glass.
    GlassSplit split(const GlassRay& ray, const SurfaceHit& hit) const;
    /// The factor on radiance from what is around by which it arrives in the water, refraction
    /// alone: (n_water/n)^2.
    double radiance_in_water(const GlassAround& around) const {
        const double ratio = n_water_ / index(around);
        return ratio * ratio;
    }
    /// The fraction of light that is left after this distance in what is around; 1 in water, whose
    /// attenuation is not its own.
    void absorb(const GlassAround& around, double distance, Spectrum& light) const;

    /// The fraction of light that gets from one point to the other in a straight line: exact
    /// through thin panes; through solid glass without refraction and without what is reflected
    /// inside. In each band, or in `band`.
    Spectrum transmittance(const Point3& from, const Point3& to) const;
    double transmittance(const Point3& from, const Point3& to, std::size_t band) const;

    /// Appends the distances along `ray` within `interval` at which light from `origin(x)` to the
    /// points of the ray begins or ceases to cross some surface of glass.
    template <class Origin>
    void append_edges(const Ray& ray, const Interval& interval, const Origin& origin,
                      std::vector<double>& s) const;

    friend bool operator==(const GlassOptics& a, const GlassOptics& b) {
        return a.surfaces_ == b.surfaces_ && a.n_water_ == b.n_water_;
    }

  private:
    double n_of(std::uint32_t glass) const {
        return glass == 0 ? n_water_ : glass_->materials()[glass - 1].n;
    }
    // Multiplies the bands from `first` up to `last` by what gets through below the surface.
    void dim(const Point3& from, const Point3& to, std::size_t first, std::size_t last,
             Spectrum& light) const;
    void dim_unfolded(const Point3& from, const Point3& to, std::size_t first, std::size_t last,
                      Spectrum& light) const;
    // The number of surfaces of glass that a line crosses.
    int crossings(const Point3& from, const Point3& to) const;
    // The two ends of the line below the surface, and the point where it is folded, if it is.
    struct Unfolded {
        Point3 from, to;
        std::optional<Point3> middle;
    };
    Unfolded unfolded(const Point3& from, const Point3& to) const;

    std::shared_ptr<const Surfaces> surfaces_;  // the owner of the next
    const GlassSurfaces* glass_;
    double n_water_;
    std::size_t bands_;
    std::optional<WaterSurface> water_surface_;
    Bounds bounds_;  // of all glass but planes, which are thin
    bool is_coloured_ = false, has_solid_ = false, has_planes_ = false;
};

template <class Origin>
void GlassOptics::append_edges(const Ray& ray, const Interval& interval, const Origin& origin,
                               std::vector<double>& s) const {
    // A shadow narrower than a step may be missed; its edges are found to a thousandth of a step.
    constexpr int k_steps = 8, k_halvings = 10;
    const auto crossed = [&](double at) {
        const Point3 x = ray.at(at);
        return crossings(origin(x), x);
    };
    double before = interval.begin;
    int known = crossed(before);
    for (int i = 1; i <= k_steps; ++i) {
        const double at = interval.begin + interval.length() * i / k_steps;
        const int here = crossed(at);
        if (here != known) {
            double low = before, high = at;
            for (int k = 0; k < k_halvings; ++k) {
                const double middle = 0.5 * (low + high);
                (crossed(middle) == known ? low : high) = middle;
            }
            s.push_back(0.5 * (low + high));
        }
        before = at;
        known = here;
    }
}

}  // namespace uw
