#include "edit/session/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace uw {
namespace {

/// A position in the request's box, 0..1 along each axis, or on its line, 0..1 in the first.
using Place = std::array<double, 3>;

constexpr double k_finest_step = 0.01;  // [m]

Point3 position_at(const SuggestRequest& request, const Place& place) {
    Point3 position;
    for (int axis = 0; axis < 3; ++axis) {
        const double fraction = request.in_box ? place[static_cast<std::size_t>(axis)] : place[0];
        position[axis] = std::lerp(request.from[axis], request.to[axis], fraction);
    }
    return position;
}

/// The lengths of the axes of a Place [m]; an axis of length 0 has but one value.
std::array<double, 3> axis_lengths(const SuggestRequest& request) {
    const Vector3 diagonal = request.to - request.from;
    if (!request.in_box) return {glm::length(diagonal), 0, 0};
    return {std::abs(diagonal.x), std::abs(diagonal.y), std::abs(diagonal.z)};
}

/// The numbers of points along each axis of a grid that is as evenly spaced as `most` points allow.
std::array<std::size_t, 3> grid_counts(const std::array<double, 3>& lengths, std::size_t most) {
    std::array<std::size_t, 3> counts{1, 1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (lengths[axis] > 0) counts[axis] = 2;
    while (true) {
        std::size_t widest = 3;
        double gap = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (lengths[axis] == 0) continue;
            const double own = lengths[axis] / static_cast<double>(counts[axis] - 1);
            if (own > gap) {
                gap = own;
                widest = axis;
            }
        }
        std::array<std::size_t, 3> finer = counts;
        ++finer[widest];
        if (finer[0] * finer[1] * finer[2] > most) return counts;
        counts = finer;
    }
}

bool is_better(const SuggestPoint& a, const SuggestPoint& b) {
    return a.allowed != b.allowed ? a.allowed : a.value > b.value;
}

/// The map from the camera's frame to that of a lamp; exactly the identity for a lamp that is fixed
/// to the camera.
Affine lamp_from_camera(const LampDesc& lamp, const Affine& world_from_camera) {
    if (lamp.fixed_to_camera) return {};
    return lamp.world_from_mount.inverse() * world_from_camera;
}

/// `other` at the place and in the direction that `lamp` has behind a mirror in the plane x = 0 of
/// the camera.
LampDesc at_mirrored_place(LampDesc other, const LampDesc& lamp, const Affine& world_from_camera) {
    const Affine other_from_lamp = lamp_from_camera(other, world_from_camera) *
                                   Affine::scale({-1, 1, 1}) *
                                   lamp_from_camera(lamp, world_from_camera).inverse();
    other.position = other_from_lamp * lamp.position;
    other.direction = glm::normalize(other_from_lamp.apply_to_vector(lamp.direction));
    return other;
}

class Search {
  public:
    Search(TargetProbe& probe, const ImageScene& scene, const SuggestRequest& request,
           const SuggestProgress& progress)
        : probe_(probe), scene_(scene), request_(request), progress_(progress) {}

    Suggestion run() {
        const std::vector<LampDesc>& lamps = scene_.desc().lamps;
        light_ = probe_.lamps_on_target(scene_, request_.distance);
        found_.before = point(lamps[request_.lamp].position);
        const Place start = try_grid();
        refine(start);
        found_.lamp = moved_lamp(found_.best.position);
        if (request_.partner) found_.partner = moved_partner(found_.lamp);
        return std::move(found_);
    }

  private:
    LampDesc moved_lamp(const Point3& position) const {
        LampDesc lamp = scene_.desc().lamps[request_.lamp];
        lamp.position = position;
        if (request_.aim == SuggestRequest::Aim::target) {
            const Affine frame_from_camera =
                lamp_from_camera(lamp, scene_.desc().camera.world_from_camera);
            const Vector3 ray = frame_from_camera * Point3{0, 0, request_.distance} - position;
            if (glm::length(ray) > 0) lamp.direction = glm::normalize(ray);
        }
        return lamp;
    }

    LampDesc moved_partner(const LampDesc& lamp) const {
        return at_mirrored_place(scene_.desc().lamps[*request_.partner], lamp,
                                 scene_.desc().camera.world_from_camera);
    }

    /// Evaluates the objective for the light in `light_`.
    SuggestPoint point(const Point3& position) const {
        SuggestPoint result;
        result.position = position;
        result.numbers = target_numbers(light_, request_.distance,
                                        scene_.desc().water.bands_nm.size(), probe_.options());
        using Objective = SuggestRequest::Objective;
        result.value = request_.objective == Objective::contrast ? result.numbers.contrast
                       : request_.objective == Objective::irradiance
                           ? result.numbers.irradiance
                           : result.numbers.signal_to_backscatter;
        return result;
    }

    SuggestPoint try_place(const Place& place) {
        const LampDesc lamp = moved_lamp(position_at(request_, place));
        light_[request_.lamp] = probe_.lamp_on_target(scene_, lamp, request_.distance);
        if (request_.partner)
            light_[*request_.partner] =
                probe_.lamp_on_target(scene_, moved_partner(lamp), request_.distance);
        SuggestPoint result = point(lamp.position);
        result.allowed =
            result.numbers.irradiance >= request_.min_light * found_.before.numbers.irradiance;
        ++found_.tried;
        return result;
    }

    void tell() const {
        if (progress_) progress_(found_);
        throw_if_stopped();
    }

    /// Returns where the best of the grid is.
    Place try_grid() {
        found_.counts = grid_counts(axis_lengths(request_), request_.samples * 2 / 3);
        Place best{};
        const auto [nx, ny, nz] = found_.counts;
        for (std::size_t i = 0; i < nx * ny * nz; ++i) {
            const std::array<std::size_t, 3> index{i % nx, i / nx % ny, i / (nx * ny)};
            Place place{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (found_.counts[axis] > 1)
                    place[axis] = static_cast<double>(index[axis]) /
                                  static_cast<double>(found_.counts[axis] - 1);
            found_.map.push_back(try_place(place));
            if (i == 0 || is_better(found_.map.back(), found_.best)) {
                found_.best = found_.map.back();
                best = place;
            }
            tell();
        }
        return best;
    }

    void refine(Place best) {
        const std::array<double, 3> lengths = axis_lengths(request_);
        Place step{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (found_.counts[axis] > 1)
                step[axis] = 0.5 / static_cast<double>(found_.counts[axis] - 1);
        const auto is_fine = [&] {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (step[axis] * lengths[axis] >= k_finest_step) return false;
            return true;
        };
        while (!is_fine()) {
            bool has_moved = false;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const double side : {-1.0, 1.0}) {
                    Place place = best;
                    place[axis] = std::clamp(place[axis] + side * step[axis], 0.0, 1.0);
                    if (place == best) continue;
                    if (found_.tried >= request_.samples) return;
                    const SuggestPoint tried = try_place(place);
                    if (is_better(tried, found_.best)) {
                        found_.best = tried;
                        best = place;
                        has_moved = true;
                    }
                    tell();
                }
            }
            if (!has_moved)
                for (double& length : step) length *= 0.5;
        }
    }

    TargetProbe& probe_;
    const ImageScene& scene_;
    const SuggestRequest& request_;
    const SuggestProgress& progress_;
    std::vector<LampOnTarget> light_;  // of all lamps, as they are being tried
    Suggestion found_;
};

}  // namespace

void check_suggest_request(const SuggestRequest& request, const std::vector<LampDesc>& lamps) {
    const auto check = [](bool is_valid, const std::string& what) {
        if (!is_valid) throw UsageError("suggest: " + what);
    };
    check(request.lamp < lamps.size(), "there is no such lamp");
    check(!request.partner || (*request.partner < lamps.size() && *request.partner != request.lamp),
          "the partner must be another lamp of the scene");
    const auto has_place = [&](std::size_t lamp) {
        return !lamps[lamp].sun && !lamps[lamp].is_of_scene();
    };
    check(has_place(request.lamp) && (!request.partner || has_place(*request.partner)),
          "a sun, the sky and the light of a volume have no place to search for");
    const Vector3 diagonal = request.to - request.from;
    check(std::isfinite(glm::length(diagonal)) && glm::length(diagonal) > 0,
          "give two different positions to search between");
    check(request.distance > 0 && std::isfinite(request.distance),
          "the target's distance must be greater than 0");
    check(request.samples >= 12 && request.samples <= 10000, "samples must be from 12 to 10000");
    check(request.min_light >= 0 && std::isfinite(request.min_light),
          "the least light must not be negative");
}

LampDesc mirrored_lamp(const LampDesc& lamp, const Affine& world_from_camera) {
    return at_mirrored_place(lamp, lamp, world_from_camera);
}

Suggestion suggest_position(TargetProbe& probe, const ImageScene& scene,
                            const SuggestRequest& request, const SuggestProgress& progress) {
    check_suggest_request(request, scene.desc().lamps);
    return Search(probe, scene, request, progress).run();
}

}  // namespace uw
