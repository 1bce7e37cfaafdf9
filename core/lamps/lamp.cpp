#include "core/lamps/lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/affine.h"

namespace uw {

namespace {

double smoothstep(double x) {
    return x * x * (3.0 - 2.0 * x);
}

// 2 pi int smoothstep sin(theta) over the edge of a spot, from full (inner) to dark (outer).
double edge_solid_angle(double inner, double outer) {
    constexpr int k_steps = 256;  // Simpson on a cubic times a sine: exact to 1e-9
    const double h = (outer - inner) / k_steps;
    double sum = 0;
    for (int i = 0; i <= k_steps; ++i) {
        const double simpson = (i == 0 || i == k_steps) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum +=
            simpson * smoothstep(1.0 - static_cast<double>(i) / k_steps) * std::sin(inner + i * h);
    }
    return 2.0 * std::numbers::pi * sum * h / 3.0;
}

// Appends where `ray` crosses the cone of half-angle acos(cos_angle) about `axis` at `apex`.
void append_cone_crossings(const Ray& ray, const Point3& apex, const Vector3& axis,
                           double cos_angle, std::vector<double>& s) {
    const Vector3 o = ray.origin - apex;
    const double da = glm::dot(ray.direction, axis);
    const double oa = glm::dot(o, axis);
    const double cos2 = cos_angle * cos_angle;
    // (x.a)^2 = cos^2 |x|^2 with x = o + s d: a quadratic in s.
    const double a = da * da - cos2;
    const double half_b = da * oa - cos2 * glm::dot(o, ray.direction);
    const double c = oa * oa - cos2 * glm::dot(o, o);
    const auto append = [&](double root) {
        // The quadratic describes both halves of the double cone; keep the lamp's own.
        const double along_axis = oa + root * da;
        if (std::isfinite(root) && root > 0 && along_axis * cos_angle >= 0) s.push_back(root);
    };
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0) return;
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    if (a != 0) append(q / a);
    if (q != 0) append(c / q);
}

void append_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& normal,
                           std::vector<double>& s) {
    const double root = -glm::dot(ray.origin - apex, normal) / glm::dot(ray.direction, normal);
    if (std::isfinite(root) && root > 0) s.push_back(root);
}

// Appends where `ray` crosses the half of the plane across `normal` at `apex` that lies on the side
// of `side`.
void append_half_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& side,
                                const Vector3& normal, std::vector<double>& s) {
    const double root = -glm::dot(ray.origin - apex, normal) / glm::dot(ray.direction, normal);
    if (std::isfinite(root) && root > 0 && glm::dot(ray.at(root) - apex, side) >= 0)
        s.push_back(root);
}

// Appends where the angle to `axis`, seen from `apex`, is least or greatest: the azimuth changes
// fastest there, and a profile with a tip on its axis bends.
void append_nearest_to_axis(const Ray& ray, const Point3& apex, const Vector3& axis,
                            std::vector<double>& s) {
    const Vector3 o = ray.origin - apex;
    const double da = glm::dot(ray.direction, axis), oa = glm::dot(o, axis);
    const double od = glm::dot(o, ray.direction);
    // d/ds (x.a / |x|) = 0 with x = o + s d: linear in s.
    const double root = (da * glm::dot(o, o) - oa * od) / (oa - da * od);
    if (std::isfinite(root) && root > 0) s.push_back(root);
}

}  // namespace

DirectionCone DirectionCone::widened(double angle) const {
    const double wide = std::acos(std::max(-1.0, cosine)) + angle;
    return {axis, wide < std::numbers::pi ? std::cos(wide) : -1.0};
}

bool DirectionCone::includes(const DirectionCone& other) const {
    if (has_all() || other.has_all()) return has_all();
    const double apart =
        std::atan2(glm::length(glm::cross(axis, other.axis)), glm::dot(axis, other.axis));
    return apart + std::acos(other.cosine) <= std::acos(cosine) + 1e-12;
}

Lamp::Lamp(const LampDesc& desc, const Affine& world_from_camera, int band_count,
           std::shared_ptr<const PhotometricWeb> web)
    : name_(desc.name), profile_(desc.profile), web_(std::move(web)) {
    const Affine& world_from_frame =
        desc.fixed_to_camera ? world_from_camera : desc.world_from_mount;
    position_ = world_from_frame * desc.position;
    axis_ = glm::normalize(world_from_frame.apply_to_vector(desc.direction));
    switch (profile_.type) {
        case LampProfileDesc::Type::isotropic:
            break;
        case LampProfileDesc::Type::spot:
            place_spot();
            break;
        case LampProfileDesc::Type::cosine:
            place_cosine();
            break;
        case LampProfileDesc::Type::ies:
            if (!web_) throw std::logic_error("an IES lamp without its photometry");
            place_web(world_from_frame, desc.direction);
            break;
    }
    const double per_watt = desc.power ? 1.0 / beam_solid_angle() : 1.0;
    const PerBand& values = desc.power ? *desc.power : *desc.intensity;
    for (int band = 0; band < band_count; ++band) {
        const auto i = static_cast<std::size_t>(band);
        axis_intensity_[i] = per_watt * values[i];
    }
}

void Lamp::place_spot() {
    full_angle_ = glm::radians(std::max(0.0, 0.5 * (profile_.beam - profile_.edge)));
    dark_angle_ = glm::radians(std::min(180.0, 0.5 * (profile_.beam + profile_.edge)));
    cos_full_ = std::cos(full_angle_);
    cos_dark_ = std::cos(dark_angle_);
    cones_.push_back(cos_full_);
    // Within the edge as well: a ray that grazes the beam sees a narrow bump of it.
    if (cos_dark_ != cos_full_)
        for (const double part : {0.25, 0.5, 0.75, 1.0})
            cones_.push_back(std::cos(full_angle_ + part * (dark_angle_ - full_angle_)));
}

void Lamp::place_cosine() {
    exponent_ = std::log(0.5) / std::log(std::cos(glm::radians(0.5 * profile_.fwhm)));
    // A cosine beam is smooth but may be narrow: cones of equal intensity follow it.
    for (const double level : {0.95, 0.75, 0.5, 0.25, 0.1, 0.03, 0.003, 1e-4})
        cones_.push_back(std::pow(level, 1 / exponent_));
    breaks_at_equator_ = true;
}

void Lamp::place_web(const Affine& world_from_frame, const Vector3& direction) {
    // Azimuth 0 lies towards the frame's x, seen along the lamp's direction, then 90 degrees
    // anticlockwise of it seen from behind the lamp as LM-63 has it: zenith, the other end of the
    // axis, is z of a right-handed system.
    const Vector3 x(1, 0, 0), y(0, 1, 0);
    const Vector3& reference = glm::length(glm::cross(direction, x)) > 1e-6 ? x : y;
    const Vector3 towards = glm::normalize(reference - glm::dot(reference, direction) * direction);
    const Vector3 across = glm::cross(-direction, towards);
    const double turn = glm::radians(profile_.rotate), tilt = glm::radians(profile_.tilt);
    const Vector3 turned = std::cos(turn) * towards + std::sin(turn) * across;
    axis_ = glm::normalize(
        world_from_frame.apply_to_vector(std::cos(tilt) * direction + std::sin(tilt) * turned));
    zero_ = glm::normalize(
        world_from_frame.apply_to_vector(std::cos(tilt) * turned - std::sin(tilt) * direction));
    quarter_ = glm::cross(-axis_, zero_);
    constexpr double k_flat = 1e-6;  // a cone this near to 90 degrees is a plane
    cos_dark_ = std::cos(web_->dark_angle());
    if (std::abs(cos_dark_) < k_flat) cos_dark_ = -1e-3;
    for (const double azimuth : web_->azimuth_breaks())
        half_planes_.push_back(std::cos(azimuth) * zero_ + std::sin(azimuth) * quarter_);
    for (const double angle : web_->polar_breaks()) {
        const double cosine = std::cos(angle);
        if (std::abs(cosine) < k_flat)
            breaks_at_equator_ = true;
        else if (std::abs(cosine) < 1)
            cones_.push_back(cosine);
    }
}

double Lamp::beam_solid_angle() const {
    if (profile_.type == LampProfileDesc::Type::isotropic) return 4.0 * std::numbers::pi;
    if (profile_.type == LampProfileDesc::Type::cosine)
        return 2.0 * std::numbers::pi / (exponent_ + 1.0);
    if (web_) return web_->flux() / web_->peak();
    const double full = 2.0 * std::numbers::pi * (1.0 - cos_full_);
    if (profile_.falloff == LampProfileDesc::Falloff::gltf)  // a square of the cosine's way
        return full + 2.0 * std::numbers::pi * (cos_full_ - cos_dark_) / 3.0;
    return full + edge_solid_angle(full_angle_, dark_angle_);
}

double Lamp::relative_intensity(const Vector3& v) const {
    if (profile_.type == LampProfileDesc::Type::isotropic) return 1.0;
    if (profile_.type == LampProfileDesc::Type::ies) return web_intensity(v);
    const double cosine = glm::dot(v, axis_) / glm::length(v);
    if (profile_.type == LampProfileDesc::Type::cosine)
        return cosine <= 0 ? 0.0 : std::pow(cosine, exponent_);
    if (cosine >= cos_full_) return 1.0;
    if (cosine <= cos_dark_) return 0.0;
    if (profile_.falloff == LampProfileDesc::Falloff::gltf) {
        const double way = (cosine - cos_dark_) / (cos_full_ - cos_dark_);
        return way * way;
    }
    const double angle = std::acos(glm::clamp(cosine, -1.0, 1.0));
    return smoothstep((dark_angle_ - angle) / (dark_angle_ - full_angle_));
}

double Lamp::web_intensity(const Vector3& v) const {
    const double x = glm::dot(v, zero_), y = glm::dot(v, quarter_), along = glm::dot(v, axis_);
    const double polar = std::atan2(std::sqrt(x * x + y * y), along);
    const double azimuth = web_->is_rotational() ? 0.0 : std::atan2(y, x);
    return web_->candelas(polar, azimuth) / web_->peak();
}

Interval Lamp::beam(const Ray& ray, const Interval& stretch) const {
    const Interval none{stretch.begin, stretch.begin};
    const bool has_beam = profile_.type == LampProfileDesc::Type::spot || (web_ && cos_dark_ > -1);
    if (!(stretch.length() > 0) || !has_beam) return stretch;
    thread_local std::vector<double> cuts;
    cuts.clear();
    append_cone_crossings(ray, position_, axis_, cos_dark_, cuts);
    std::erase_if(cuts, [&](double s) { return s <= stretch.begin || s >= stretch.end; });
    cuts.push_back(stretch.begin);
    cuts.push_back(stretch.end);
    std::sort(cuts.begin(), cuts.end());
    // No more than the cone is crossed between two cuts: all of it is inside, or none.
    Interval lit = none;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const Vector3 middle = ray.at(0.5 * (cuts[i] + cuts[i + 1])) - position_;
        if (glm::dot(middle, axis_) < cos_dark_ * glm::length(middle)) continue;
        if (lit.length() == 0) lit.begin = cuts[i];
        lit.end = cuts[i + 1];
    }
    return lit;
}

void Lamp::append_profile_breaks(const Ray& ray, std::vector<double>& s) const {
    for (const double cosine : cones_) append_cone_crossings(ray, position_, axis_, cosine, s);
    if (breaks_at_equator_) append_plane_crossing(ray, position_, axis_, s);
    if (!web_) return;
    append_nearest_to_axis(ray, position_, axis_, s);
    for (const Vector3& side : half_planes_)
        append_half_plane_crossing(ray, position_, side, glm::cross(axis_, side), s);
}

}  // namespace uw
