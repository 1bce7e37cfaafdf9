#include "render/meters/target_probe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/light/lamp_factory.h"

namespace uw {
namespace {

constexpr std::size_t k_max_kept = 10000;  // of about 1 KB each

/// Returns a camera with few pixels, which cover the middle part of the image. Its pose is that of
/// the scene's camera at the image's time.
CameraDesc probe_camera(const CameraDesc& camera, const TargetOptions& options) {
    CameraDesc probe = camera;
    probe.trajectory.reset();
    const double n = options.rays;
    const double x_scale = n / (options.field * camera.width);
    const double y_scale = n / (options.field * camera.height);
    const double x0 = 0.5 * (1 - options.field) * camera.width;
    const double y0 = 0.5 * (1 - options.field) * camera.height;
    probe.width = probe.height = options.rays;
    probe.intrinsics = {camera.intrinsics.fx * x_scale, camera.intrinsics.fy * y_scale,
                        (camera.intrinsics.cx - x0) * x_scale,
                        (camera.intrinsics.cy - y0) * y_scale};
    return probe;
}

SceneDesc surrounding_of(const SceneDesc& scene, const TargetOptions& options) {
    SceneDesc probe;
    probe.file = scene.file;
    probe.camera = probe_camera(scene.camera, options);
    probe.water = scene.water;
    probe.water.forward_scatter = {};
    probe.volumes = scene.volumes;
    probe.render.samples = 1;
    // The reference integrator is exact and, for so few rays, faster than making deep shadow maps.
    probe.render.integrator = RenderDesc::Integrator::reference;
    return probe;
}

bool is_same(const SceneDesc& a, const SceneDesc& b) {
    return a.water == b.water && a.volumes == b.volumes && a.camera.width == b.camera.width &&
           a.camera.intrinsics == b.camera.intrinsics &&
           a.camera.distortion == b.camera.distortion && a.camera.port == b.camera.port &&
           a.camera.world_from_camera == b.camera.world_from_camera;
}

/// Returns a white target, whose light scales to that of any reflectance.
GeometryDesc target_at(const CameraDesc& camera, double distance, std::size_t bands) {
    GeometryDesc target;
    target.type = GeometryDesc::Type::plane;
    target.point = camera.world_from_camera * Point3{0, 0, distance};
    target.normal = glm::normalize(camera.world_from_camera.apply_to_vector({0, 0, -1}));
    target.reflectance = PerBand(bands, 1.0);
    return target;
}

/// Returns the lamp with a radiant intensity of 1 W/sr on its axis in each band, at its position at
/// the image's time.
LampDesc unit_lamp(const LampDesc& lamp, std::size_t bands) {
    LampDesc unit = lamp;
    unit.trajectory.reset();
    unit.power.reset();
    unit.lumens.reset();
    unit.spectrum.reset();
    unit.intensity = PerBand(bands, 1.0);
    return unit;
}

std::string profile_key(const LampProfileDesc& profile) {
    return std::visit(
        [](const auto& desc) -> std::string {
            using Desc = std::decay_t<decltype(desc)>;
            if constexpr (std::is_same_v<Desc, SpotProfileDesc>)
                return fmt::format("spot {} {} {}", desc.beam, desc.edge,
                                   static_cast<int>(desc.falloff));
            else if constexpr (std::is_same_v<Desc, CosineProfileDesc>)
                return fmt::format("cosine {}", desc.fwhm);
            else if constexpr (std::is_same_v<Desc, TableProfileDesc>)
                return fmt::format("table {} {}", fmt::join(desc.angles, " "),
                                   fmt::join(desc.values, " "));
            else if constexpr (std::is_same_v<Desc, IesProfileDesc>)
                return fmt::format("ies {} {} {}", desc.rotate, desc.tilt, desc.file.string());
            else if constexpr (std::is_same_v<Desc, LineProfileDesc>)
                return fmt::format("line {} {} {}", desc.angle, desc.width, desc.rotate);
            else if constexpr (std::is_same_v<Desc, ImageProfileDesc>)
                return fmt::format("image {} {} {}", desc.fov, desc.rotate, desc.file.string());
            else
                return "isotropic";
        },
        profile);
}

/// Returns a key of all properties of a lamp but its brightness and name.
std::string key_of(const LampDesc& lamp, double distance) {
    std::string key = fmt::format("{} {} {} {} {} {} {} {} ", distance, lamp.position.x,
                                  lamp.position.y, lamp.position.z, lamp.direction.x,
                                  lamp.direction.y, lamp.direction.z, lamp.fixed_to_camera);
    if (!lamp.fixed_to_camera) {
        const Affine& mount = lamp.world_from_mount;
        for (int i = 0; i < 3; ++i)
            key += fmt::format("{} {} {} {} ", mount.linear()[i].x, mount.linear()[i].y,
                               mount.linear()[i].z, mount.offset()[i]);
    }
    if (lamp.extent) {
        const LampExtentDesc& extent = *lamp.extent;
        key += fmt::format("{} {} {} {} {} {} ", static_cast<int>(extent.shape), extent.width,
                           extent.height, extent.rotate, extent.radius, extent.samples);
    }
    if (lamp.is_of_scene()) key += "of the scene " + lamp.name;  // the rest is of the surrounding
    if (lamp.sun) key += fmt::format("sun {} {} ", lamp.sun->angle, lamp.sun->samples);
    return key + profile_key(lamp.profile);
}

double mean_of_bands(const Spectrum& values, std::size_t bands) {
    double sum = 0;
    for (const double value : values.first(bands)) sum += value;
    return sum / static_cast<double>(bands);
}

}  // namespace

TargetNumbers target_numbers(std::span<const LampOnTarget> lamps, double distance,
                             std::size_t bands, const TargetOptions& options) {
    LampOnTarget all;
    for (const LampOnTarget& lamp : lamps) {
        all.signal += lamp.signal;
        all.backscatter += lamp.backscatter;
        all.irradiance += lamp.irradiance;
    }
    const double white = mean_of_bands(all.signal, bands);
    TargetNumbers numbers;
    numbers.distance = distance;
    numbers.signal = options.bright * white;
    numbers.backscatter = mean_of_bands(all.backscatter, bands);
    numbers.irradiance = mean_of_bands(all.irradiance, bands);
    const double both = (options.bright + options.dark) * white + 2 * numbers.backscatter;
    if (both > 0) numbers.contrast = (options.bright - options.dark) * white / both;
    if (numbers.backscatter > 0)
        numbers.signal_to_backscatter = numbers.signal / numbers.backscatter;
    else if (numbers.signal > 0)
        numbers.signal_to_backscatter = std::numeric_limits<double>::infinity();
    return numbers;
}

TargetProbe::TargetProbe(const TargetOptions& options) : options_(options) {
    if (!(options.dark >= 0 && options.dark < options.bright && options.bright <= 1))
        throw UsageError("target: its reflectances must be 0 <= dark < bright <= 1");
    if (!(options.field > 0 && options.field <= 1))
        throw UsageError("target: its field must be greater than 0 and at most 1");
    if (options.rays < 1 || options.rays > 64)
        throw UsageError("target: its rays per side must be from 1 to 64");
}

void TargetProbe::enter(const SceneDesc& scene) {
    SceneDesc surrounding = surrounding_of(scene, options_);
    if (surrounding_ && is_same(*surrounding_, surrounding) && kept_.size() < k_max_kept) return;
    kept_.clear();
    surrounding_ = std::move(surrounding);
}

LampOnTarget TargetProbe::render(const LampDesc& lamp, double distance) {
    const std::size_t bands = surrounding_->water.bands_nm.size();
    SceneDesc desc = *surrounding_;
    desc.geometry = {target_at(desc.camera, distance, bands)};
    desc.lamps = {unit_lamp(lamp, bands)};
    renderer_.set_scene(std::move(desc));
    const LayerPlan plan = layer_plan(renderer_.scene(), "direct,backscatter,irradiance");
    const Film& film = renderer_.render({.layers = "direct,backscatter,irradiance"});
    LampOnTarget light;
    const auto add_to = [&](Spectrum& sum, Layer layer, std::span<const float> pixel) {
        const auto first = static_cast<std::size_t>(plan.first_channel(layer));
        for (std::size_t b = 0; b < bands; ++b) sum[b] += static_cast<double>(pixel[first + b]);
    };
    const int side = options_.rays;
    for (int i = 0; i < side * side; ++i) {
        const std::span<const float> pixel = film.pixel(i % side, i / side);
        add_to(light.signal, Layer::direct, pixel);
        add_to(light.backscatter, Layer::backscatter, pixel);
        add_to(light.irradiance, Layer::irradiance, pixel);
    }
    for (Spectrum* const sum : {&light.signal, &light.backscatter, &light.irradiance})
        *sum /= static_cast<double>(side) * side;
    ++rendered_;
    return light;
}

LampOnTarget TargetProbe::lamp_on_target(const ImageScene& scene, const LampDesc& lamp,
                                         double distance) {
    if (!(distance > 0) || !std::isfinite(distance))
        throw UsageError(
            fmt::format("target: {} m is no distance; give one greater than 0", distance));
    enter(scene.desc());
    const std::string key = key_of(lamp, distance);
    auto found = kept_.find(key);
    if (found == kept_.end()) {
        throw_if_stopped();
        found = kept_.emplace(key, render(lamp, distance)).first;
    }
    if (lamp.is_of_scene()) return found->second;
    std::vector<std::string> warnings;  // the image of the scene has them, too
    const SceneDesc& desc = scene.desc();
    const Spectrum intensity =
        make_lamp(lamp, desc.camera.world_from_camera, desc.water.bands_nm, warnings)
            .axis_intensity();
    return {intensity * found->second.signal, intensity * found->second.backscatter,
            intensity * found->second.irradiance};
}

std::vector<LampOnTarget> TargetProbe::lamps_on_target(const ImageScene& scene, double distance) {
    std::vector<LampOnTarget> lamps;
    for (const LampDesc& lamp : scene.desc().lamps)
        lamps.push_back(lamp_on_target(scene, lamp, distance));
    return lamps;
}

std::vector<TargetNumbers> TargetProbe::curve(const ImageScene& scene,
                                              std::span<const double> distances) {
    std::vector<TargetNumbers> numbers;
    for (const double distance : distances)
        numbers.push_back(target_numbers(lamps_on_target(scene, distance), distance,
                                         scene.desc().water.bands_nm.size(), options_));
    return numbers;
}

std::vector<double> target_distances(double nearest, double farthest, int count) {
    std::vector<double> distances;
    for (int i = 0; i < count; ++i) {
        const double t = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
        distances.push_back(nearest * std::pow(farthest / nearest, t));
    }
    return distances;
}

}  // namespace uw
