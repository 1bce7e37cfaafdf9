#include "core/lamps/lamp_extent.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/lamps/lamp_placement.h"

namespace uw {

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

}  // namespace

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
    const LampPlacement placement{desc.world_from_frame(world_from_camera), desc.direction};
    const double turn = glm::radians(desc.extent->rotate);
    const Vector3 across = placement.across(), up = glm::cross(-placement.direction, across);
    const auto in_world = [&](const Vector3& v) {
        return placement.world_from_frame.apply_to_vector(v);
    };
    const Vector3 x = in_world(std::cos(turn) * across + std::sin(turn) * up);
    const Vector3 y = in_world(std::cos(turn) * up - std::sin(turn) * across);
    const int count = std::max(1, desc.extent->samples / thinning);
    for (const PlanePoint& point : fill(*desc.extent, count))
        emitters.push_back(
            lamp.emitter(index, lamp.position() + point.x * x + point.y * y, 1.0 / count));
}

}  // namespace uw
