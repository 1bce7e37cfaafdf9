#include "core/scene/yaml/pose_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "core/scene/yaml/config_map.h"

namespace uw {
namespace {

constexpr double k_rigid_tolerance = 1e-6;
constexpr double k_smallest_scale = 1e-9;
/// Closer to the view direction than this angle [rad], `up` leaves the roll undefined.
constexpr double k_smallest_up_angle = 1e-6;

Affine read_rotate(const ConfigValue& value) {
    return Affine::rotation_xyz_degrees(
        value.vector("give three angles in degrees, about x, then y, then z"));
}

Affine read_look_at(ConfigMap& map, const Point3& position) {
    const Vector3 default_up(0, 1, 0);
    const ConfigValue target_value = map.require(
        "look_at", "give a point the camera looks at, rotate, or the pose as a 4x4 matrix");
    const Point3 target =
        at_origin_plus(target_value.vector("give a point the camera looks at, in metres"));
    const auto up_value = map.find("up");
    const Vector3 up = up_value
                           ? up_value->direction("give the world direction that is up in the image")
                           : default_up;

    const Vector3 to_target = target - position;
    const double distance_to_target = glm::length(to_target);
    if (!(distance_to_target > 1e-12) || !std::isfinite(distance_to_target)) {
        target_value.fail("is the camera's own position; give another point, along the view");
    }
    const Vector3 forward = to_target / distance_to_target;
    const Vector3 side = glm::cross(forward, up);
    if (glm::length(side) < k_smallest_up_angle) {
        const ConfigValue& at = up_value ? *up_value : target_value;
        at.fail(fmt::format("up [{}, {}, {}] is parallel to the view direction; give another 'up'",
                            up.x, up.y, up.z));
    }
    const Vector3 right = glm::normalize(side);
    return {Matrix3(right, glm::cross(forward, right), forward), from_origin(position)};
}

Affine read_matrix(const ConfigValue& value) {
    constexpr auto k_mend = "give world_from_camera as four rows of four numbers";
    double rows[4][4] = {};
    const std::vector<ConfigValue> row_values = value.list_of(4, k_mend);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::vector<ConfigValue> numbers = row_values[i].list_of(4, k_mend);
        for (std::size_t j = 0; j < 4; ++j) rows[i][j] = numbers[j].number(k_mend);
    }
    for (std::size_t j = 0; j < 4; ++j) {
        if (std::abs(rows[3][j] - (j == 3 ? 1.0 : 0.0)) > k_rigid_tolerance) {
            row_values[3].fail(
                "the last row must be [0, 0, 0, 1]; give the rows of the matrix, not "
                "its columns");
        }
    }
    Matrix3 linear(0.0);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) linear[j][i] = rows[i][j];
    }
    const Matrix3 product = glm::transpose(linear) * linear;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            // written so that a NaN from overflowing products fails too
            if (!(std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) <= k_rigid_tolerance)) {
                value.fail(
                    "is not rigid: its 3x3 part is not a rotation to within 1e-6; remove scale and "
                    "shear, and give more digits");
            }
        }
    }
    if (glm::determinant(linear) < 0) {
        value.fail(
            "mirrors the world (determinant -1); camera axes are x right, y down, z forward");
    }
    return {linear, Vector3(rows[0][3], rows[1][3], rows[2][3])};
}

}  // namespace

Affine read_pose_keys(ConfigMap& map, bool is_view) {
    if (const auto matrix = map.find("matrix")) {
        map.finish("a pose with 'matrix'");
        return read_matrix(*matrix);
    }
    Point3 position;
    if (const auto value = map.find("position"))
        position = at_origin_plus(value->vector("give the position in metres"));
    const auto rotate = map.find("rotate");
    if (rotate || (!is_view && !map.has("look_at"))) {
        map.finish("a pose without 'look_at', or with 'rotate',");
        const Affine moved = Affine::translation(from_origin(position));
        return rotate ? moved * read_rotate(*rotate) : moved;
    }
    return read_look_at(map, position);
}

Affine read_pose(const ConfigValue& value) {
    ConfigMap map(value, {"position", "look_at", "up", "rotate", "matrix"},
                  "write {position: [0, 0, 0], look_at: [0, 0, 1]}");
    return read_pose_keys(map, true);
}

Affine read_transform(const ConfigValue& value) {
    ConfigMap map(value, {"scale", "rotate", "translate"},
                  "write {scale: 1, rotate: [0, 0, 0], translate: [0, 0, 0]}");
    Vector3 scale(1.0);
    if (const auto entry = map.find("scale")) {
        constexpr auto k_mend = "give one factor, or one per axis, none of them 0";
        scale = entry->node().kind == ConfigNode::Kind::sequence ? entry->vector(k_mend)
                                                                 : Vector3(entry->number(k_mend));
        // smaller factors would make the map's determinant vanish
        if (glm::any(glm::lessThan(glm::abs(scale), Vector3(k_smallest_scale)))) {
            entry->fail("must not be 0 or closer to 0 than 1e-9; give one factor, or one per axis");
        }
    }
    Affine rotation;
    if (const auto entry = map.find("rotate")) rotation = read_rotate(*entry);
    Vector3 offset(0.0);
    if (const auto entry = map.find("translate")) {
        offset = entry->vector("give three lengths in metres");
    }
    return Affine::translation(offset) * rotation * Affine::scale(scale);
}

}  // namespace uw
