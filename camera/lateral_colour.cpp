#include "camera/lateral_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace uw {

namespace {

/// Places along each side of the image that are looked at, corners included.
constexpr int k_places = 9;
/// Distances from the glass of the points that are looked at [m].
constexpr std::array<double, 3> k_distances{0.25, 1, 1000};

Camera camera_at(CameraDesc desc, double wavelength_nm) {
    set_wavelength(desc, wavelength_nm);
    return Camera(desc);
}

LateralColour lateral_colour(const Camera& from, const Camera& to) {
    LateralColour most;
    for (int j = 0; j < k_places; ++j)
        for (int i = 0; i < k_places; ++i) {
            const ImagePoint at{from.width() * static_cast<double>(i) / (k_places - 1),
                                from.height() * static_cast<double>(j) / (k_places - 1)};
            const auto ray = from.refracted_ray(at.x, at.y);
            if (!ray) continue;
            for (const double distance : k_distances) {
                const auto projected = to.project(ray->at(distance));
                if (!projected) continue;
                const double pixels = std::hypot(projected->x - at.x, projected->y - at.y);
                if (pixels > most.pixels) most = {pixels, at};
            }
        }
    return most;
}

}  // namespace

LateralColour lateral_colour(const CameraDesc& camera, double from_nm, double to_nm) {
    if (!disperses(camera)) return {};
    return lateral_colour(camera_at(camera, from_nm), camera_at(camera, to_nm));
}

std::vector<BandShift> band_shifts(const CameraDesc& camera, std::span<const double> bands_nm) {
    std::vector<BandShift> shifts;
    if (!disperses(camera)) return shifts;
    const Camera own = camera_at(camera, camera.wavelength_nm);
    for (const double nm : bands_nm)
        shifts.push_back({nm, lateral_colour(own, camera_at(camera, nm)).pixels});
    return shifts;
}

std::string text_of(std::span<const BandShift> shifts) {
    constexpr double k_nothing = 1e-6;  // [pixels]: rounding
    std::string text;
    for (const BandShift& shift : shifts) {
        if (shift.pixels < k_nothing) continue;  // the camera's own wavelength
        text += fmt::format("{}{:.2f}{} at {:g} nm", text.empty() ? "up to " : ", ", shift.pixels,
                            text.empty() ? " pixels" : "", shift.wavelength_nm);
    }
    return text.empty() ? "none" : text;
}

std::vector<ColourGroup> colour_groups(const CameraDesc& camera, std::span<const double> bands_nm,
                                       double tolerance) {
    std::vector<ColourGroup> groups{{camera.wavelength_nm, {}}};
    if (!disperses(camera)) {
        groups.front().bands.resize(bands_nm.size());
        std::iota(groups.front().bands.begin(), groups.front().bands.end(), std::size_t{0});
        return groups;
    }
    // Outwards from the camera's wavelength, so that a group's bands are neighbours.
    std::vector<std::size_t> order(bands_nm.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t band) {
        return std::abs(bands_nm[band] - camera.wavelength_nm);
    });
    std::vector<Camera> cameras{camera_at(camera, camera.wavelength_nm)};
    for (const std::size_t band : order) {
        const Camera own = camera_at(camera, bands_nm[band]);
        std::size_t group = 0;
        while (group < groups.size() && lateral_colour(cameras[group], own).pixels > tolerance)
            ++group;
        if (group == groups.size()) {
            groups.push_back({bands_nm[band], {}});
            cameras.push_back(own);
        }
        groups[group].bands.push_back(band);
    }
    for (ColourGroup& group : groups) std::ranges::sort(group.bands);
    return groups;
}

}  // namespace uw
