#include "render/snow/snow_pass.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.h"

namespace uw {

namespace {

const TrajectoryDesc* trajectory_of(const SceneDesc& scene) {
    if (scene.rig_trajectory) return &*scene.rig_trajectory;
    return scene.camera.trajectory ? &*scene.camera.trajectory : nullptr;
}

/// Moves a pose as the trajectory moves between the times `from` and `to`.
Affine moved(const Trajectory& trajectory, double from, double to, const Affine& pose) {
    return trajectory.at(to).affine() * trajectory.at(from).affine().inverse() * pose;
}

}  // namespace

std::vector<ExposureView> exposure_views(const SceneDesc& scene, double middle) {
    std::vector<ExposureView> views{{Camera(scene.camera), 0, {}}};
    const double half = 0.5 * scene.render.shutter;
    if (!(half > 0)) return views;
    const TrajectoryDesc* trajectory = trajectory_of(scene);
    for (const double offset : {-half, half}) {
        CameraDesc camera = scene.camera;
        if (trajectory != nullptr) {
            const Trajectory& path = *trajectory->trajectory;
            const double time = middle + offset;
            if (time < path.first_time() || time > path.last_time()) continue;
            camera.world_from_camera = moved(path, middle, time, camera.world_from_camera);
        }
        views.push_back({Camera(camera), offset,
                         scene.camera.world_from_camera * camera.world_from_camera.inverse()});
    }
    return views;
}

namespace {

// Intervals between rays along each edge of the image, and in rows between. The edge of a distorted
// image deviates from straight lines between the rays by less than (angle between them)^2 / 8 of
// the distance.
constexpr int k_hull_steps = 48;
constexpr double k_bulge = 1e-3;

/// Appends the rays of an image position through the centre of the aperture and around its rim.
void append_rays(const Camera& camera, double x, double y, std::vector<Ray>& rays) {
    if (const auto ray = camera.refracted_ray(x, y)) rays.push_back(*ray);
    if (!camera.has_aperture()) return;
    // The rim is represented by the octagon around it.
    constexpr double k_around = 1.0824;  // 1 / cos 22.5 degrees
    for (int i = 0; i < 8; ++i) {
        const double angle = i * 0.7853981633974483;
        const auto ray =
            camera.aperture_ray(x, y, {k_around * std::cos(angle), k_around * std::sin(angle)});
        if (ray) rays.push_back(*ray);
    }
}

/// Returns outward normals of a pyramid through the corners of the view. Whatever their directions,
/// planes across them can bound all that is visible.
std::vector<Vector3> side_normals(const Camera& camera) {
    const double width = camera.width(), height = camera.height();
    const std::array<std::optional<Ray>, 4> corners{
        camera.refracted_ray(0, 0), camera.refracted_ray(width, 0),
        camera.refracted_ray(width, height), camera.refracted_ray(0, height)};
    const auto axis = camera.refracted_ray(0.5 * width, 0.5 * height);
    std::vector<Vector3> normals;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if (!a || !b || !axis) continue;
        const Vector3 across = glm::cross(a->direction, b->direction);
        if (glm::length(across) < 1e-9) continue;
        const double side = glm::dot(across, axis->direction) > 0 ? -1 : 1;
        normals.push_back(side / glm::length(across) * across);
    }
    if (axis) normals.push_back(axis->direction);
    return normals;
}

}  // namespace

ViewHull::ViewHull(const std::vector<ExposureView>& views, double max_distance,
                   const Vector3& drift) {
    for (const Vector3& normal : side_normals(views.front().camera))
        planes_.push_back({normal, -1e300});
    std::vector<Ray> rays;
    for (const ExposureView& view : views) {
        rays.clear();
        for (int j = 0; j <= k_hull_steps; ++j)
            for (int i = 0; i <= k_hull_steps; ++i) {
                const bool is_edge = i == 0 || j == 0 || i == k_hull_steps || j == k_hull_steps;
                if (!is_edge && (i % 8 != 0 || j % 8 != 0)) continue;
                append_rays(view.camera,
                            static_cast<double>(i) / k_hull_steps * view.camera.width(),
                            static_cast<double>(j) / k_hull_steps * view.camera.height(), rays);
            }
        for (const Ray& ray : rays)
            for (const double s : {0.0, max_distance}) {
                const Point3 visible = ray.at(s) - view.time * drift;
                bounds_.extend(visible);
                for (Plane& plane : planes_)
                    plane.offset =
                        std::max(plane.offset, glm::dot(plane.normal, from_origin(visible)));
            }
    }
    if (bounds_.empty()) return;
    const double margin = k_bulge * max_distance;
    for (int axis = 0; axis < 3; ++axis) {
        bounds_.min[axis] -= margin;
        bounds_.max[axis] += margin;
    }
    for (Plane& plane : planes_) plane.offset += margin;
}

void SnowLighting::radiance(const Point3& x, const Ray& ray, double distance,
                            std::span<double> radiance) const {
    const std::vector<Lamp>& emitters = *scene_.emitters;
    const std::size_t constituents = scene_.medium->constituents.size();
    std::vector<double> to_camera(constituents), column(constituents);
    if (constituents > 0) scene_.field->column(ray.origin, x, to_camera);
    std::ranges::fill(radiance, 0.0);
    for (std::size_t j = 0; j < emitters.size(); ++j) {
        const Lamp& lamp = emitters[j];
        const Point3 origin = lamp.origin(x);
        const Vector3 from_lamp = x - origin;
        const double radius = glm::length(from_lamp);
        const double relative = lamp.relative_intensity(from_lamp) * lamp.focus(x);
        if (lamp.contains(radius) || relative <= 0 || scene_.surfaces->occluded(origin, x))
            continue;
        if (constituents > 0) {
            if (deep_shadows_.empty())
                scene_.field->column(origin, x, column);
            else
                deep_shadows_[j]->columns(std::span<const Point3>(&x, 1), column);
            add(column, to_camera);
        }
        const double psi = angle_between(from_lamp, -ray.direction);
        const double factor = relative / lamp.spread(radius) * LambertSphere::at(psi);
        for (std::size_t b = 0; b < radiance.size(); ++b)
            radiance[b] += factor * lamp.axis_intensity()[b] *
                           std::exp(-attenuation_.optical_depth(b, radius + distance, column));
    }
}

namespace {

/// The cells of one layer of the lattice of a class of particles.
struct CellLayer {
    std::size_t size_class;
    std::int64_t first;  // index along x
    double max_distance;
    const ViewHull* hull;
};

/// Two unit vectors that are perpendicular to a ray and to each other.
struct AcrossAxes {
    Vector3 u, v;

    explicit AcrossAxes(const Vector3& direction) {
        const Vector3 other = std::abs(direction.x) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
        u = glm::normalize(glm::cross(direction, other));
        v = glm::cross(direction, u);
    }
};

/// Returns the offset from `x` of the intersection of a ray with the plane through `x` that is
/// perpendicular to `direction`.
Vector3 offset_in_plane(const Ray& ray, const Point3& x, const Vector3& direction) {
    const double s = glm::dot(x - ray.origin, direction) / glm::dot(ray.direction, direction);
    return ray.at(s) - x;
}

/// Returns the map from pixels to metres in that plane; none if the image has no neighbouring rays.
std::optional<PlaneMap> plane_from_pixels(const Camera& camera, const ImagePoint& at,
                                          const Ray& ray, const Point3& x, const AcrossAxes& axes) {
    constexpr double k_delta = 0.5;  // pixels
    const auto moved = [&](double dx, double dy) -> std::optional<std::array<double, 2>> {
        for (const double sign : {1.0, -1.0}) {
            const auto neighbour = camera.refracted_ray(at.x + sign * dx, at.y + sign * dy);
            if (!neighbour) continue;
            const Vector3 offset = sign / k_delta * offset_in_plane(*neighbour, x, ray.direction);
            return std::array<double, 2>{glm::dot(offset, axes.u), glm::dot(offset, axes.v)};
        }
        return std::nullopt;
    };
    const auto right = moved(k_delta, 0), down = moved(0, k_delta);
    if (!right || !down) return std::nullopt;
    const PlaneMap map{(*right)[0], (*right)[1], (*down)[0], (*down)[1]};
    if (!(std::abs(map.determinant()) > 0)) return std::nullopt;
    return map;
}

/// Returns the map from points of the aperture to the positions at which an image out of focus
/// shows `x`.
PlaneMap blur_of(const Camera& camera, const ImagePoint& at, const Ray& ray, const Point3& x,
                 const AcrossAxes& axes, const PlaneMap& pixels_from_plane) {
    if (!camera.has_aperture()) return {};
    PlaneMap plane_from_aperture;
    if (const auto side = camera.aperture_ray(at.x, at.y, {1, 0})) {
        const Vector3 offset = offset_in_plane(*side, x, ray.direction);
        plane_from_aperture.xx = glm::dot(offset, axes.u);
        plane_from_aperture.yx = glm::dot(offset, axes.v);
    }
    if (const auto side = camera.aperture_ray(at.x, at.y, {0, 1})) {
        const Vector3 offset = offset_in_plane(*side, x, ray.direction);
        plane_from_aperture.xy = glm::dot(offset, axes.u);
        plane_from_aperture.yy = glm::dot(offset, axes.v);
    }
    return pixels_from_plane * plane_from_aperture;
}

/// Returns the path in the image of a point that is at `x` in the middle of the exposure.
Footprint::Path path_of(const std::vector<ExposureView>& views, const ImagePoint& at,
                        const Point3& x, const Vector3& drift, const AcrossAxes& axes,
                        const PlaneMap& pixels_from_plane) {
    // Paths shorter than this [pixels] are taken to be straight.
    constexpr double k_short = 2;
    Footprint::Path path{{at.x, at.y}, {}, {}};
    // Displacements from the middle to the times when the shutter opens and closes. If one of them
    // is unknown, it is the mirror image of the other.
    std::optional<std::array<double, 2>> before, after;
    for (std::size_t i = 1; i < views.size(); ++i) {
        // The position at which the camera in the middle sees what this camera sees.
        const Point3 there = views[i].middle_from_moment * (x + views[i].time * drift);
        const Vector3 moved = there - x;
        const double u = glm::dot(moved, axes.u), v = glm::dot(moved, axes.v);
        std::array<double, 2> step{pixels_from_plane.xx * u + pixels_from_plane.xy * v,
                                   pixels_from_plane.yx * u + pixels_from_plane.yy * v};
        if (std::hypot(step[0], step[1]) > k_short) {
            const auto image = views.front().camera.project(there);
            if (!image) continue;
            step = {image->x - at.x, image->y - at.y};
        }
        (views[i].time < 0 ? before : after) = step;
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double last = after ? (*after)[axis] : (before ? -(*before)[axis] : 0);
        const double first = before ? (*before)[axis] : -last;
        path.linear[axis] = 0.5 * (last - first);
        path.quadratic[axis] = 0.5 * (last + first);
    }
    return path;
}

/// Appends the splat of a particle, if it touches the window.
void place(const SnowPlacing& scene, const SnowParticle& particle, double range,
           const PixelWindow& window, SnowSplats& result) {
    const Camera& camera = scene.views.front().camera;
    const Point3& x = particle.position;
    const auto sight = camera.sight(x);
    if (!sight) return;
    const ImagePoint& at = sight->image;
    const Ray& ray = sight->ray;
    const double distance = uw::distance(ray.origin, x);
    if (distance > range || distance <= 0.5 * particle.diameter) return;
    // Most particles that are not drawn are hidden or outside the window: test first what rejects
    // sooner.
    const bool is_within =
        at.x >= window.x0 && at.x < window.x1 && at.y >= window.y0 && at.y < window.y1;
    const auto end_of_sight = [&] {
        return scene.surfaces.empty() ? k_infinitely_far : scene.surfaces.hit_distance(ray);
    };
    double end = is_within ? end_of_sight() : k_infinitely_far;
    if (end <= distance) return;
    const AcrossAxes axes(ray.direction);
    const auto plane = plane_from_pixels(camera, at, ray, x, axes);
    if (!plane) return;
    const PlaneMap pixels = plane->inverse();
    const Footprint footprint(path_of(scene.views, at, x, scene.desc.drift, axes, pixels),
                              0.5 * particle.diameter * pixels,
                              blur_of(camera, at, ray, x, axes, pixels));
    const PixelWindow visible = intersection(footprint.bounds(), window);
    if (visible.width() <= 0 || visible.height() <= 0) return;
    if (!is_within) end = end_of_sight();
    if (end <= distance) return;
    const std::size_t bands = scene.desc.reflectance.size();
    Spectrum radiance;
    scene.lighting.radiance(x, ray, distance, radiance.first(bands));
    // The coefficients include the attenuation by the particles in front of this one, which are
    // also drawn over it: undo the former.
    const double factor =
        std::exp(scene.model.drawn_depth(distance)) * scene.sensor.surface_factor(distance);
    const auto first = static_cast<std::uint32_t>(result.radiance.size());
    for (std::size_t b = 0; b < bands; ++b)
        result.radiance.push_back(
            static_cast<float>(radiance[b] * scene.desc.reflectance[b] * factor));
    result.splats.push_back(
        {.distance = distance,
         .id = particle.id,
         .hidden = static_cast<float>(scene.veil.fraction_beyond(at.x, at.y, distance, end)),
         .radiance = first,
         .footprint = footprint});
}

std::int64_t cell_of(double position, double edge) {
    return static_cast<std::int64_t>(std::floor(position / edge));
}

/// Places the particles of a class in one layer of cells.
void place_layer(const SnowPlacing& scene, const CellLayer& layer, const PixelWindow& window,
                 SnowSplats& result) {
    const SnowClass& size_class = scene.model.field.classes()[layer.size_class];
    const Vector3 moved = scene.model.field.displacement(scene.time);
    const Bounds& bounds = layer.hull->bounds();
    const double margin = 0.5 * size_class.greatest;
    const double around_cell = 0.5 * std::sqrt(3.0) * size_class.edge + margin;
    std::array<std::int64_t, 2> first{}, last{};
    for (int axis = 1; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis - 1);
        first[i] = cell_of(bounds.min[axis] - margin - moved[axis], size_class.edge);
        last[i] = cell_of(bounds.max[axis] + margin - moved[axis], size_class.edge);
    }
    std::vector<SnowParticle> particles;
    for (std::int64_t j = first[0]; j <= last[0]; ++j)
        for (std::int64_t k = first[1]; k <= last[1]; ++k) {
            const SnowCell cell{layer.first, j, k};
            Point3 centre;
            for (int axis = 0; axis < 3; ++axis)
                centre[axis] = (static_cast<double>(cell[static_cast<std::size_t>(axis)]) + 0.5) *
                                   size_class.edge +
                               moved[axis];
            if (!layer.hull->may_see(centre, around_cell)) continue;
            particles.clear();
            scene.model.field.append_particles(layer.size_class, cell, scene.time, particles);
            for (const SnowParticle& particle : particles)
                if (layer.hull->may_see(particle.position, margin))
                    place(scene, particle, layer.max_distance, window, result);
        }
}

}  // namespace

SnowSplats SnowPlacing::splats(const PixelWindow& window, const ProgressCallback& progress) const {
    std::vector<ViewHull> hulls;
    std::vector<CellLayer> layers;
    hulls.reserve(model.ranges.size());
    for (std::size_t k = 0; k < model.ranges.size(); ++k) {
        const SnowClass& size_class = model.field.classes()[k];
        const ViewHull& hull = hulls.emplace_back(views, model.ranges[k], desc.drift);
        if (hull.bounds().empty()) continue;
        const double margin = 0.5 * size_class.greatest + model.field.displacement(time).x;
        const double other = 0.5 * size_class.greatest - model.field.displacement(time).x;
        const std::int64_t first = cell_of(hull.bounds().min.x - margin, size_class.edge);
        const std::int64_t last = cell_of(hull.bounds().max.x + other, size_class.edge);
        for (std::int64_t i = first; i <= last; ++i)
            layers.push_back({k, i, model.ranges[k], &hull});
    }
    std::vector<SnowSplats> parts(layers.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(layers.size(), [&](std::size_t i) {
        place_layer(*this, layers[i], window, parts[i]);
        progress(static_cast<double>(++done) / static_cast<double>(layers.size()));
    });
    SnowSplats all;
    for (SnowSplats& part : parts) {
        all.append(part);
        part = {};
    }
    return all;
}

namespace {

/// Sets the ground truth of a pixel to that of a particle at this distance along its ray: a disk
/// that faces the camera, whose id follows those of all objects.
void set_ground_truth(double distance, const Ray& ray, const PixelRenderer& pixels,
                      PixelResult& result) {
    result.has_hit = true;
    result.hit = {};
    result.hit.distance = distance;
    result.hit.position = ray.at(distance);
    result.hit.normal = result.hit.geometric_normal = -ray.direction;
    result.hit.object_id =
        static_cast<std::uint32_t>(pixels.scene().surfaces->names().objects.size()) + 1;
    const Point3 in_camera = pixels.rays().world_from_camera().inverse() * result.hit.position;
    result.depth_z = in_camera.z;
    result.range = glm::length(from_origin(in_camera));
    result.path = distance;
}

}  // namespace

void SnowPass::provide(LayerSupply& supply) const {
    supply.layers |= {Layer::snow};
}

void SnowPass::begin(Rendering& rendering) {
    layer_.reset();
    rendering.steps.emplace_back([this, &rendering](const RenderedPixel& pixel) {
        if (pixel.view.ray) add_to(pixel, rendering.pixels);
    });
}

void SnowPass::run(Rendering& rendering) {
    const SnowModel& model = *rendering.snow;
    const SceneDesc& desc = rendering.desc;
    const auto depth = [&model](double distance) { return model.drawn_depth(distance); };
    const PixelRenderer& pixels = rendering.pixels;
    WaterVeil veil(pixels.rays(), *pixels.transport().integrator, depth);
    const SnowLighting lighting(pixels.scene(), rendering.light);
    const std::vector<ExposureView> views = exposure_views(desc, rendering.time);
    const SensorModel sensor(desc);
    const SnowPlacing placing{.model = model,
                              .desc = *desc.water.snow,
                              .time = rendering.time,
                              .views = views,
                              .surfaces = *pixels.scene().surfaces,
                              .lighting = lighting,
                              .veil = veil,
                              .sensor = sensor};
    const PixelWindow& window = rendering.film.window();
    const SnowSplats splats = placing.splats(window, rendering.progress_of(*stage()));
    rendering.reached.snow_particles = splats.splats.size();
    layer_.emplace(SnowImage(window, model.water.wavelengths_nm.size(), splats), std::move(veil),
                   depth);
}

void SnowPass::add_to(const RenderedPixel& pixel, const PixelRenderer& pixels) const {
    const PixelView& view = pixel.view;
    PixelResult& result = pixel.result;
    const double end = view.has_hit ? view.path : view.distances.back();
    // Lamps in view are attenuated by the mean of all particles only.
    const Spectrum surface = result.direct - result.lamps_in_view + result.multiple_surface;
    result.snow = layer_->radiance(pixel.x, pixel.y, end, surface,
                                   result.backscatter + result.multiple_volume);
    const double distance = layer_->particle_distance(pixel.x, pixel.y);
    if (in_ground_truth_ && distance > 0) set_ground_truth(distance, *view.ray, pixels, result);
}

}  // namespace uw
