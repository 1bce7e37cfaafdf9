#include "core/scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/base/error.h"

namespace uw {

namespace {

/// The largest tangent of the angle between a ray of the image and the optical axis: 89.99 degrees.
constexpr double k_max_slope = 1e4;

/// The smallest width of a pixel, as such a tangent: single precision does not tell narrower ones
/// apart.
constexpr double k_narrowest_pixel = 1e-9;

/// The narrowest beam of a lamp [degrees].
constexpr double k_narrowest_beam = 0.01;

/// The greatest angle in the water between any light of a sun and the normal of the water's surface
/// [degrees].
constexpr double k_lowest_sun = 89;

/// The largest intensity [W/sr], power [W] or flux [lm] of a lamp.
constexpr double k_max_brightness = 1e12;

/// The largest concentration [ppm] or coefficient [1/m] per unit of a grid's value.
constexpr double k_max_per_unit = 1e12;

/// The smallest and largest number of a sensor or of snow that is not 0: no real one is beyond, and
/// single precision holds their products.
constexpr double k_min_number = 1e-12, k_max_quantity = 1e12;

/// One entry of the scene, for its messages.
class Checked {
  public:
    explicit Checked(const SourceLocation& where) : where_(where) {}

    // Also for NaN.
    void at_most(double limit, std::string_view name, std::initializer_list<double> values,
                 std::string_view hint) const {
        for (const double value : values)
            if (!(std::abs(value) <= limit)) fail(name, value, limit, hint);
    }
    /// Checks that a number is neither too large nor, unless it is 0, too small to be realistic.
    void number(std::string_view name, double value) const {
        constexpr std::string_view k_hint = "check its unit";
        at_most(k_max_quantity, name, {value}, k_hint);
        if (value != 0 && std::abs(value) < k_min_number)
            fail(
                fmt::format("its {} of {:g} is below {:g}; {}", name, value, k_min_number, k_hint));
    }
    void place(std::string_view name, const Vector3& v) const {
        at_most(k_max_coordinate, name, {v.x, v.y, v.z},
                "lengths are in metres; scale the scene or move it nearer to the origin");
    }
    void place(std::string_view name, const Point3& p) const { place(name, from_origin(p)); }
    void length(std::string_view name, double value) const {
        at_most(k_max_coordinate, name, {value}, "lengths are in metres");
    }
    void matrix(std::string_view name, const Matrix3& m) const {
        for (int column = 0; column < 3; ++column)
            at_most(k_max_coordinate, name, {m[column].x, m[column].y, m[column].z},
                    "scale the scene to metres");
    }
    template <class Values>
    void all_at_most(double limit, std::string_view name, const Values& values,
                     std::string_view hint) const {
        for (const double value : values) at_most(limit, name, {value}, hint);
    }
    [[noreturn]] void fail(std::string_view what) const {
        throw InputError(fmt::format("{}: {}", where_, what));
    }

  private:
    [[noreturn]] void fail(std::string_view name, double value, double limit,
                           std::string_view hint) const {
        if (!std::isfinite(value)) fail(fmt::format("its {} is not a finite number", name));
        fail(fmt::format("its {} of {:g} is beyond {:g}; {}", name, value, limit, hint));
    }

    const SourceLocation& where_;
};

void check(const PortDesc& port, const Checked& checked) {
    std::visit(
        [&]<class Port>(const Port& desc) {
            if constexpr (std::is_same_v<Port, DomePortDesc>) {
                checked.place("port's centre", desc.center);
                checked.length("port's radius", desc.radius);
            } else {
                checked.length("port's distance", desc.distance);
            }
            checked.length("port's thickness", desc.thickness);
        },
        port);
}

void check(const SensorDesc& sensor, const Checked& checked) {
    checked.number("sensor's full_well", sensor.full_well.value_or(0));
    checked.number("sensor's gain", sensor.gain.value_or(0));
    checked.number("sensor's exposure", sensor.exposure.value_or(0));
    checked.number("sensor's pixel_pitch", sensor.pixel_pitch.value_or(0));
    checked.number("sensor's dark_current", sensor.dark_current);
    checked.number("sensor's read_noise", sensor.read_noise);
    checked.number("sensor's dsnu", sensor.dsnu);
    checked.number("sensor's prnu", sensor.prnu);
}

void check(const CameraDesc& camera) {
    const Checked checked(camera.where);
    checked.place("position", camera.world_from_camera.offset());
    checked.matrix("pose", camera.world_from_camera.linear());
    const IntrinsicsDesc& lens = camera.intrinsics;
    const auto check_axis = [&](char axis, double focal, double centre, int pixels) {
        const double farthest = std::max(std::abs(centre), std::abs(pixels - centre));
        if (!(farthest <= k_max_slope * focal))
            checked.fail(
                fmt::format("f{0} = {1:g} and c{0} = {2:g} pixels show more than 89.99 degrees "
                            "from the optical "
                            "axis; give f{0} >= {3:g}, or a distortion of the fisheye model",
                            axis, focal, centre, farthest / k_max_slope));
        if (!(1 >= k_narrowest_pixel * focal))
            checked.fail(fmt::format("f{} = {:g} pixels is beyond {:g}; give it in pixels", axis,
                                     focal, 1 / k_narrowest_pixel));
    };
    check_axis('x', lens.fx, lens.cx, camera.width);
    check_axis('y', lens.fy, lens.cy, camera.height);
    const auto finite = [](double value) { return std::isfinite(value); };
    if (!std::ranges::all_of(camera.distortion.k, finite) ||
        !std::ranges::all_of(camera.distortion.p, finite))
        checked.fail("a coefficient of its distortion is not a finite number");
    if (camera.port) check(*camera.port, checked);
    if (camera.sensor) check(*camera.sensor, checked);
    if (!camera.lens) return;
    checked.length("lens's focal length", camera.lens->focal_length);
    if (!camera.lens->focus_distance) return;
    checked.length("lens's focus distance", *camera.lens->focus_distance);
    if (camera.distortion.model == DistortionDesc::Model::fisheye)
        checked.fail(
            "lens.focus_distance: depth of field is that of a rectilinear lens, and this "
            "one is a fisheye; leave it out");
}

std::optional<double> beam_of(const LampProfileDesc& profile) {
    if (const auto* spot = std::get_if<SpotProfileDesc>(&profile)) return spot->beam;
    if (const auto* cosine = std::get_if<CosineProfileDesc>(&profile)) return cosine->fwhm;
    if (const auto* line = std::get_if<LineProfileDesc>(&profile))
        return std::min(line->angle, line->width);
    if (const auto* image = std::get_if<ImageProfileDesc>(&profile)) return image->fov;
    return std::nullopt;
}

// All of its directions have to lead into the water.
void check(const SunDesc& sun, const LampDesc& lamp, const Checked& checked) {
    const double cosine = -glm::dot(lamp.direction, sun.surface.normal);
    const double lowest = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))) + 0.5 * sun.angle;
    if (!(lowest <= k_lowest_sun))
        checked.fail(fmt::format(
            "its light comes from {:.4g} degrees off the normal of water.surface, beyond {:g}, and "
            "does not enter the water; give the direction in which it travels, downwards",
            lowest, k_lowest_sun));
}

void check(const LampDesc& lamp) {
    const Checked checked(lamp.where);
    if (lamp.sun) check(*lamp.sun, lamp, checked);
    checked.place("position", lamp.position);
    checked.place("frame", lamp.world_from_mount.offset());
    checked.matrix("frame", lamp.world_from_mount.linear());
    checked.at_most(1.001, "direction", {glm::length(lamp.direction)}, "give a direction");
    if (const auto beam = beam_of(lamp.profile); beam && !(*beam >= k_narrowest_beam))
        checked.fail(fmt::format("its beam of {:g} degrees is narrower than {:g}; widen it", *beam,
                                 k_narrowest_beam));
    if (lamp.extent) {
        checked.length("width", lamp.extent->width);
        checked.length("height", lamp.extent->height);
        checked.length("radius", lamp.extent->radius);
    }
    constexpr auto k_hint = "give W/sr, W or lm";
    if (lamp.intensity) checked.all_at_most(k_max_brightness, "intensity", *lamp.intensity, k_hint);
    if (lamp.power) checked.all_at_most(k_max_brightness, "power", *lamp.power, k_hint);
    if (lamp.lumens) checked.at_most(k_max_brightness, "flux", {*lamp.lumens}, k_hint);
}

void check(const GeometryDesc& geometry) {
    const Checked checked(geometry.where);
    checked.place("transform", geometry.world_from_object.offset());
    checked.matrix("transform", geometry.world_from_object.linear());
    checked.place("point", geometry.point);
    checked.place("min", geometry.min);
    checked.place("max", geometry.max);
    checked.place("center", geometry.center);
    checked.length("radius", geometry.radius);
}

void check(const VolumeDesc& volume) {
    const Checked checked(volume.where);
    checked.place("transform", volume.world_from_upright.offset());
    checked.matrix("transform", volume.world_from_upright.linear());
    for (const GridMappingDesc& grid : volume.grids) {
        const Checked mapping(grid.where);
        constexpr auto k_hint = "values are in ppm, coefficients in 1/m per unit";
        mapping.at_most(k_max_per_unit, "concentration", {grid.small_ppm, grid.large_ppm}, k_hint);
        for (const SpeciesAmount& amount : grid.amounts)
            if (amount.unit != SpeciesAmount::Unit::number)
                mapping.at_most(k_max_per_unit, "concentration", {amount.amount}, k_hint);
        if (!grid.optics) continue;
        mapping.all_at_most(k_max_per_unit, "absorption", grid.optics->absorption, k_hint);
        mapping.all_at_most(k_max_per_unit, "scattering", grid.optics->scattering, k_hint);
    }
}

}  // namespace

void check_limits(const SceneDesc& scene) {
    check(scene.camera);
    const Checked water(scene.water.where);
    if (scene.water.surface) water.place("surface's point", scene.water.surface->point);
    if (scene.water.snow) {
        water.number("snow's number", scene.water.snow->number);
        water.place("snow's drift", scene.water.snow->drift);
    }
    for (const LampDesc& lamp : scene.lamps) check(lamp);
    for (const GeometryDesc& geometry : scene.geometry) check(geometry);
    for (const VolumeDesc& volume : scene.volumes) check(volume);
}
}  // namespace uw
