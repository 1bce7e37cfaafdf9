#include "cli/info/scene_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

constexpr double k_degree = std::numbers::pi / 180;
constexpr double k_filled = 0.9;  // of the picture, by the box
constexpr const char* k_water = "jerlov-II";

/// The camera's axes in the world, unit.
struct View {
    Vector3 right, up, forward;
};

/// Towards the broader of the box's upright sides; steeper, the flatter the box.
View view_of(const Vector3& size) {
    const Vector3 level = size.x >= size.z ? Vector3(0, 0, -1) : Vector3(-1, 0, 0);
    const double flatness = 1 - std::min(1.0, size.y / std::max(size.x, size.z));
    const double elevation = (6 + 24 * flatness * flatness) * k_degree;
    View view;
    view.forward = std::cos(elevation) * level - std::sin(elevation) * Vector3(0, 1, 0);
    view.right = glm::normalize(glm::cross(view.forward, Vector3(0, 1, 0)));
    view.up = glm::cross(view.right, view.forward);
    return view;
}

double tangent_of_half_width() {
    return std::tan(0.5 * k_proposed_fov * k_degree);
}
double tangent_of_half_height() {
    return tangent_of_half_width() * k_proposed_height / k_proposed_width;
}

/// From where, along the view, all corners of the box lie within the filled part of the picture.
double distance_to(const Bounds& box, const View& view) {
    double away = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis & 1U) != 0 ? box.max[axis] : box.min[axis];
        const Vector3 v = p - box.center();
        const double across = std::abs(glm::dot(v, view.right)) / tangent_of_half_width();
        const double upwards = std::abs(glm::dot(v, view.up)) / tangent_of_half_height();
        away = std::max(away, std::max(across, upwards) / k_filled - glm::dot(v, view.forward));
    }
    return away;
}

/// A lamp that lights a ball of this radius around `target`, a hundredth of a W/m^2 falling on it
/// per watt and steradian whatever its distance.
ProposedLamp aimed(const char* name, const Point3& position, const Point3& target, double radius) {
    const Vector3 way = target - position;
    const double away = glm::length(way);
    ProposedLamp lamp;
    lamp.name = name;
    lamp.position = position;
    lamp.direction = way / away;
    const double half = std::asin(std::min(1.0, radius / away)) / k_degree;
    lamp.beam = std::clamp(std::ceil(2.2 * half), 10.0, 120.0);
    lamp.intensity = 20 * away * away;
    return lamp;
}

}  // namespace

SceneProposal propose_scene(const Bounds& bounds) {
    const Vector3 size = bounds.max - bounds.min;
    const double radius = 0.5 * bounds.diagonal();
    const View view = view_of(size);
    const double away = distance_to(bounds, view);
    SceneProposal proposal;
    proposal.size = 2 * radius;
    proposal.target = bounds.center();
    proposal.eye = proposal.target - away * view.forward;
    proposal.floor = bounds.min.y - 0.05 * radius;
    proposal.water = k_water;
    // Out of the picture: beyond its edge at the depth at which the lamp stands.
    const auto place = [&](double right, double up, double behind) {
        const double depth = away + behind;
        return proposal.target + right * tangent_of_half_width() * depth * view.right +
               up * tangent_of_half_height() * depth * view.up + behind * view.forward;
    };
    proposal.lamps.push_back(
        aimed("key", place(-1.25, 1.9, -0.2 * radius), proposal.target, radius));
    proposal.lamps.push_back(aimed("back", place(1.15, 1.9, radius), proposal.target, radius));
    proposal.lamps.back().intensity *= 0.6;
    return proposal;
}

std::string length_text(double length, double size) {
    const double step = std::pow(10, std::floor(std::log10(std::max(size, 1e-300))) - 3);
    const double steps = std::round(length / step);
    if (steps == 0) return "0";
    const double digits = std::floor(std::log10(std::abs(steps)) + 1e-9) + 1;
    return fmt::format("{:.{}g}", steps * step, static_cast<int>(std::min(digits, 15.0)));
}

std::string point_text(const Point3& p, double size) {
    return fmt::format("[{}, {}, {}]", length_text(p.x, size), length_text(p.y, size),
                       length_text(p.z, size));
}

std::string proposal_yaml(const SceneProposal& p) {
    std::string yaml = "uwvdb: 1\n";
    yaml += fmt::format(
        "camera:\n  resolution: [{}, {}]\n  intrinsics: {{fov_x: {:g}}}\n"
        "  pose: {{position: {}, look_at: {}}}\n",
        k_proposed_width, k_proposed_height, k_proposed_fov, point_text(p.eye, p.size),
        point_text(p.target, p.size));
    yaml += fmt::format("water:\n  preset: {}\n", p.water);
    yaml += fmt::format(
        "geometry:\n  - {{type: plane, point: {}, normal: [0, 1, 0], reflectance: [0.12, 0.11, "
        "0.09]}}\n",
        point_text({p.target.x, p.floor, p.target.z}, p.size));
    yaml += "lamps:\n";
    for (const ProposedLamp& lamp : p.lamps)
        yaml += fmt::format(
            "  - name: {}\n    position: {}\n    direction: [{:.3f}, {:.3f}, {:.3f}]\n"
            "    profile: {{type: spot, beam: {:g}, edge: {:g}}}\n    intensity: {:.3g}\n"
            "    frame: world\n",
            lamp.name, point_text(lamp.position, p.size), lamp.direction.x, lamp.direction.y,
            lamp.direction.z, lamp.beam, std::round(0.25 * lamp.beam), lamp.intensity);
    return yaml;
}

}  // namespace uw
