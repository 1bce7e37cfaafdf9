#include "core/light/lamp_factory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/image/spectral_bands.h"
#include "core/light/lamp_profile.h"

namespace uw {

namespace {

LampSpectrum spectrum_of(const LampDesc& desc, std::vector<std::string>& warnings) {
    if (desc.spectrum) return make_lamp_spectrum(*desc.spectrum);
    LampSpectrum flat = make_lamp_spectrum({});
    warnings.push_back(
        fmt::format("{}: its candelas are taken as those of a flat spectrum, 380 to 780 nm, {:.0f} "
                    "lm/W; give its spectrum, such as spectrum: {{type: led, name: LED-B4}}",
                    desc.where, luminous_efficacy(flat)));
    return flat;
}

double peak_candelas(const LampProfile& profile) {
    const std::optional<double> candelas =
        std::visit([](const auto& p) { return p.peak_candelas(); }, profile);
    if (!candelas) throw std::logic_error("a lamp without intensity, power, lumens or candelas");
    return *candelas;
}

// Sets watts per band if the lamp is given by its spectrum, by lumens or by its profile's candelas.
void resolve_output(LampDesc& desc, const LampProfile& profile, std::span<const double> bands_nm,
                    std::vector<std::string>& warnings) {
    const bool candelas = !desc.intensity && !desc.power && !desc.lumens;
    if (!desc.spectrum && !candelas) return;
    const SourceLocation& where = desc.spectrum ? desc.spectrum->where : desc.where;
    if (bands_nm.size() < 2)
        throw InputError(
            fmt::format("{}: how much of a spectrum falls into a single band is undefined, as it "
                        "has no neighbours; give the lamp's intensity or power in that band",
                        where));
    const LampSpectrum spectrum = spectrum_of(desc, warnings);
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    const auto per_band = [&](double total) { return band_values(spectrum, total, intervals); };
    const auto watts = [&](double lumens) {
        const double efficacy = luminous_efficacy(spectrum);
        if (!(efficacy > 0))
            throw InputError(
                fmt::format("{}: nothing of this spectrum is visible (360 to 830 nm), so lumens "
                            "and candelas do not determine it; give intensity or power in W",
                            where));
        return lumens / efficacy;
    };
    if (desc.intensity)
        desc.intensity = per_band(desc.intensity->front());
    else if (desc.power)
        desc.power = per_band(desc.power->front());
    else if (desc.lumens)
        (desc.sun ? desc.intensity : desc.power) = per_band(watts(*desc.lumens));
    else
        desc.intensity = per_band(watts(peak_candelas(profile)));
    const PerBand& values = desc.power ? *desc.power : *desc.intensity;
    if (*std::ranges::max_element(values) <= 0)
        throw InputError(fmt::format(
            "{}: has no light in any band of the scene; check its wavelengths and water.bands",
            where));
}

// Radiant intensity per band where the profile is 1; exactly one of intensity and power is set.
Spectrum axis_intensity(const LampDesc& desc, const LampProfile& profile, std::size_t band_count) {
    const auto solid_angle = [](const auto& p) { return p.solid_angle(); };
    const double per_watt = desc.power ? 1.0 / std::visit(solid_angle, profile) : 1.0;
    const PerBand& values = desc.power ? *desc.power : *desc.intensity;
    Spectrum intensity{};
    for (std::size_t i = 0; i < band_count; ++i) intensity[i] = per_watt * values[i];
    return intensity;
}

}  // namespace

Lamp make_lamp(const LampDesc& given, const Affine& world_from_camera,
               std::span<const double> bands_nm, std::vector<std::string>& warnings) {
    LampDesc desc = given;
    const Affine& world_from_frame = desc.world_from_frame(world_from_camera);
    LampProfile profile =
        make_lamp_profile(desc.profile, {world_from_frame, desc.direction}, warnings);
    resolve_output(desc, profile, bands_nm, warnings);
    const Spectrum intensity = axis_intensity(desc, profile, bands_nm.size());
    if (desc.sun) return {desc.name, Sunlight{desc.direction, desc.sun->surface}, intensity};
    return {desc.name, world_from_frame * desc.position, std::move(profile), intensity};
}

namespace {

struct PlanePoint {
    double x = 0, y = 0;
};

// The point of a unit lattice as one of the extent, relative to its centre [m].
PlanePoint on_extent(const LampExtentDesc& extent, double u, double v) {
    if (extent.shape == LampExtentDesc::Shape::disk) {
        const double radius = extent.radius * std::sqrt(u), angle = 2 * std::numbers::pi * v;
        return {radius * std::cos(angle), radius * std::sin(angle)};
    }
    // The even steps of u go along the longer side.
    if (extent.width < extent.height) std::swap(u, v);
    return {(u - 0.5) * extent.width, (v - 0.5) * extent.height};
}

std::vector<PlanePoint> fill(const LampExtentDesc& extent, int count) {
    std::vector<PlanePoint> points;
    PlanePoint mean;
    for (int i = 0; i < count; ++i) {
        const double turns = (i + 0.5) * std::numbers::phi;
        points.push_back(on_extent(extent, (i + 0.5) / count, turns - std::floor(turns)));
        mean.x += points.back().x / count;
        mean.y += points.back().y / count;
    }
    for (PlanePoint& point : points) {
        point.x -= mean.x;
        point.y -= mean.y;
    }
    return points;
}

// Seen by a plane perpendicular to it, a disc of uniform radiance is one of the directions' sines,
// with the irradiance spread evenly over it; perpendicular to a direction itself it is greater.
void append_sun(const SunDesc& sun, const Lamp& lamp, std::size_t index, int thinning,
                std::vector<Lamp>& emitters) {
    const Vector3 middle = lamp.sunlight()->direction;
    const LampPlacement placement{{}, middle};
    const Vector3 x = placement.across(), y = glm::cross(middle, x);
    LampExtentDesc disk;
    disk.shape = LampExtentDesc::Shape::disk;
    disk.radius = std::sin(glm::radians(0.5 * sun.angle));
    const int count = std::max(1, sun.samples / thinning);
    for (const PlanePoint& point : fill(disk, count)) {
        const double cosine = std::sqrt(1 - point.x * point.x - point.y * point.y);
        const Vector3 direction = cosine * middle + point.x * x + point.y * y;
        emitters.push_back(lamp.emitter(index, direction, 1.0 / count).brightened(1 / cosine));
    }
}

// So many that they leave half a per cent of unevenness, where all directions of scattering count
// alike.
constexpr int k_many_points = 512;

LampPoints points_of(const LampSurface& surface, int count) {
    LampPoints points;
    for (const PlanePoint& point : fill(surface.extent, count))
        points.positions.push_back(surface.lamp.position() + point.x * surface.x +
                                   point.y * surface.y);
    points.patch_radius = std::sqrt(surface.area() / (std::numbers::pi * count));
    return points;
}

LampSurface surface_of(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                       const Affine& world_from_camera) {
    const LampPlacement placement{desc.world_from_frame(world_from_camera), desc.direction};
    const double turn = glm::radians(desc.extent->rotate);
    const Vector3 across = placement.across(), up = glm::cross(-placement.direction, across);
    const auto in_world = [&](const Vector3& v) {
        return placement.world_from_frame.apply_to_vector(v);
    };
    LampSurface surface{lamp.emitter(index, lamp.position(), 1),
                        *desc.extent,
                        in_world(std::cos(turn) * across + std::sin(turn) * up),
                        in_world(std::cos(turn) * up - std::sin(turn) * across),
                        {},
                        {}};
    const int count = std::max(1, desc.extent->samples / thinning);
    surface.emitters = points_of(surface, count);
    surface.many = points_of(surface, std::max(count, k_many_points));
    return surface;
}

}  // namespace

void append_surface(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                    const Affine& world_from_camera, std::vector<LampSurface>& surfaces) {
    if (desc.extent) surfaces.push_back(surface_of(desc, lamp, index, thinning, world_from_camera));
}

void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Affine& world_from_camera, std::vector<Lamp>& emitters) {
    if (desc.sun && desc.sun->angle > 0) {
        append_sun(*desc.sun, lamp, index, thinning, emitters);
        return;
    }
    if (!desc.extent) {
        emitters.push_back(lamp.emitter(index, lamp.position(), 1));
        return;
    }
    const LampPoints points = surface_of(desc, lamp, index, thinning, world_from_camera).emitters;
    const double share = 1.0 / static_cast<double>(points.positions.size());
    for (const Point3& position : points.positions)
        emitters.push_back(lamp.emitter(index, position, share, points.patch_radius));
}

}  // namespace uw
