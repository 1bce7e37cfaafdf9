#include "render/navigation/echo_sounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr double k_farthest_surface = 1e6;  // [m]

double radians_of(double degrees) {
    return degrees * (std::numbers::pi / 180);
}

/// The direction at an angle from z, at an azimuth from x towards y [rad].
Vector3 around_axis(double angle, double azimuth) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
            std::cos(angle)};
}

/// The scene's geometry alone.
SceneDesc geometry_of(SceneDesc scene) {
    scene.volumes.clear();
    scene.lamps.clear();
    WaterDesc water;
    water.bands_nm = scene.water.bands_nm;
    scene.water = std::move(water);
    return scene;
}

}  // namespace

EchoSurfaces::EchoSurfaces(const SceneDesc& whole, const SourceLocation& where) {
    for (const GeometryDesc& object : whole.geometry) {
        if (object.is_sequence)
            throw InputError(fmt::format(
                "{}: sounds surfaces at times between frames, and {} has a file for each frame; "
                "leave the sensor out, or give one file",
                where, object.where));
        moves_ = moves_ || object.trajectory || object.animation;
    }
    first_.emplace(geometry_of(whole), ImageChoice{});
    renderer_.set_scene(*first_);
}

const Surfaces& EchoSurfaces::at(double time) {
    if (moves_) renderer_.set_scene(first_->at(time));
    return *renderer_.assemble().surfaces;
}

Echo echo_along(const Ray& ray, const Surfaces& surfaces, const EchoRangeDesc& reach) {
    SurfaceHit hit;
    if (!surfaces.closest_hit(ray, k_farthest_surface, hit))
        return {std::numeric_limits<double>::infinity(), false};
    const double cosine = std::abs(glm::dot(ray.direction, hit.geometric_normal));
    const bool is_steep = cosine < std::cos(radians_of(reach.steepest)) - 1e-12;
    return {hit.distance,
            !is_steep && hit.distance >= reach.nearest && hit.distance <= reach.farthest};
}

std::array<Vector3, 4> beam_directions(const DvlDesc& dvl) {
    std::array<Vector3, 4> directions{};
    for (std::size_t i = 0; i < directions.size(); ++i)
        directions[i] = around_axis(radians_of(dvl.beam_angle),
                                    radians_of(dvl.azimuth + 90 * static_cast<double>(i)));
    return directions;
}

std::vector<Vector3> altimeter_directions(const AltimeterDesc& altimeter) {
    constexpr int k_rays_per_ring = 8;  // times its number
    std::vector<Vector3> directions{{0, 0, 1}};
    if (altimeter.beam == 0) return directions;
    for (int ring = 1; ring <= k_altimeter_rings; ++ring)
        for (int i = 0; i < k_rays_per_ring * ring; ++i)
            directions.push_back(
                around_axis(radians_of(altimeter.beam / 2) * ring / k_altimeter_rings,
                            2 * std::numbers::pi * i / (k_rays_per_ring * ring)));
    return directions;
}

std::optional<Vector3> velocity_of_beams(const std::array<Vector3, 4>& directions,
                                         const std::array<std::optional<double>, 4>& along) {
    // The normal equations. Any three of the beams are independent.
    Matrix3 squares(0.0);
    Vector3 sums(0.0);
    int valid = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (!along[i]) continue;
        ++valid;
        const Vector3& d = directions[i];
        for (int column = 0; column < 3; ++column) squares[column] += d * d[column];
        sums += d * *along[i];
    }
    if (valid < 3) return std::nullopt;
    return glm::inverse(squares) * sums;
}

}  // namespace uw
