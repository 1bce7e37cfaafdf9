#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/base/ray.h"
#include "core/geometry/surfaces.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"
#include "dataset/view.h"

namespace uw {

/// The file of a draw's surface points, relative to the set's folder.
std::string points_file(const DatasetDefinition& definition, std::size_t draw);

std::string points_csv(const std::vector<Landmark>& points);
/// Throws IoError, and InputError for anything but points_csv's.
std::vector<Landmark> read_points(const std::filesystem::path& file);

/// The greatest number of surface points of a draw.
inline constexpr std::size_t k_max_points = 4096;

/// The ray, and the surface hit by it, at a position of a camera's image.
struct ImageSight {
    ImagePoint pixel;
    Ray ray;                        // in the water, world space
    std::optional<SurfaceHit> hit;  // none: no surface
};

/// These at the centres of `side` times `side` equal parts of its image, where it has rays.
std::vector<ImageSight> sights_of(const Camera& camera, int side, const Surfaces& surfaces);

/// The camera of a view, with its pose, in the scene of its draw.
CameraDesc camera_of_view(const DatasetDefinition& definition, const SceneDesc& scene,
                          const View& view);

/// Points on the surfaces that never move, evenly over the images of up to 64 views of a draw, as
/// far as the surfaces of its first frame do not hide them. `scene` is the draw's, as it was read,
/// and `surfaces` are those of its first frame.
std::vector<Landmark> point_seeds(const DatasetDefinition& definition, std::size_t draw,
                                  const SceneDesc& scene, const Surfaces& surfaces);

/// The image of a view in the scene of its draw.
ImageChoice choice_of(const DatasetDefinition& definition, const SceneDesc& scene,
                      const View& view);

/// The position of one of its set's surface points in a view.
struct Observation {
    std::uint32_t point = 0;  // its place in the list of points
    double x = 0, y = 0;      // [pixels]
    std::array<int, 3> rgb{};
};

/// The points that are visible in the view: through lens and port, within the image and not hidden.
std::vector<Observation> observations(const ViewImages& images);

std::string observations_csv(const std::vector<Observation>& observations);
/// Throws IoError, and InputError for anything but observations_csv's.
std::vector<Observation> read_observations(const std::filesystem::path& file);

}  // namespace uw
