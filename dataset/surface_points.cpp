#include "dataset/surface_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/image/pixel_image.h"
#include "render/image_scene.h"
#include "render/view_matcher.h"

namespace uw {

namespace {

constexpr const char* k_point_columns = "x,y,z";

}  // namespace

std::string points_file(const DatasetDefinition& definition, std::size_t draw) {
    return definition.folder(draw) + "views/points.csv";
}

std::string points_csv(const std::vector<Landmark>& points) {
    std::string text = fmt::format("{}\n", k_point_columns);
    for (const Landmark& point : points)
        text += fmt::format("{},{},{}\n", point.position.x, point.position.y, point.position.z);
    return text;
}

std::vector<Landmark> read_points(const std::filesystem::path& file) {
    std::ifstream in = open_own_file(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    std::string columns;
    std::getline(in, columns);
    std::vector<Landmark> points;
    Point3 p;
    char comma = 0;
    while (in >> p.x >> comma >> p.y >> comma >> p.z) points.push_back({p});
    if (columns != k_point_columns || !in.eof())
        throw InputError(fmt::format("{}: is not a table of {}", file.string(), k_point_columns));
    return points;
}

namespace {

bool is_still(const GeometryDesc& geometry) {
    return !geometry.trajectory && !geometry.animation && !geometry.is_sequence;
}

}  // namespace

ImageChoice choice_of(const DatasetDefinition& definition, const SceneDesc& scene,
                      const View& view) {
    const auto camera =
        std::ranges::find(scene.cameras, definition.cameras[view.camera], &RigCameraDesc::name);
    const bool is_of_rig = camera != scene.cameras.end();
    return {definition.frames[view.frame],
            is_of_rig ? static_cast<std::size_t>(camera - scene.cameras.begin()) : 0};
}

CameraDesc camera_of_view(const DatasetDefinition& definition, const SceneDesc& scene,
                          const View& view) {
    SceneDesc without_light = scene;  // which is not needed, and takes time to read
    without_light.volumes.clear();
    return scene_of_image(without_light, choice_of(definition, scene, view)).desc().camera;
}

std::vector<ImageSight> sights_of(const Camera& camera, int side, const Surfaces& surfaces) {
    std::vector<ImageSight> sights;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const ImagePoint pixel{(column + 0.5) / side * camera.width(),
                                   (row + 0.5) / side * camera.height()};
            const auto ray = camera.refracted_ray(pixel.x, pixel.y);
            if (!ray) continue;
            ImageSight& sight = sights.emplace_back(ImageSight{pixel, *ray, SurfaceHit{}});
            if (!surfaces.closest_hit(*ray, std::numeric_limits<double>::infinity(), *sight.hit))
                sight.hit.reset();
        }
    return sights;
}

std::vector<Landmark> point_seeds(const DatasetDefinition& definition, std::size_t draw,
                                  const SceneDesc& scene, const Surfaces& surfaces) {
    constexpr std::size_t k_max_views = 64;
    const std::size_t all = definition.frames.size() * definition.cameras.size();
    const std::size_t views = std::min(all, k_max_views);
    const auto side =
        static_cast<int>(std::sqrt(static_cast<double>(k_max_points) / static_cast<double>(views)));
    std::vector<Landmark> points;
    for (std::size_t i = 0; i < views; ++i) {
        const View view = definition.view(draw * all + i * all / views);
        const Camera camera(camera_of_view(definition, scene, view));
        for (const ImageSight& sight : sights_of(camera, side, surfaces)) {
            if (!sight.hit) continue;
            const SurfaceName& object = surfaces.names().objects[sight.hit->object_id - 1];
            if (object.entry && is_still(scene.geometry[*object.entry]))
                points.push_back({sight.hit->position});
        }
    }
    return points;
}

namespace {

constexpr const char* k_observation_columns = "point,x,y,r,g,b";

std::array<int, 3> colour_at(const ViewImages& images, const Preview& preview, double x, double y) {
    const int column = std::min(static_cast<int>(x), images.width() - 1);
    const int row = std::min(static_cast<int>(y), images.height() - 1);
    const Srgb8& rgb = preview(column, row);
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

std::vector<Observation> observations(const ViewImages& images) {
    const Camera camera(images.camera);
    const Preview preview = make_preview(images.film, images.exposures.image, images.display.get());
    std::vector<Observation> seen;
    for (std::size_t i = 0; i < images.points->size(); ++i) {
        const SeenPoint point = seen_point((*images.points)[i].position, camera, *images.surfaces);
        if (!point.visible) continue;
        seen.push_back({static_cast<std::uint32_t>(i), point.pixel.x, point.pixel.y,
                        colour_at(images, preview, point.pixel.x, point.pixel.y)});
    }
    return seen;
}

std::string observations_csv(const std::vector<Observation>& observations) {
    std::string text = fmt::format("{}\n", k_observation_columns);
    for (const Observation& o : observations)
        text += fmt::format("{},{},{},{},{},{}\n", o.point, o.x, o.y, o.rgb[0], o.rgb[1], o.rgb[2]);
    return text;
}

std::vector<Observation> read_observations(const std::filesystem::path& file) {
    std::ifstream in = open_own_file(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    std::string columns;
    std::getline(in, columns);
    std::vector<Observation> all;
    Observation o;
    char comma = 0;
    while (in >> o.point >> comma >> o.x >> comma >> o.y >> comma >> o.rgb[0] >> comma >>
           o.rgb[1] >> comma >> o.rgb[2])
        all.push_back(o);
    if (columns != k_observation_columns || !in.eof())
        throw InputError(
            fmt::format("{}: is not a table of {}", file.string(), k_observation_columns));
    return all;
}

}  // namespace uw
