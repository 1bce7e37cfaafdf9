#include "core/surfaces/triangle_overlap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace uw {

namespace {

constexpr std::uint64_t k_most_samples = 1 << 16;
// Of a cube's face. A lawn of 10^5 blades of grass to a square metre comes to a hundredth of it.
constexpr double k_most_coverage = 4096;
// From fewer of its triangles, little is known of a cube.
constexpr std::size_t k_least_samples = 64;

struct Sample {
    std::uint64_t cube = 0;  // hashed
    double coverage = 0;     // of the cube's face
    std::uint32_t mesh = 0;  // SceneObjects::placed
    std::uint32_t triangle = 0;
};

using Corners = std::array<Point3, 3>;

Corners corners_of(const PlacedMesh& mesh, std::uint32_t triangle) {
    return {mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2)};
}

/// Its middle, in the cube of up to twice its size.
Sample sample_of(const Corners& corners) {
    Bounds bounds;
    for (const Point3& corner : corners) bounds.extend(corner);
    const Vector3 size = bounds.max - bounds.min;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0)) return {};
    const int level = std::ilogb(longest) + 1;
    const double edge = std::ldexp(1.0, level);
    const Point3 center = bounds.center();
    auto cube = static_cast<std::uint64_t>(level);
    for (int axis = 0; axis < 3; ++axis) {
        constexpr std::uint64_t k_odd = 0x9e3779b97f4a7c15;
        const double place = std::floor(center[axis] / edge) + 0.0;  // not -0
        cube = std::rotl((cube ^ std::bit_cast<std::uint64_t>(place)) * k_odd, 29);
    }
    const double area =
        0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return {cube, area / (edge * edge), 0, 0};
}

/// Of one of `stride` triangles each, not always the same one: objects repeat.
std::vector<Sample> samples_of(const SceneObjects& objects, std::uint64_t stride) {
    std::vector<Sample> samples;
    samples.reserve(k_most_samples);
    const auto next = [&] {
        constexpr double k_golden = 0.6180339887498949;
        const double turns = static_cast<double>(samples.size()) * k_golden;
        const auto offset =
            static_cast<std::uint64_t>((turns - std::floor(turns)) * static_cast<double>(stride));
        return samples.size() * stride + offset;
    };
    std::uint64_t begin = 0;  // how many triangles are before those of the mesh
    for (std::size_t number = 0; number < objects.placed_count(); ++number) {
        const PlacedMesh mesh = objects.placed(number);
        const std::uint64_t end = begin + mesh.object.mesh.triangle_count();
        while (next() < end) {
            const auto triangle = static_cast<std::uint32_t>(next() - begin);
            Sample sample = sample_of(corners_of(mesh, triangle));
            sample.mesh = static_cast<std::uint32_t>(number);
            sample.triangle = triangle;
            samples.push_back(sample);
        }
        begin = end;
    }
    return samples;
}

}  // namespace

std::optional<TriangleOverlap> find_overlap(const SceneObjects& objects) {
    std::uint64_t triangles = 0;
    for (std::size_t number = 0; number < objects.placed_count(); ++number)
        triangles += objects.placed(number).object.mesh.triangle_count();
    if (static_cast<double>(triangles) < k_most_coverage) return std::nullopt;
    const std::uint64_t stride = triangles / k_most_samples + 1;
    std::vector<Sample> samples = samples_of(objects, stride);
    std::ranges::sort(samples, {}, &Sample::cube);
    for (auto begin = samples.begin(); begin != samples.end();) {
        double coverage = 0;
        auto end = begin;
        for (; end != samples.end() && end->cube == begin->cube; ++end) coverage += end->coverage;
        const auto count = static_cast<std::size_t>(end - begin);
        if (count >= k_least_samples && coverage * static_cast<double>(stride) > k_most_coverage) {
            const PlacedMesh mesh = objects.placed(begin->mesh);
            return TriangleOverlap{static_cast<double>(count * stride),
                                   mesh.corner(begin->triangle, 0),
                                   mesh.object_id(begin->triangle)};
        }
        begin = end;
    }
    return std::nullopt;
}

}  // namespace uw
