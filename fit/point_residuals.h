#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/base/csv_table.h"
#include "core/scene/trajectory.h"
#include "fit/robust_fit.h"
#include "fit/unknowns.h"

namespace uw {

/// Points of boards and other rigid things, and where photographs show them.

/// The medium in which the camera imaged a point: the scene's water; air, behind the same port; or
/// air without a port.
enum class SeenThrough : std::uint8_t { water, air, bare };

struct PhotographedPoint {
    std::size_t image = 0;  // in the order in which they first appear
    Point3 point;           // in axes that all points of the image share [m]
    ImagePoint seen;        // corner of the image (0, 0) [pixels]
    SeenThrough through = SeenThrough::water;
};

struct PointTable {
    std::vector<std::string> images;  // their names in the table
    std::vector<PhotographedPoint> points;
};

/// The pose of a camera in the axes of an image's points, with standard errors.
struct FoundPose {
    Affine world_from_camera;
    Vector3 position_error{};  // along these axes [m]
    Vector3 turn_error{};      // about the camera's own axes [degrees]
};

/// Reads a table with the columns image, x, y, z, u, v and perhaps medium (water, air, bare).
/// Throws InputError for other tables, for points that are not finite, and for images with fewer
/// than four.
PointTable read_seen_points(const CsvTable& table);

/// Reprojection errors: a scene's camera images points at a distance from where they were observed,
/// a group of two residuals for each [pixels over the deviation]. The objects of each image have
/// their own pose, a block.
class PointResiduals final : public Observations {
  public:
    /// `unknowns` outlive it. Throws InputError for an image whose points the camera cannot see
    /// where they are, as the scene is.
    PointResiduals(const SceneUnknowns& unknowns, PointTable seen);

    bool prepare(std::span<const double> shared, bool with_derivatives) override;
    bool evaluate(std::size_t group, const Block* block, double* residuals, double* by_shared,
                  double* by_block) const override;

    std::vector<ResidualGroup> groups() const override;
    std::size_t block_count() const override { return poses_.size(); }

    /// The poses of the camera in the axes of each image's points, world_from_camera, with these
    /// blocks.
    std::vector<Affine> poses(std::span<const Block> blocks) const;

    /// The same with their standard errors.
    std::vector<FoundPose> found_poses(const FitResult& result) const;

    /// Doubts about a table that looks odd: questions on what may have been meant, each a sentence
    /// with a hint. `options`: of the fit that came to `result`.
    std::vector<std::string> questions(const FitResult& result, const FitOptions& options) const;

    const std::vector<std::string>& images() const override { return seen_.images; }
    Place place(std::size_t group) const override {
        return {seen_.points[group].image, seen_.points[group].seen};
    }
    const char* noun() const override { return "point"; }
    const char* unit() const override { return "px"; }
    /// The length of a vector with two coordinates like that.
    double of_group(double rms) const override { return std::numbers::sqrt2 * rms; }

  private:
    /// A camera in what it was in, as far as the points need it.
    using Cameras = std::array<std::optional<Camera>, 3>;
    std::vector<double> start() const;  // the unknowns'
    Cameras cameras_of(std::span<const double> values) const;
    Pose start_pose(std::size_t image) const;

    const SceneUnknowns& unknowns_;
    PointTable seen_;
    std::array<bool, 3> is_used_{};
    std::vector<Point3> centres_;  // of each image's points
    std::vector<Pose> poses_;      // camera_from_body where the fit began, about the centres
    Cameras cameras_;
    std::vector<std::array<Cameras, 2>> moved_;  // by a step back and ahead, per unknown
    std::vector<double> steps_;                  // from the one to the other
};

}  // namespace uw
