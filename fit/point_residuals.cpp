#include "fit/point_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr std::array<std::pair<std::string_view, SeenThrough>, 3> k_media{
    {{"water", SeenThrough::water}, {"air", SeenThrough::air}, {"bare", SeenThrough::bare}}};

constexpr std::size_t index_of(SeenThrough through) {
    return static_cast<std::size_t>(through);
}

/// The scene's camera in its own axes.
CameraDesc camera_itself(const SceneDesc& scene, SeenThrough through) {
    CameraDesc camera = scene.camera;
    camera.world_from_camera = {};
    camera.trajectory.reset();
    if (through == SeenThrough::bare) camera.port.reset();
    if (through == SeenThrough::air && camera.port)
        std::visit([](auto& port) { port.n_water = port.n_air; }, *camera.port);
    return camera;
}

std::vector<double> shared_of(const FitResult& result) {
    std::vector<double> shared;
    for (const FoundValue& found : result.values) shared.push_back(found.value);
    return shared;
}

Point3 moved(const Pose& pose, const ResidualFunction::Block& by, const Vector3& from_centre) {
    const Vector3 turned =
        rotation_by({by[0], by[1], by[2]}).matrix() * (pose.rotation.matrix() * from_centre);
    return pose.position + (turned + Vector3{by[3], by[4], by[5]});
}

}  // namespace

PointTable read_seen_points(const CsvTable& table) {
    const std::vector<std::string> names = table.text("image");
    const std::vector<double> x = table.numbers("x"), y = table.numbers("y"),
                              z = table.numbers("z"), u = table.numbers("u"),
                              v = table.numbers("v");
    std::vector<std::string> media;
    if (std::ranges::find(table.columns(), "medium") != table.columns().end())
        media = table.text("medium");
    PointTable seen;
    std::map<std::string, std::size_t> indices;
    std::vector<std::size_t> counts;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const auto [entry, is_new] = indices.emplace(names[row], seen.images.size());
        if (is_new) {
            seen.images.push_back(names[row]);
            counts.push_back(0);
        }
        PhotographedPoint point{entry->second, {x[row], y[row], z[row]}, {u[row], v[row]}};
        if (!media.empty()) {
            const auto medium = std::ranges::find(k_media, media[row],
                                                  &std::pair<std::string_view, SeenThrough>::first);
            if (medium == k_media.end())
                throw InputError(fmt::format("{}: column medium: '{}': {}", table.name(),
                                             printable(media[row]),
                                             suggestion(media[row], words_of(k_media))));
            point.through = medium->second;
        }
        ++counts[point.image];
        seen.points.push_back(point);
    }
    constexpr std::size_t k_fewest = 4;
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i] < k_fewest)
            throw InputError(fmt::format("{}: image {}: has {}, and a pose needs {}; leave it out",
                                         table.name(), printable(seen.images[i]),
                                         counted(counts[i], "point"), k_fewest));
    if (seen.points.empty())
        throw InputError(fmt::format("{}: has no points; give a row for each", table.name()));
    return seen;
}

PointResiduals::PointResiduals(const SceneUnknowns& unknowns, PointTable seen)
    : unknowns_(unknowns), seen_(std::move(seen)) {
    std::vector<Vector3> sums(seen_.images.size(), Vector3{0});
    std::vector<double> counts(seen_.images.size(), 0);
    for (const PhotographedPoint& point : seen_.points) {
        is_used_[index_of(point.through)] = true;
        sums[point.image] += from_origin(point.point);
        counts[point.image] += 1;
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        centres_.push_back(at_origin_plus(sums[i] / counts[i]));
    cameras_ = cameras_of(start());
    for (std::size_t i = 0; i < seen_.images.size(); ++i) poses_.push_back(start_pose(i));
}

std::vector<double> PointResiduals::start() const {
    std::vector<double> start;
    for (const SceneUnknown& unknown : unknowns_.all()) start.push_back(unknown.start);
    return start;
}

PointResiduals::Cameras PointResiduals::cameras_of(std::span<const double> values) const {
    const SceneDesc scene = unknowns_.scene(values);
    Cameras cameras;
    for (const auto& [name, through] : k_media)
        if (is_used_[index_of(through)])
            cameras[index_of(through)].emplace(camera_itself(scene, through));
    return cameras;
}

Pose PointResiduals::start_pose(std::size_t image) const {
    // Approximates the camera by a pinhole with the directions of the rays in the water, whose
    // origins are closer together than the distance of the points.
    SeenPoints pinhole;
    for (const PhotographedPoint& point : seen_.points) {
        if (point.image != image) continue;
        const Camera& camera = *cameras_[index_of(point.through)];
        const std::optional<Ray> ray = camera.refracted_ray(point.seen.x, point.seen.y);
        constexpr double k_min_forward = 0.05;
        if (!ray || ray->direction.z < k_min_forward) continue;
        const Vector3 from_centre = point.point - centres_[image];
        pinhole.points.push_back({from_centre.x, from_centre.y, from_centre.z});
        pinhole.images.push_back(
            {ray->direction.x / ray->direction.z, ray->direction.y / ray->direction.z});
    }
    for (const RigidMatrix& found : poses_from_points(pinhole)) {
        Matrix3 rotation{};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                rotation[column][row] = found[static_cast<std::size_t>(3 * row + column)];
        const Pose pose{{found[9], found[10], found[11]}, rotation_of(rotation)};
        const bool is_visible =
            std::ranges::all_of(seen_.points, [&](const PhotographedPoint& point) {
                return point.image != image ||
                       cameras_[index_of(point.through)]
                           ->project(moved(pose, {}, point.point - centres_[image]))
                           .has_value();
            });
        if (is_visible) return pose;
    }
    const CameraDesc camera = unknowns_.scene(start()).camera;
    bool is_swapped = false, is_within = true;
    for (const PhotographedPoint& point : seen_.points) {
        is_swapped = is_swapped || point.seen.x > camera.width || point.seen.y > camera.height;
        is_within = is_within && point.seen.y <= camera.width && point.seen.x <= camera.height;
    }
    throw InputError(fmt::format(
        "image {}: no pose was found from which the scene's camera sees its points where they "
        "are; {}",
        printable(seen_.images[image]),
        is_swapped && is_within
            ? "some lie beyond the image's edge: are u and v swapped? u counts to the right, v down"
            : "check the columns (x, y and z are metres, u counts to the right, v down), and that "
              "the scene's lens and port are about right"));
}

bool PointResiduals::prepare(std::span<const double> shared, bool with_derivatives) {
    throw_if_stopped();
    try {
        cameras_ = cameras_of(shared);
        moved_.clear();
        steps_.clear();
        if (!with_derivatives) return true;
        // Central differences of rays that are exact to 1e-9 pixels: errors of the second order in
        // 1e-4, which is 1e-8.
        constexpr double k_step = 1e-4;
        std::vector<double> values(shared.begin(), shared.end());
        for (std::size_t i = 0; i < values.size(); ++i) {
            const SceneUnknown& unknown = unknowns_.all()[i];
            const double step = k_step * unknown.scale;
            const double back = std::max(shared[i] - step, unknown.lower);
            const double ahead = std::min(shared[i] + step, unknown.upper);
            std::array<Cameras, 2>& pair = moved_.emplace_back();
            values[i] = back;
            pair[0] = cameras_of(values);
            values[i] = ahead;
            pair[1] = cameras_of(values);
            values[i] = shared[i];
            steps_.push_back(ahead - back);
        }
        return true;
    } catch (const InputError&) {
        return false;  // no such scene: the solver takes a smaller step
    }
}

bool PointResiduals::evaluate(std::size_t group, const Block* block, double* residuals,
                              double* by_shared, double* by_block) const {
    const PhotographedPoint& point = seen_.points[group];
    const std::size_t medium = index_of(point.through);
    const Pose& pose = poses_[point.image];
    const Vector3 from_centre = point.point - centres_[point.image];
    const Point3 here = moved(pose, *block, from_centre);
    const std::optional<ImagePoint> seen = cameras_[medium]->project(here);
    if (!seen) return false;
    residuals[0] = (seen->x - point.seen.x) / deviation();
    residuals[1] = (seen->y - point.seen.y) / deviation();
    const auto set = [&](double* rows, std::size_t width, std::size_t column,
                         const std::optional<ImagePoint>& back,
                         const std::optional<ImagePoint>& ahead, double step) {
        if (!back || !ahead) return false;
        rows[column] = (ahead->x - back->x) / (step * deviation());
        rows[width + column] = (ahead->y - back->y) / (step * deviation());
        return true;
    };
    if (by_shared != nullptr)
        for (std::size_t i = 0; i < moved_.size(); ++i)
            if (!set(by_shared, moved_.size(), i, moved_[i][0][medium]->project(here),
                     moved_[i][1][medium]->project(here), steps_[i]))
                return false;
    if (by_block == nullptr) return true;
    const double step = 1e-5 * glm::length(from_origin(here));  // [m]; of angles [rad], likewise
    for (std::size_t i = 0; i < k_block_size; ++i) {
        Block back = *block, ahead = *block;
        const double part = i < 3 ? 1e-5 : step;
        back[i] -= part;
        ahead[i] += part;
        if (!set(by_block, k_block_size, i,
                 cameras_[medium]->project(moved(pose, back, from_centre)),
                 cameras_[medium]->project(moved(pose, ahead, from_centre)), 2 * part))
            return false;
    }
    return true;
}

std::vector<Affine> PointResiduals::poses(std::span<const Block> blocks) const {
    std::vector<Affine> found;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
        const auto in_camera = [&](const Vector3& point) {
            return from_origin(moved(poses_[i], blocks[i], point - from_origin(centres_[i])));
        };
        const Vector3 origin = in_camera(Vector3(0.0));
        Matrix3 axes(1.0);
        for (int axis = 0; axis < 3; ++axis) axes[axis] = in_camera(Matrix3(1.0)[axis]) - origin;
        found.push_back(Affine(axes, origin).inverse());
    }
    return found;
}

std::vector<FoundPose> PointResiduals::found_poses(const FitResult& result) const {
    constexpr double k_step = 1e-6;  // [m] and [rad]
    std::vector<FoundPose> found;
    for (const Affine& pose : poses(result.blocks)) found.push_back({pose});
    // Derivatives by the blocks, for all images at once, as each block moves only its own image.
    std::vector<std::array<Vector3, k_block_size>> positions(found.size()), turns(found.size());
    for (std::size_t k = 0; k < k_block_size; ++k) {
        std::vector<Block> back = result.blocks, ahead = back;
        for (std::size_t i = 0; i < found.size(); ++i) {
            back[i][k] -= k_step;
            ahead[i][k] += k_step;
        }
        const std::vector<Affine> before = poses(back), after = poses(ahead);
        for (std::size_t i = 0; i < found.size(); ++i) {
            positions[i][k] = (after[i].offset() - before[i].offset()) / (2 * k_step);
            turns[i][k] = rotation_vector(
                              rotation_of(glm::transpose(before[i].linear()) * after[i].linear())) /
                          (2 * k_step * k_degree);
        }
    }
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            double position = 0, turn = 0;
            for (std::size_t j = 0; j < k_block_size; ++j)
                for (std::size_t k = 0; k < k_block_size; ++k) {
                    const double covariance = result.block_covariances[i][j * k_block_size + k];
                    position += positions[i][j][axis] * covariance * positions[i][k][axis];
                    turn += turns[i][j][axis] * covariance * turns[i][k][axis];
                }
            // For undetermined poses infinities would cancel to NaN.
            const auto error = [](double variance) {
                return variance >= 0 ? std::sqrt(variance)
                                     : std::numeric_limits<double>::infinity();
            };
            found[i].position_error[axis] = error(position);
            found[i].turn_error[axis] = error(turn);
        }
    return found;
}

std::vector<std::string> PointResiduals::questions(const FitResult& result,
                                                   const FitOptions& options) const {
    std::vector<std::string> all;
    double extent = 0;
    for (const PhotographedPoint& point : seen_.points)
        extent = std::max(extent, 2 * glm::length(point.point - centres_[point.image]));
    // Boards are between a hand and a room large.
    constexpr double k_too_small = 0.002, k_too_large = 10;
    if (extent > k_too_large)
        all.push_back(
            fmt::format("The points of an image are up to {:.3g} m apart: are they in millimetres "
                        "or centimetres? Give metres, as x, y and z or as the side of a square.",
                        extent));
    if (extent < k_too_small)
        all.push_back(fmt::format(
            "The points of an image are at most {:.3g} m apart: is that what was meant? Give "
            "metres, as x, y and z or as the side of a square.",
            extent));
    // Errors of a few pixels are usual for boards and lenses.
    constexpr double k_good = 2;
    const auto outliers = static_cast<double>(std::ranges::count(result.outliers, true));
    constexpr double k_many = 0.3;
    if (of_group(result.rms) < k_good &&
        outliers < k_many * static_cast<double>(result.outliers.size()))
        return all;
    const CameraDesc camera = unknowns_.scene(shared_of(result)).camera;
    const double width = camera.width, height = camera.height;
    struct Reading {
        const char* text;
        ImagePoint (*read)(const ImagePoint& seen, double width, double height);
    };
    constexpr std::array k_readings{
        Reading{"are u and v swapped? u counts to the right, v down",
                [](const ImagePoint& p, double, double) {
                    return ImagePoint{p.y, p.x};
                }},
        Reading{"does v count upwards? It counts down from the upper edge",
                [](const ImagePoint& p, double, double h) {
                    return ImagePoint{p.x, h - p.y};
                }},
        Reading{"does u count to the left? It counts to the right from the left edge",
                [](const ImagePoint& p, double w, double) {
                    return ImagePoint{w - p.x, p.y};
                }},
    };
    for (const Reading& reading : k_readings) {
        PointTable other = seen_;
        for (PhotographedPoint& point : other.points)
            point.seen = reading.read(point.seen, width, height);
        try {
            PointResiduals read_so(unknowns_, std::move(other));
            FitOptions quietly = options;
            quietly.progress = {};
            quietly.starts = 1;
            const FitResult found = robust_fit(read_so, unknowns_, quietly);
            constexpr double k_far_better = 0.2;
            if (found.rms_with_outliers < k_far_better * result.rms_with_outliers)
                all.push_back(
                    fmt::format("The RMS of all points is {:.3g} px, and would be {:.3g}: {}.",
                                of_group(result.rms_with_outliers),
                                of_group(found.rms_with_outliers), reading.text));
        } catch (const InputError&) {
            continue;  // it is not to be read like that
        }
    }
    return all;
}

std::vector<ResidualGroup> PointResiduals::groups() const {
    std::vector<ResidualGroup> groups;
    for (const PhotographedPoint& point : seen_.points)
        groups.push_back({2, static_cast<int>(point.image)});
    return groups;
}

}  // namespace uw
