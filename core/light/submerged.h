#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/spectrum.h"
#include "core/geometry/surfaces.h"
#include "core/geometry/textured_surfaces.h"
#include "core/geometry/water_surface.h"
#include "core/light/medium.h"

namespace uw {

/// The radiance of the sky in the air by the direction from which it comes (unit, upwards) and by
/// band [W m^-2 sr^-1].
using SkyRadiance = std::function<Spectrum(const Vector3& from)>;

/// The sky as seen from below the water.
struct SeenSky {
    SkyRadiance radiance;  // empty: it is black
    std::size_t lamp = 0;  // the scene's lamp that is its light, by index
};

/// The surfaces below a water surface, and that surface viewed from below, at which all rays from
/// the water end (SurfaceHit::is_water_surface). It emits the light of the sky that it transmits;
/// whoever hits it has to follow the reflection.
///
/// Lines that begin or end above the surface lead through the mirror image of the water
/// (WaterSurface): they are the paths of light that the surface reflects.
class SubmergedSurfaces final : public Surfaces, public TexturedSurfaces {
  public:
    SubmergedSurfaces(std::shared_ptr<const Surfaces> below, const WaterSurface& surface,
                      SeenSky sky);

    /// The lamp whose light the water's surface emits.
    std::size_t sky_lamp() const { return sky_.lamp; }

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override;
    SurfaceMaterial material(const SurfaceHit& hit) const override;
    std::optional<std::array<std::uint32_t, 3>> corners(const SurfaceHit& hit) const override {
        return hit.is_water_surface ? std::nullopt : below_->corners(hit);
    }
    bool may_emit() const override { return sky_.radiance || below_->may_emit(); }
    double hit_distance(const Ray& ray) const override;
    bool occluded(const Point3& from, const Point3& to) const override;
    void closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                      std::span<char> found) const override;
    void hit_distances(const Point3& origin, std::span<const Vector3> directions,
                       std::span<double> distances) const override;
    void occluded_many(const Point3& from, std::span<const Point3> to,
                       std::span<char> blocked) const override;
    void occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                       std::span<char> blocked) const override;
    const SurfaceNames& names() const override { return names_; }
    Bounds bounds() const override { return below_->bounds(); }
    std::uint64_t triangle_count() const override { return below_->triangle_count(); }
    bool empty() const override { return false; }
    bool has_textures() const override { return textures_ != nullptr; }
    bool is_textured(const SurfaceHit& hit) const override;
    void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const override;
    void add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                        TextureGradient& gradient) const override;

  private:
    // Replaces the hit that was found on the surfaces below if the water's surface is nearer.
    bool meet_water_surface(const Ray& ray, double s_end, bool found, SurfaceHit& hit) const;

    std::shared_ptr<const Surfaces> below_;
    const TexturedSurfaces* textures_;  // of `below_`; null: there are none
    WaterSurface surface_;
    SeenSky sky_;
    SurfaceNames names_;
};

/// The index of the lamp whose light a surface emits where it is hit: the sky, at the water's
/// surface; none for all other surfaces, which emit their own light. Precondition: it emits.
std::optional<std::size_t> lamp_of_emission(const Surfaces& surfaces, const SurfaceHit& hit);

/// Concentrations below a water surface, and their mirror image above it.
class SubmergedField final : public ConcentrationField {
  public:
    /// `with_image`: bounds and grids include the image. Without, only columns lead above the
    /// surface.
    SubmergedField(std::shared_ptr<const ConcentrationField> below, const WaterSurface& surface,
                   bool with_image);

    int constituent_count() const override { return below_->constituent_count(); }
    std::shared_ptr<const Strata> strata() const override { return below_->strata(); }
    const ConcentrationField& grids() const override;
    Bounds bounds() const override { return bounds_of(*below_); }
    double finest_voxel() const override { return below_->finest_voxel(); }
    void sample(const Point3& x, std::span<double> concentration) const override;
    void column(const Point3& a, const Point3& b, std::span<double> column) const override;
    void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    void coarse_profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    void profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                        ConcentrationProfile& profile) const override;

  private:
    Bounds bounds_of(const ConcentrationField& field) const;
    template <class Profile>
    void unfold(const Ray& ray, double s_end, ConcentrationProfile& profile,
                const Profile& below) const;

    std::shared_ptr<const ConcentrationField> below_;
    WaterSurface surface_;
    bool with_image_;
    std::unique_ptr<const SubmergedField> grids_;  // with the image; null: this field has no others
};

}  // namespace uw
