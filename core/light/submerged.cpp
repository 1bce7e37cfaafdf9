#include "core/light/submerged.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/light/integrator.h"

namespace uw {

namespace {

// Points above the surface by less than rounding, relative to their line's length, count as lying
// in it, as the light of the sky begins there.
constexpr double k_rounding = 1e-9;

bool is_above(const WaterSurface& surface, const Point3& x, const Point3& other) {
    const double height = surface.height(x);
    return height > 0 && height > k_rounding * distance(x, other);
}

}  // namespace

SubmergedSurfaces::SubmergedSurfaces(std::shared_ptr<const Surfaces> below,
                                     const WaterSurface& surface, SeenSky sky)
    : below_(std::move(below)),
      textures_(textures_of(*below_)),
      surface_(surface),
      sky_(std::move(sky)),
      names_(below_->names()) {
    names_.objects.push_back({"water surface", {}});
}

// Stores in `u` and `v` of the hit the direction from which its light comes in the air, in the
// plane of calm water, which Surfaces::material needs.
bool SubmergedSurfaces::meet_water_surface(const Ray& ray, double s_end, bool found,
                                           SurfaceHit& hit) const {
    const std::optional<WaterSurface::Meeting> meeting =
        surface_.meet(ray, found ? hit.distance : s_end);
    if (!meeting) {
        hit.is_water_surface = false;  // hits are reused
        return found;
    }
    hit = {};
    hit.distance = meeting->distance;
    hit.position = ray.at(meeting->distance);
    hit.normal = hit.geometric_normal = -meeting->normal;
    hit.object_id = static_cast<std::uint32_t>(names_.objects.size());
    hit.is_water_surface = true;
    if (!sky_.radiance) return true;
    const std::optional<Vector3> out = surface_.into_air(ray.direction, meeting->normal);
    // Steep waves may refract light from below the horizon.
    hit.has_material = out && glm::dot(*out, surface_.up()) > 0;
    if (!hit.has_material) return true;
    hit.u = glm::dot(*out, surface_.across());
    hit.v = glm::dot(*out, surface_.along());
    return true;
}

bool SubmergedSurfaces::closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const {
    return meet_water_surface(ray, s_end, below_->closest_hit(ray, s_end, hit), hit);
}

void SubmergedSurfaces::closest_hits(std::span<const Ray> rays, double s_end,
                                     std::span<SurfaceHit> hits, std::span<char> found) const {
    below_->closest_hits(rays, s_end, hits, found);
    for (std::size_t i = 0; i < rays.size(); ++i)
        found[i] = meet_water_surface(rays[i], s_end, found[i] != 0, hits[i]) ? 1 : 0;
}

// Radiance grows with the square of the index, as refraction compresses the light into a narrower
// cone.
SurfaceMaterial SubmergedSurfaces::material(const SurfaceHit& hit) const {
    if (!hit.is_water_surface) return below_->material(hit);
    SurfaceMaterial material;
    if (!hit.has_material) return material;
    const double rise = std::sqrt(std::max(0.0, 1 - hit.u * hit.u - hit.v * hit.v));
    const Vector3 towards =
        hit.u * surface_.across() + hit.v * surface_.along() + rise * surface_.up();
    material.emission = sky_.radiance(towards);
    const double cosine = -glm::dot(towards, hit.geometric_normal);
    material.emission *= (1 - surface_.reflectance_from_air(cosine)) * surface_.n() * surface_.n();
    return material;
}

std::optional<std::size_t> lamp_of_emission(const Surfaces& surfaces, const SurfaceHit& hit) {
    if (!hit.is_water_surface) return std::nullopt;
    return dynamic_cast<const SubmergedSurfaces&>(surfaces).sky_lamp();
}

double SubmergedSurfaces::hit_distance(const Ray& ray) const {
    if (!(surface_.height(ray.origin) > 0)) {
        const double distance = below_->hit_distance(ray);
        const auto meeting = surface_.meet(ray, std::min(distance, k_far));
        return meeting ? meeting->distance : distance;
    }
    const Ray image = surface_.mirrored(ray);
    const double distance = below_->hit_distance(image);
    const std::optional<double> crossing = surface_.crossing(image);
    if (!crossing || distance <= *crossing) return distance;
    return *crossing + below_->hit_distance({ray.at(*crossing), ray.direction});
}

void SubmergedSurfaces::hit_distances(const Point3& origin, std::span<const Vector3> directions,
                                      std::span<double> distances) const {
    if (surface_.height(origin) > 0) {
        Surfaces::hit_distances(origin, directions, distances);
        return;
    }
    below_->hit_distances(origin, directions, distances);
    for (std::size_t i = 0; i < directions.size(); ++i)
        if (const auto meeting =
                surface_.meet({origin, directions[i]}, std::min(distances[i], k_far)))
            distances[i] = meeting->distance;
}

bool SubmergedSurfaces::occluded(const Point3& from, const Point3& to) const {
    const bool from_above = is_above(surface_, from, to), to_above = is_above(surface_, to, from);
    if (!from_above && !to_above) return below_->occluded(from, to);
    const Point3 start = from_above ? surface_.mirrored(from) : from;
    const Point3 end = to_above ? surface_.mirrored(to) : to;
    if (from_above == to_above) return below_->occluded(start, end);
    const Point3 middle = surface_.between(from, to);
    return below_->occluded(start, middle) || below_->occluded(middle, end);
}

void SubmergedSurfaces::occluded_many(const Point3& from, std::span<const Point3> to,
                                      std::span<char> blocked) const {
    if (to.empty() || surface_.height(from) > 0)
        Surfaces::occluded_many(from, to, blocked);
    else
        below_->occluded_many(from, to, blocked);
}

void SubmergedSurfaces::occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                                      std::span<char> blocked) const {
    const bool any_above = std::ranges::any_of(
        from, [&](const Point3& origin) { return surface_.height(origin) > 0; });
    if (any_above)
        Surfaces::occluded_many(from, to, blocked);
    else
        below_->occluded_many(from, to, blocked);
}

bool SubmergedSurfaces::is_textured(const SurfaceHit& hit) const {
    return !hit.is_water_surface && textures_->is_textured(hit);
}

void SubmergedSurfaces::filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const {
    if (!hit.is_water_surface) textures_->filter_textures(spread, hit);
}

void SubmergedSurfaces::add_to_texture(const SurfaceHit& hit,
                                       std::span<const double> by_reflectance,
                                       TextureGradient& gradient) const {
    if (!hit.is_water_surface) textures_->add_to_texture(hit, by_reflectance, gradient);
}

SubmergedField::SubmergedField(std::shared_ptr<const ConcentrationField> below,
                               const WaterSurface& surface, bool with_image)
    : below_(std::move(below)), surface_(surface), with_image_(with_image) {
    const ConcentrationField& grids = below_->grids();
    if (with_image && &grids != below_.get())
        grids_ = std::make_unique<const SubmergedField>(
            std::shared_ptr<const ConcentrationField>(below_, &grids), surface, true);
}

const ConcentrationField& SubmergedField::grids() const {
    if (!with_image_) return below_->grids();
    return grids_ ? *grids_ : *this;
}

Bounds SubmergedField::bounds_of(const ConcentrationField& field) const {
    Bounds bounds = field.bounds();
    if (!with_image_ || bounds.empty()) return bounds;
    const Bounds below = bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.extend(surface_.mirrored(Point3{(corner & 1 ? below.max : below.min).x,
                                               (corner & 2 ? below.max : below.min).y,
                                               (corner & 4 ? below.max : below.min).z}));
    return bounds;
}

void SubmergedField::sample(const Point3& x, std::span<double> concentration) const {
    below_->sample(surface_.height(x) > 0 ? surface_.mirrored(x) : x, concentration);
}

void SubmergedField::column(const Point3& a, const Point3& b, std::span<double> column) const {
    const bool a_above = is_above(surface_, a, b), b_above = is_above(surface_, b, a);
    if (a_above == b_above) {
        below_->column(a_above ? surface_.mirrored(a) : a, b_above ? surface_.mirrored(b) : b,
                       column);
        return;
    }
    const Point3 middle = surface_.between(a, b);
    below_->column(a_above ? surface_.mirrored(a) : a, middle, column);
    std::vector<double> rest(column.size());
    below_->column(middle, b_above ? surface_.mirrored(b) : b, rest);
    for (std::size_t k = 0; k < column.size(); ++k) column[k] += rest[k];
}

template <class Profile>
void SubmergedField::unfold(const Ray& ray, double s_end, ConcentrationProfile& profile,
                            const Profile& below) const {
    if (!(surface_.height(ray.origin) > 0)) {
        below(ray, s_end, profile);
        return;
    }
    const Ray image = surface_.mirrored(ray);
    const std::optional<double> crossing = surface_.crossing(image);
    if (!crossing || !(*crossing < s_end)) {
        below(image, s_end, profile);
        return;
    }
    below(image, *crossing, profile);
    ConcentrationProfile rest;
    below({ray.at(*crossing), ray.direction}, s_end - *crossing, rest);
    // Both have a knot at the surface, with the same concentrations.
    const auto count = static_cast<std::ptrdiff_t>(profile.constituent_count);
    for (std::size_t i = 1; i < rest.s.size(); ++i) profile.s.push_back(*crossing + rest.s[i]);
    profile.concentration.insert(profile.concentration.end(), rest.concentration.begin() + count,
                                 rest.concentration.end());
    const std::vector<double> at_surface(profile.column.end() - count, profile.column.end());
    for (std::size_t i = static_cast<std::size_t>(count); i < rest.column.size(); ++i)
        profile.column.push_back(at_surface[i % at_surface.size()] + rest.column[i]);
}

void SubmergedField::profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
    unfold(ray, s_end, profile, [&](const Ray& part, double end, ConcentrationProfile& result) {
        below_->profile(part, end, result);
    });
}

void SubmergedField::coarse_profile(const Ray& ray, double s_end,
                                    ConcentrationProfile& profile) const {
    unfold(ray, s_end, profile, [&](const Ray& part, double end, ConcentrationProfile& result) {
        below_->coarse_profile(part, end, result);
    });
}

void SubmergedField::profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                                    ConcentrationProfile& profile) const {
    unfold(ray, s_end, profile, [&](const Ray& part, double end, ConcentrationProfile& result) {
        below_->profile_within(tolerance, part, end, result);
    });
}

}  // namespace uw
