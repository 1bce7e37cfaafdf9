#include "core/light/lamp_factory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/image/spectral_bands.h"
#include "core/light/directional_emitter.h"
#include "core/light/lamp_profile.h"
#include "core/light/point_emitter.h"
#include "core/light/sky_emitter.h"

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

// The irradiance below the surface of parallel light with this direction in the air, relative to
// that in the air, each on a plane perpendicular to the light: the surface reflects some of it, and
// refraction widens the beam.
double irradiance_below(const WaterSurfaceDesc& surface, const Vector3& direction) {
    if (!surface.n) return 1;
    const WaterSurface boundary(without_waves(surface));
    const double in_air = -glm::dot(direction, surface.normal);
    const double in_water = -glm::dot(boundary.into_water(direction), surface.normal);
    return (1 - boundary.reflectance_from_air(in_air)) * in_air / in_water;
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
    if (desc.sun) {
        const Lamp sun(desc.name, Sunlight::from_air(desc.direction, desc.sun->surface), intensity);
        return sun.brightened(irradiance_below(desc.sun->surface, desc.direction));
    }
    return {desc.name, world_from_frame * desc.position, std::move(profile), intensity};
}

namespace {

std::vector<UnitPoint> lattice(int count) {
    std::vector<UnitPoint> places;
    for (int i = 0; i < count; ++i) {
        const auto fraction = [&](double step) {
            const double turns = (i + 0.5) * step;
            return turns - std::floor(turns);
        };
        places.push_back(
            {(i + 0.5) / count, fraction(std::numbers::phi), fraction(std::numbers::sqrt2)});
    }
    return places;
}

// The points of the surface to which these places map, shifted so that their mean is the centre.
std::vector<Vector3> fill(const LampFrame& frame, const std::vector<UnitPoint>& places) {
    std::vector<Vector3> points;
    Vector3 mean(0);
    for (const UnitPoint& place : places) {
        points.push_back(frame.at(place));
        mean += points.back() / static_cast<double>(places.size());
    }
    for (Vector3& point : points) point -= mean;
    return points;
}

// One of the emitters of which a lamp consists, with this fraction of its light.
Lamp part_of(const Lamp& lamp, std::size_t index, double fraction,
             std::shared_ptr<const Emitter> emitter) {
    return {lamp.name(), std::move(emitter), fraction * lamp.axis_intensity(), index, fraction};
}

// In the space of the directions' sines a disc of uniform radiance adds the same irradiance per
// area to a plane perpendicular to its axis; on a plane perpendicular to the direction itself the
// irradiance is greater by 1 / cosine. `direction`: of its centre, in the air where the water's
// surface refracts.
void append_sun(const SunDesc& sun, const Vector3& direction, const Lamp& lamp, std::size_t index,
                int thinning, std::vector<Lamp>& emitters) {
    const WaterSurfaceDesc& surface = sun.surface;
    const Vector3 middle = direction;
    const double of_middle = irradiance_below(surface, middle);
    const LampPlacement placement{{}, middle};
    LampFrame frame{{}, placement.across(), glm::cross(middle, placement.across())};
    frame.extent.shape = LampExtentDesc::Shape::disk;
    frame.extent.radius = std::sin(glm::radians(0.5 * sun.angle));
    const int count = std::max(1, sun.samples / thinning);
    const std::vector<UnitPoint> places = lattice(count);
    const std::vector<Vector3> points = fill(frame, places);
    const std::vector<LampPatch> patches = divide(frame, {}, places);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double cosine = std::sqrt(1 - glm::dot(points[i], points[i]));
        const Vector3 in_air = cosine * middle + points[i];
        const double factor = irradiance_below(surface, in_air) / (of_middle * cosine);
        emitters.push_back(part_of(lamp, index, 1.0 / count,
                                   std::make_shared<DirectionalEmitter>(
                                       Sunlight::from_air(in_air, surface), patches[i]))
                               .brightened(factor));
    }
}

// This many points leave half a per cent of unevenness for isotropic scattering.
constexpr int k_many_points = 512;

LampPoints points_of(const LampFrame& frame, const Point3& centre,
                     const std::vector<UnitPoint>& places) {
    LampPoints points;
    for (const Vector3& point : fill(frame, places)) points.positions.push_back(centre + point);
    points.patch_radius =
        std::sqrt(frame.area() / (std::numbers::pi * static_cast<double>(places.size())));
    return points;
}

LampFrame frame_of(const LampDesc& desc, const Affine& world_from_camera) {
    const LampPlacement placement{desc.world_from_frame(world_from_camera), desc.direction};
    const double turn = glm::radians(desc.extent->rotate);
    const Vector3 across = placement.across(), up = glm::cross(-placement.direction, across);
    const auto in_world = [&](const Vector3& v) {
        return placement.world_from_frame.apply_to_vector(v);
    };
    return {*desc.extent, in_world(std::cos(turn) * across + std::sin(turn) * up),
            in_world(std::cos(turn) * up - std::sin(turn) * across)};
}

int point_count(const LampDesc& desc, int thinning) {
    return std::max(1, desc.extent->samples / thinning);
}

}  // namespace

Lamp make_lamp(const LampDesc& desc, std::span<const EmissivePart> parts) {
    const std::vector<EmissivePart> whole = merged(parts, static_cast<int>(parts.size()));
    if (whole.empty()) return {desc.name, Point3(), IsotropicProfile{}, Spectrum{}};
    return {desc.name, whole.front().centre, IsotropicProfile{}, whole.front().intensity};
}

void append_emitters(const Lamp& lamp, std::size_t index, std::span<const EmissivePart> parts,
                     std::vector<Lamp>& emitters) {
    const auto sum = [](const Spectrum& bands) {
        double all = 0;
        for (const double band : bands) all += band;
        return all;
    };
    const double all = sum(lamp.axis_intensity());
    // A lamp without parts has one dark emitter, so that the indices of other lamps stay the same.
    if (parts.empty()) emitters.push_back(lamp.with_index(index));
    for (const EmissivePart& part : parts) {
        LampFrame frame{{}, {1, 0, 0}, {0, 1, 0}};
        frame.extent.shape = LampExtentDesc::Shape::sphere;
        frame.extent.radius = part.radius;
        const LampPatch patch{frame, part.centre, {0, 0, 0}, {1, 1, 1}, part.radius};
        emitters.emplace_back(
            lamp.name(), std::make_shared<PointEmitter>(part.centre, IsotropicProfile{}, patch),
            part.intensity, index, sum(part.intensity) / all);
    }
}

void append_surface(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                    const Affine& world_from_camera, std::vector<LampSurface>& surfaces) {
    if (!desc.extent) return;
    const LampFrame frame = frame_of(desc, world_from_camera);
    const int count = point_count(desc, thinning);
    surfaces.push_back(
        {lamp.with_index(index), frame, points_of(frame, lamp.position(), lattice(count)),
         points_of(frame, lamp.position(), lattice(std::max(count, k_many_points)))});
}

void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Affine& world_from_camera, std::vector<Lamp>& emitters) {
    if (desc.sun && desc.sun->angle > 0) {
        append_sun(*desc.sun, desc.direction, lamp, index, thinning, emitters);
        return;
    }
    if (!desc.extent) {
        emitters.push_back(lamp.with_index(index));
        return;
    }
    const LampFrame frame = frame_of(desc, world_from_camera);
    const std::vector<UnitPoint> places = lattice(point_count(desc, thinning));
    const std::vector<Vector3> points = fill(frame, places);
    const std::vector<LampPatch> patches = divide(frame, lamp.position(), places);
    const double fraction_of_each = 1.0 / static_cast<double>(points.size());
    const LampProfile& sharp = dynamic_cast<const PointEmitter&>(lamp.emitter()).profile();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point3 position = lamp.position() + points[i];
        const LampPatch& patch = patches[i];
        LampProfile profile =
            points.size() == 1
                ? sharp
                : softened(sharp, patch.centre + patch.middle() - position, patch.covariance());
        emitters.push_back(
            part_of(lamp, index, fraction_of_each,
                    std::make_shared<PointEmitter>(position, std::move(profile), patch)));
    }
}

Lamp make_lamp(const LampDesc& desc, const Sky& sky) {
    return {desc.name, Sunlight{desc.direction, without_waves(desc.sun->surface)},
            sky.irradiance()};
}

void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Sky& sky, std::vector<Lamp>& emitters) {
    const WaterSurfaceDesc& surface = desc.sun->surface;
    const auto parts = std::make_shared<const SkyParts>(
        sky, std::max(1, desc.sky->samples / thinning), surface.n.value());
    const std::size_t count = parts->parts().size();
    // A lamp without parts has one dark emitter, so that the indices of other lamps stay the same.
    if (count == 0) emitters.push_back(lamp.with_index(index));
    for (std::size_t i = 0; i < count; ++i) {
        const SkyDirection& part = parts->parts()[i].direction;
        const Vector3 in_air = -(sky.world_from_sky() * part.towards);
        const LampPlacement placement{{}, in_air};
        LampFrame frame{{}, placement.across(), glm::cross(in_air, placement.across())};
        frame.extent.shape = LampExtentDesc::Shape::disk;
        frame.extent.radius = std::sqrt(part.solid_angle / std::numbers::pi);
        const LampPatch patch{frame, {}, {0, 0, 0}, {1, 1, 1}, frame.extent.radius};
        Spectrum irradiance = part.normal_irradiance();
        irradiance *= irradiance_below(surface, in_air);
        emitters.emplace_back(
            lamp.name(),
            std::make_shared<SkyEmitter>(Sunlight::from_air(in_air, surface), patch, parts, i,
                                         sky.world_from_sky(), irradiance),
            irradiance, index, 1.0 / static_cast<double>(count));
    }
}

void append_mirror_images(const WaterSurface& surface, std::size_t first,
                          std::vector<Lamp>& emitters) {
    const std::size_t last = emitters.size();
    for (std::size_t i = first; i < last; ++i)
        if (!emitters[i].sunlight() && surface.height(emitters[i].position()) < 0)
            emitters.push_back(emitters[i].mirrored(surface));
}

}  // namespace uw
