#include "core/geometry/glass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/refraction.h"

namespace uw {

namespace {

// Lines end at this many surfaces of glass: what gets through more of them is next to nothing.
constexpr int k_max_crossings = 64;

// How far rays begin from the surface that they leave, relative to the coordinates: a few times the
// rounding of single precision.
constexpr double k_offset = 2e-7;

Point3 beside(const SurfaceHit& hit, const Vector3& normal) {
    const double scale = std::max({std::abs(hit.position.x), std::abs(hit.position.y),
                                   std::abs(hit.position.z), hit.distance});
    return hit.position + (k_offset * scale) * normal;
}

/// The fractions of light that a pane reflects and transmits.
struct PaneFractions {
    double reflectance = 1, transmittance = 0;
};

// The sum over all reflections between the two faces, which do not interfere, of light that one
// face reflects by `r`, while `left` of it remains of each crossing (Born and Wolf, section 7.6).
PaneFractions pane(double r, double left) {
    const double lost = 1 - r * r * left * left;
    if (!(lost > 0)) return {};  // nothing gets in
    return {r + r * (1 - r) * (1 - r) * left * left / lost, (1 - r) * (1 - r) * left / lost};
}

PaneFractions pane_in(double n_around, const GlassMaterial& glass, double cosine,
                      std::size_t band) {
    const FresnelTransmittance face = fresnel_transmittance(cosine, n_around, glass.n);
    double left = 1;
    if (const double depth = glass.absorption[band] * glass.thickness; depth > 0) {
        const double sine = n_around / glass.n * std::sqrt(std::max(0.0, 1 - cosine * cosine));
        if (!(sine < 1)) return {};
        left = std::exp(-depth / std::sqrt(1 - sine * sine));
    }
    const PaneFractions s = pane(1 - face.s, left), p = pane(1 - face.p, left);
    return {0.5 * (s.reflectance + p.reflectance), 0.5 * (s.transmittance + p.transmittance)};
}

}  // namespace

GlassSurfaces::GlassSurfaces(std::unique_ptr<const Surfaces> opaque,
                             std::unique_ptr<const Surfaces> glass, GlassTable table)
    : opaque_(std::move(opaque)),
      glass_(std::move(glass)),
      textures_(textures_of(*opaque_)),
      table_(std::move(table)) {}

std::uint32_t GlassSurfaces::material_number(const SurfaceHit& hit) const {
    const auto number = [](const std::vector<std::uint32_t>& numbers, std::uint32_t id) {
        return id < numbers.size() ? numbers[id] : 0;
    };
    const std::uint32_t own = number(table_.of_object, hit.object_id);
    return own != 0 ? own : number(table_.of_material, hit.material_id);
}

void GlassSurfaces::mark(SurfaceHit& hit) const {
    hit.glass = material_number(hit);
    hit.reflectance = {};
    hit.has_material = false;
    hit.is_water_surface = false;
}

bool GlassSurfaces::closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const {
    const bool found = opaque_->closest_hit(ray, s_end, hit);
    hit.glass = 0;  // hits are reused
    SurfaceHit of_glass;
    if (!glass_->closest_hit(ray, found ? hit.distance : s_end, of_glass)) return found;
    hit = of_glass;
    mark(hit);
    return true;
}

void GlassSurfaces::closest_hits(std::span<const Ray> rays, double s_end,
                                 std::span<SurfaceHit> hits, std::span<char> found) const {
    std::vector<SurfaceHit> of_glass(rays.size());
    std::vector<char> found_glass(rays.size());
    opaque_->closest_hits(rays, s_end, hits, found);
    glass_->closest_hits(rays, s_end, of_glass, found_glass);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i].glass = 0;
        if (found_glass[i] == 0 || (found[i] != 0 && hits[i].distance <= of_glass[i].distance))
            continue;
        hits[i] = of_glass[i];
        mark(hits[i]);
        found[i] = 1;
    }
}

SurfaceMaterial GlassSurfaces::material(const SurfaceHit& hit) const {
    return hit.glass != 0 ? SurfaceMaterial{} : opaque_->material(hit);
}

Bounds GlassSurfaces::bounds() const {
    Bounds bounds = opaque_->bounds();
    bounds.extend(glass_->bounds());
    return bounds;
}

bool GlassSurfaces::is_textured(const SurfaceHit& hit) const {
    return textures_ != nullptr && hit.glass == 0 && textures_->is_textured(hit);
}

void GlassSurfaces::filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const {
    if (textures_ != nullptr && hit.glass == 0) textures_->filter_textures(spread, hit);
}

void GlassSurfaces::add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                                   TextureGradient& gradient) const {
    if (textures_ != nullptr && hit.glass == 0)
        textures_->add_to_texture(hit, by_reflectance, gradient);
}

std::uint32_t GlassAround::glass() const {
    const Object* last = nullptr;
    for (std::size_t i = 0; i < count_; ++i)
        if (last == nullptr ||
            std::pair(objects_[i].object, objects_[i].glass) > std::pair(last->object, last->glass))
            last = &objects_[i];
    return last == nullptr ? 0 : last->glass;
}

bool GlassAround::contains(std::uint32_t object, std::uint32_t glass) const {
    return std::ranges::find(std::span(objects_).first(count_), Object{object, glass}) !=
           std::span(objects_).first(count_).end();
}

GlassAround GlassAround::across(std::uint32_t object, std::uint32_t glass) const {
    GlassAround other = *this;
    const auto begin = other.objects_.begin(), end = begin + static_cast<std::ptrdiff_t>(count_);
    const auto own = std::find(begin, end, Object{object, glass});
    if (own != end) {
        std::move(own + 1, end, own);
        --other.count_;
        return other;
    }
    if (other.count_ == objects_.size()) {
        std::move(begin + 1, end, begin);
        --other.count_;
    }
    other.objects_[other.count_++] = {object, glass};
    return other;
}

GlassOptics::GlassOptics(std::shared_ptr<const Surfaces> surfaces, double n_water,
                         std::size_t bands, const std::optional<WaterSurface>& water_surface)
    : surfaces_(std::move(surfaces)),
      glass_(&dynamic_cast<const GlassSurfaces&>(*surfaces_)),
      n_water_(n_water),
      bands_(bands),
      water_surface_(water_surface),
      bounds_(glass_->glass().bounds()),
      has_planes_(glass_->has_planes()) {
    for (const GlassMaterial& material : glass_->materials()) {
        has_solid_ = has_solid_ || !material.is_thin;
        const auto absorption = material.absorption.first(bands_);
        if (!material.is_thin || material.thickness > 0)
            is_coloured_ = is_coloured_ || std::ranges::any_of(absorption, [&](double value) {
                               return value != absorption.front();
                           });
    }
}

GlassAround GlassOptics::around(const Point3& x) const {
    GlassAround around;
    if (!has_solid_) return around;
    for (int axis = 0; axis < 3; ++axis)
        if (!(x[axis] >= bounds_.min[axis] && x[axis] <= bounds_.max[axis])) return around;
    // Along no axis and no diagonal, where edges of meshes lie.
    Ray ray{x, glm::normalize(Vector3(0.3771, 0.8129, 0.4437))};
    const double out = 2 * bounds_.diagonal();
    SurfaceHit hit;
    for (int i = 0; i < k_max_crossings && glass_->glass().closest_hit(ray, out, hit); ++i) {
        const std::uint32_t glass = glass_->material_number(hit);
        if (!glass_->materials()[glass - 1].is_thin) around = around.across(hit.object_id, glass);
        ray.origin = beside(hit, -hit.geometric_normal);
    }
    return around;
}

GlassSplit GlassOptics::split(const GlassRay& ray, const SurfaceHit& hit) const {
    const Vector3& direction = ray.ray.direction;
    const Vector3& flat = hit.geometric_normal;
    // A shading normal may face away from the ray.
    const Vector3 normal = glm::dot(hit.normal, direction) < 0 ? hit.normal : flat;
    const double cosine = std::min(1.0, -glm::dot(normal, direction));
    GlassSplit split;
    Vector3 mirrored = direction + 2 * cosine * normal;
    if (!(glm::dot(mirrored, flat) > 0))
        mirrored = direction - 2 * glm::dot(direction, flat) * flat;
    split.reflected = {{beside(hit, flat), glm::normalize(mirrored)}, ray.around};
    split.transmitted = {{beside(hit, -flat), direction}, ray.around};
    const GlassMaterial& material = glass_->materials()[hit.glass - 1];
    const double n_before = index(ray.around);
    split.is_thin = material.is_thin;
    if (material.is_thin) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const PaneFractions fractions = pane_in(n_before, material, cosine, b);
            split.reflectance[b] = fractions.reflectance;
            split.transmittance[b] = fractions.transmittance;
        }
        return split;
    }
    split.transmitted.around = ray.around.across(hit.object_id, hit.glass);
    double transmittance = 1;
    if (split.transmitted.around.glass() != ray.around.glass()) {
        const double n_behind = index(split.transmitted.around);
        const std::optional<Vector3> refracted = refract(direction, -normal, n_before, n_behind);
        transmittance = refracted ? fresnel_transmittance(cosine, n_before, n_behind).mean() : 0;
        // A bent shading normal must not turn it back.
        if (refracted && glm::dot(*refracted, flat) < 0)
            split.transmitted.ray.direction = *refracted;
    }
    for (std::size_t b = 0; b < bands_; ++b) {
        split.reflectance[b] = 1 - transmittance;
        split.transmittance[b] = transmittance;
    }
    return split;
}

void GlassOptics::absorb(const GlassAround& around, double distance, Spectrum& light) const {
    const std::uint32_t glass = around.glass();
    if (glass == 0) return;
    const Spectrum& absorption = glass_->materials()[glass - 1].absorption;
    for (std::size_t b = 0; b < bands_; ++b)
        if (absorption[b] > 0) light[b] *= std::exp(-absorption[b] * distance);
}

void GlassOptics::dim(const Point3& from, const Point3& to, std::size_t first, std::size_t last,
                      Spectrum& light) const {
    const Vector3 way = to - from;
    const double length = glm::length(way);
    if (!(length > 0)) return;
    Ray ray{from, way / length};
    GlassAround around;
    bool is_begun = false;
    double rest = length;
    SurfaceHit hit;
    for (int i = 0; i < k_max_crossings; ++i) {
        const bool found = glass_->glass().closest_hit(ray, rest, hit);
        if (found && !is_begun) around = this->around(from);
        is_begun = is_begun || found;
        if (!found && !is_begun && !has_solid_) return;
        if (!found && !is_begun) around = this->around(from);  // a line that lies in glass
        const double distance = found ? hit.distance : rest;
        if (const std::uint32_t glass = around.glass(); glass != 0)
            for (std::size_t b = first; b < last; ++b)
                light[b] *= std::exp(-glass_->materials()[glass - 1].absorption[b] * distance);
        if (!found) return;
        const std::uint32_t glass = glass_->material_number(hit);
        const GlassMaterial& material = glass_->materials()[glass - 1];
        const double cosine = std::min(1.0, std::abs(glm::dot(hit.normal, ray.direction)));
        if (material.is_thin) {
            for (std::size_t b = first; b < last; ++b)
                light[b] *= pane_in(index(around), material, cosine, b).transmittance;
        } else {
            const GlassAround behind = around.across(hit.object_id, glass);
            // The line's angle counts as that outside the object.
            const bool enters = !around.contains(hit.object_id, glass);
            const double n_outside = index(enters ? around : behind);
            const double n_inside = index(enters ? behind : around);
            const double passed = fresnel_transmittance(cosine, n_outside, n_inside).mean();
            for (std::size_t b = first; b < last; ++b) light[b] *= passed;
            around = behind;
        }
        ray.origin = beside(hit, -hit.geometric_normal);
        rest = glm::dot(to - ray.origin, ray.direction);
        if (!(rest > 0)) return;
    }
}

GlassOptics::Unfolded GlassOptics::unfolded(const Point3& from, const Point3& to) const {
    if (!water_surface_) return {from, to, {}};
    // The light of suns begins in the surface itself.
    const double rounding = 1e-9 * distance(from, to);
    const bool from_above = water_surface_->height(from) > rounding;
    const bool to_above = water_surface_->height(to) > rounding;
    Unfolded line{from_above ? water_surface_->mirrored(from) : from,
                  to_above ? water_surface_->mirrored(to) : to,
                  {}};
    if (from_above != to_above) line.middle = water_surface_->between(from, to);
    return line;
}

void GlassOptics::dim_unfolded(const Point3& from, const Point3& to, std::size_t first,
                               std::size_t last, Spectrum& light) const {
    const Unfolded line = unfolded(from, to);
    dim(line.from, line.middle.value_or(line.to), first, last, light);
    if (line.middle) dim(*line.middle, line.to, first, last, light);
}

Spectrum GlassOptics::transmittance(const Point3& from, const Point3& to) const {
    Spectrum light = per_band(bands_, [](std::size_t) { return 1.0; });
    dim_unfolded(from, to, 0, bands_, light);
    return light;
}

double GlassOptics::transmittance(const Point3& from, const Point3& to, std::size_t band) const {
    Spectrum light;
    light[band] = 1;
    dim_unfolded(from, to, band, band + 1, light);
    return light[band];
}

int GlassOptics::crossings(const Point3& from, const Point3& to) const {
    const Unfolded line = unfolded(from, to);
    int number = 0;
    const auto count = [&](const Point3& begin, const Point3& end) {
        const double length = distance(begin, end);
        if (!(length > 0)) return;
        const Vector3 direction = (end - begin) / length;
        double at = 0;
        for (int i = 0; i < k_max_crossings; ++i) {
            const double next =
                at + glass_->glass().hit_distance({begin + at * direction, direction});
            if (!(next < length)) return;
            ++number;
            at = next + 10 * k_offset * length;
        }
    };
    count(line.from, line.middle.value_or(line.to));
    if (line.middle) count(*line.middle, line.to);
    return number;
}

}  // namespace uw
