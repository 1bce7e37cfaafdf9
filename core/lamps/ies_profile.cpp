#include "core/lamps/ies_profile.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/lamps/ies_file.h"
#include "core/lamps/ray_crossings.h"

namespace uw {

namespace {

// Lumens in a file are those of the bare lamps: the luminaire may absorb much of them, but emits no
// more.
constexpr double k_flux_tolerance = 0.01;
constexpr double k_least_efficiency = 0.1;

std::shared_ptr<const PhotometricWeb> read_web(const IesProfileDesc& profile,
                                               std::vector<std::string>& warnings) {
    const IesFile file = read_ies(profile.file);
    for (const std::string& warning : file.warnings)
        warnings.push_back(profile.where + ": " + warning);
    auto web = std::make_shared<const PhotometricWeb>(file);
    const double flux = web->flux();
    if (file.lumens > 0 && flux > (1 + k_flux_tolerance) * file.lumens)
        warnings.push_back(fmt::format(
            "{}: the candelas of {} add up to {:.4g} lm, more than the {:.4g} lm of its "
            "lamps; check its multiplier and its lumens",
            profile.where, profile.file.filename().string(), flux, file.lumens));
    if (file.lumens > 0 && flux < k_least_efficiency * file.lumens)
        warnings.push_back(
            fmt::format("{}: the candelas of {} add up to {:.4g} lm, {:.2g} % of the {:.4g} lm of "
                        "its lamps; check its multiplier (candelas may be per 1000 lm)",
                        profile.where, profile.file.filename().string(), flux,
                        100 * flux / file.lumens, file.lumens));
    return web;
}

}  // namespace

IesProfile::IesProfile(const IesProfileDesc& desc, const LampPlacement& placement,
                       std::shared_ptr<const PhotometricWeb> web)
    : web_(std::move(web)), cos_dark_(std::cos(web_->dark_angle())) {
    const Vector3& direction = placement.direction;
    const Vector3 towards = placement.across();
    // The zenith, the opposite end of the luminaire's axis, is z of a right-handed system.
    const Vector3 across = glm::cross(-direction, towards);
    const double turn = glm::radians(desc.rotate), tilt = glm::radians(desc.tilt);
    const Vector3 turned = std::cos(turn) * towards + std::sin(turn) * across;
    const auto in_world = [&](const Vector3& v) {
        return glm::normalize(placement.world_from_frame.apply_to_vector(v));
    };
    axis_ = in_world(std::cos(tilt) * direction + std::sin(tilt) * turned);
    zero_ = in_world(std::cos(tilt) * turned - std::sin(tilt) * direction);
    quarter_ = glm::cross(-axis_, zero_);
    constexpr double k_flat = 1e-6;  // a cone this close to 90 degrees is treated as a plane
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

double IesProfile::relative_intensity(const Vector3& v) const {
    const double x = glm::dot(v, zero_), y = glm::dot(v, quarter_), along = glm::dot(v, axis_);
    const double polar = std::atan2(std::sqrt(x * x + y * y), along);
    const double azimuth = web_->is_rotational() ? 0.0 : std::atan2(y, x);
    return web_->candelas(polar, azimuth) / web_->peak();
}

void IesProfile::append_breaks(const Ray& ray, const Interval& /*stretch*/, const Point3& apex,
                               std::vector<double>& s) const {
    for (const double cosine : cones_) append_cone_crossings(ray, apex, axis_, cosine, s);
    if (breaks_at_equator_) append_plane_crossing(ray, apex, axis_, s);
    append_nearest_to_axis(ray, apex, axis_, s);
    for (const Vector3& side : half_planes_)
        append_half_plane_crossing(ray, apex, side, glm::cross(axis_, side), s);
}

IesProfile make_profile(const IesProfileDesc& desc, const LampPlacement& placement,
                        std::vector<std::string>& warnings) {
    return {desc, placement, read_web(desc, warnings)};
}

}  // namespace uw
