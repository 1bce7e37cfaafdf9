#include "render/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/error.h"
#include "core/light/integrator_table.h"
#include "core/passes/pixel_layers.h"
#include "render/image_scene.h"
#include "render/mirror_image.h"
#include "render/view_matcher.h"

namespace uw {

namespace {

// The camera's motion is interpolated smoothly from k_poses poses, and linearly from a table of
// k_table_size of these. If the camera turns by a right angle, the error of the table is 1e-5 rad.
constexpr int k_poses = 33, k_table_size = 257;
// Number of times at which distances in the image are measured; in between, motion is taken to be
// straight.
constexpr int k_moments = 9;
// Image positions whose points are tracked, along each axis.
constexpr int k_positions = 32;
// Number of vertices that are tracked of a file whose objects deform.
constexpr std::size_t k_vertices = 256;
// Maximum motion in a part of the exposure [pixels], and maximum number of parts.
constexpr double k_surface_step = 0.5, k_light_step = 2, k_view_step = 4;
constexpr int k_max_parts = 64;
// Maximum motion from one moment of multiple scattering to the next, relative to the image's
// height: about twice the distance of its nodes.
constexpr double k_moment_step = 0.04;
// Samples per pixel of motion blur, as many as for that of an aperture.
constexpr int k_samples = 64;

std::vector<ImageScene> scenes_over(const ImageScene& scene, const TimeSpan& span, int count) {
    std::vector<ImageScene> scenes;
    scenes.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        scenes.push_back(scene.at(*scene.time() + span.begin + span.length() * i / (count - 1)));
    return scenes;
}

bool same_lamps(const SceneDesc& a, const SceneDesc& b) {
    return std::ranges::equal(a.lamps, b.lamps, [](const LampDesc& x, const LampDesc& y) {
        return x.position == y.position && x.direction == y.direction &&
               x.world_from_mount == y.world_from_mount;
    });
}

bool same_poses(const SceneDesc& a, const SceneDesc& b) {
    return a.camera.world_from_camera == b.camera.world_from_camera && a.geometry == b.geometry &&
           same_lamps(a, b);
}

/// Measures the length of a point's path in the image [pixels], apart from parts far outside of it.
class Track {
  public:
    void extend(const Camera& camera, const Point3& point) {
        std::optional<ImagePoint> image = camera.project(point);
        const auto is_near = [](double at, int size) { return at > -size && at < 2.0 * size; };
        if (image && !(is_near(image->x, camera.width()) && is_near(image->y, camera.height())))
            image.reset();
        if (image && last_) length_ += std::hypot(image->x - last_->x, image->y - last_->y);
        last_ = image;
    }
    double length() const { return length_; }

  private:
    std::optional<ImagePoint> last_;
    double length_ = 0;
};

/// A point that is visible to the camera, or may be.
struct TrackedPoint {
    Point3 position;
    std::uint32_t object = 0;       // id of the object on whose surface it lies; 0: in the water
    std::optional<SurfaceHit> hit;  // on a surface; none: it moves as its whole object
    std::optional<std::size_t> vertex;  // of its object's file, ObjectMotion::vertices
};

// Returns points that the image shows: on surfaces or, without one, in the water at an optical
// depth of one.
std::vector<TrackedPoint> visible_points(const AssembledScene& scene) {
    const Camera& camera = *scene.camera;
    const Medium& medium = scene.water.medium;
    const double attenuation = medium.uniform.attenuation().greatest(medium.wavelengths_nm.size());
    std::vector<TrackedPoint> points;
    for (int j = 0; j < k_positions; ++j)
        for (int i = 0; i < k_positions; ++i) {
            const auto ray = camera.refracted_ray((i + 0.5) / k_positions * camera.width(),
                                                  (j + 0.5) / k_positions * camera.height());
            SurfaceHit hit;
            if (ray && scene.surfaces->closest_hit(*ray, k_far, hit))
                points.push_back({hit.position, hit.is_water_surface ? 0 : hit.object_id, hit, {}});
            else if (ray && attenuation > 0)
                points.push_back({ray->origin + ray->direction / attenuation, 0, {}, {}});
        }
    return points;
}

// Returns the origins of objects: an object may be smaller than the spacing of the visible points.
std::vector<TrackedPoint> origins(const SceneDesc& scene, const SurfaceNames& names) {
    std::vector<TrackedPoint> points;
    for (std::size_t i = 0; i < names.objects.size(); ++i) {
        if (!names.objects[i].entry) continue;
        const GeometryDesc& entry = scene.geometry[*names.objects[i].entry];
        if (entry.type == GeometryDesc::Type::plane) continue;
        Point3 origin = entry.world_from_object * Point3{};
        if (entry.type == GeometryDesc::Type::sphere)
            origin = entry.world_from_object * entry.center;
        if (entry.type == GeometryDesc::Type::box)
            origin = entry.world_from_object * (entry.min + 0.5 * (entry.max - entry.min));
        points.push_back({origin, static_cast<std::uint32_t>(i + 1), {}, {}});
    }
    return points;
}

Point3 vertex_of(const ObjectMotion& motion, std::size_t vertex) {
    const float* p = &(*motion.vertices)[3 * vertex];
    return {p[0], p[1], p[2]};
}

// Returns some of the vertices of the files in which objects deform.
std::vector<TrackedPoint> tracked_vertices(const ObjectMotions& motions) {
    std::vector<TrackedPoint> points;
    const std::vector<float>* last = nullptr;  // objects of a file follow each other
    for (std::size_t i = 0; i < motions.size(); ++i) {
        if (!motions[i] || !motions[i]->vertices || motions[i]->vertices.get() == last) continue;
        last = motions[i]->vertices.get();
        const std::size_t count = last->size() / 3;
        for (std::size_t vertex = 0; vertex < count; vertex += count / k_vertices + 1)
            points.push_back(
                {vertex_of(*motions[i], vertex), static_cast<std::uint32_t>(i + 1), {}, vertex});
    }
    return points;
}

// Returns where a point is that moves.
std::optional<Point3> place_of(const TrackedPoint& point, const ObjectMotions& motions,
                               const Surfaces& surfaces) {
    if (point.object == 0 || motions.empty()) return std::nullopt;
    if (point.hit) return moved_point(motions, surfaces, *point.hit);
    const std::optional<ObjectMotion>& motion = motions[point.object - 1];
    if (!motion) return std::nullopt;
    if (!motion->vertices) return motion->map * point.position;
    return point.vertex ? std::optional(vertex_of(*motion, *point.vertex)) : std::nullopt;
}

}  // namespace

std::shared_ptr<const CameraMotion> camera_motion(const ImageScene& scene, const TimeSpan& span) {
    if (!scene.time() || !(span.length() > 0)) return nullptr;
    const Affine& now = scene.desc().camera.world_from_camera;
    std::vector<TimedPose> poses;
    bool moves = false;
    for (const ImageScene& then : scenes_over(scene, span, k_poses)) {
        const Affine& pose = then.desc().camera.world_from_camera;
        moves = moves || pose != now;
        poses.push_back({*then.time() - *scene.time(), pose_of(pose)});
    }
    if (!moves) return nullptr;
    const Trajectory trajectory(poses, Interpolation::smooth);
    std::vector<Affine> table;
    table.reserve(k_table_size);
    for (int i = 0; i < k_table_size; ++i)
        table.push_back(
            trajectory.at(span.begin + span.length() * i / (k_table_size - 1)).affine());
    return std::make_shared<CameraMotion>(std::move(table), span);
}

Camera camera_of_truth(const ImageScene& scene) {
    const CameraDesc& camera = scene.desc().camera;
    const RowExposure rows{.line_time = camera.line_time, .height = camera.height};
    if (rows.line_time == 0) return Camera(camera);
    // Points outside the image need rows beyond it, by half of its height on either side.
    const TimeSpan all = rows.all();
    return {camera, camera_motion(scene, {2 * all.begin, 2 * all.end}), rows};
}

Exposure::Exposure(const AssembledScene& scene) : scene_(scene) {
    if (!scene.image.time()) return;
    const SceneDesc& desc = scene.desc();
    const bool is_path = integrator_kind(desc.render.integrator).traces_paths;
    const bool has_shutter = desc.render.shutter > 0;
    const int samples =
        has_shutter && !is_path ? desc.render.samples.value_or(k_samples) : samples_of(desc.render);
    rows_ = {.shutter = samples > 1 ? desc.render.shutter : 0,
             .line_time = desc.camera.line_time,
             .height = desc.camera.height};
    if (!(rows_.all().length() > 0)) return;
    const std::vector<ImageScene> moments = scenes_over(scene.image, rows_.all(), k_moments);
    if (std::ranges::all_of(moments,
                            [&](const ImageScene& then) { return same_poses(desc, then.desc()); }))
        return;
    camera_ = camera_motion(scene.image, rows_.all());
    measure(moments);
    divide(samples);
}

void Exposure::measure(const std::vector<ImageScene>& moments) {
    const SceneDesc& now = scene_.desc();
    const SurfaceNames& names = scene_.surfaces->names();
    std::vector<TrackedPoint> points = visible_points(scene_);
    std::vector<ObjectMotions> motions;
    std::vector<Camera> cameras;
    std::vector<std::string> no_warnings;  // the same files as for the frame
    for (const ImageScene& moment : moments) {
        const SceneDesc& then = moment.desc();
        motions.push_back(object_motions(now, then, names, no_warnings));
        cameras.emplace_back(then.camera);
        moves_surfaces_ = moves_surfaces_ || then.geometry != now.geometry;
    }
    if (moves_surfaces_) {
        for (const TrackedPoint& origin : origins(now, names)) points.push_back(origin);
        for (const TrackedPoint& vertex : tracked_vertices(motions.front()))
            points.push_back(vertex);
    }
    const Camera& still = *scene_.camera;
    for (const TrackedPoint& point : points) {
        Track view, surface;
        std::vector<Track> light(now.lamps.size());
        for (std::size_t m = 0; m < moments.size(); ++m) {
            view.extend(cameras[m], point.position);
            if (const auto there = place_of(point, motions[m], *scene_.surfaces))
                surface.extend(still, *there);
            // The light of a moving lamp is taken to move with it.
            for (std::size_t j = 0; j < light.size(); ++j) {
                const Affine before = now.lamps[j].world_from_frame(now.camera.world_from_camera);
                const SceneDesc& then = moments[m].desc();
                const Affine after = then.lamps[j].world_from_frame(then.camera.world_from_camera);
                if (!now.lamps[j].sun)
                    light[j].extend(still, after * before.inverse() * point.position);
            }
        }
        view_pixels_ = std::max(view_pixels_, view.length());
        surface_pixels_ = std::max(surface_pixels_, surface.length());
        for (const Track& track : light) light_pixels_ = std::max(light_pixels_, track.length());
    }
}

double Exposure::motion_pixels() const {
    return std::max({view_pixels_, surface_pixels_, light_pixels_});
}

void Exposure::divide(int samples) {
    const double rows_in_all = rows_.all().length();
    const double fraction = rows_.shutter / rows_in_all;  // of the exposure, for a row
    double parts = std::max(surface_pixels_ / k_surface_step, light_pixels_ / k_light_step);
    if (view_pixels_ * fraction > k_view_step) parts = std::max(parts, view_pixels_ / k_view_step);
    const bool is_path = integrator_kind(scene_.desc().render.integrator).traces_paths;
    // Path tracing needs two samples to estimate its error.
    const double max_in_a_row = is_path ? samples / 2 : samples;
    parts = std::min(parts, static_cast<double>(k_max_parts));
    if (fraction > 0) parts = std::min(parts, max_in_a_row / fraction);
    parts_ = std::max(1, static_cast<int>(std::ceil(parts)));
    // The camera's rows have their own poses whatever the moment.
    const double moves = std::max({view_pixels_ * fraction, surface_pixels_, light_pixels_});
    moments_ =
        std::clamp(static_cast<int>(std::ceil(moves / (k_moment_step * rows_.height))), 1, parts_);
    samples_of_part_ = samples;
    if (rows_.shutter > 0)
        samples_of_part_ =
            static_cast<int>(std::ceil(samples / std::max(1.0, parts_ * fraction) - 1e-9));
}

int Exposure::samples() const {
    if (parts_ == 0) return samples_of_part_;
    const double parts = std::max(1.0, parts_ * rows_.shutter / rows_.all().length());
    return static_cast<int>(std::lround(parts * samples_of_part_));
}

double Exposure::bound(int part) const {
    const TimeSpan all = rows_.all();
    return part == parts_ ? all.end : all.begin + part * all.length() / parts_;
}

RowExposure Exposure::rows_of(int first, int end) const {
    RowExposure rows = rows_;
    rows.part = {bound(first), bound(end)};
    return rows;
}

bool Exposure::has_middle(int part, int row) const {
    const double middle = rows_.middle(row + 0.5);
    return middle >= bound(part) && middle < bound(part + 1);
}

AssembledScene Exposure::scene_of(const RowExposure& rows, SceneCache& cache) const {
    const ImageScene& now = scene_.image;
    ImageScene then = now.at(*now.time() + rows.part.middle()).with([&](SceneDesc& desc) {
        desc.render.samples = samples_of_part_;
        // The shutter's time of the part is that of snow's streaks; volumes are blurred already.
        if (rows_.shutter > 0) desc.render.shutter = rows.part.length();
    });
    auto camera = camera_ ? std::make_unique<Camera>(then.desc().camera, camera_, rows)
                          : std::make_unique<Camera>(then.desc().camera);
    return with_moved(scene_, std::move(then), std::move(camera), cache);
}

AssembledScene Exposure::part(int part, SceneCache& cache) const {
    AssembledScene scene = scene_of(rows_of(part), cache);
    if (rows_.shutter == 0) return scene;
    scene.total_samples = parts_ * samples_of_part_;
    scene.first_sample = part * samples_of_part_;
    return scene;
}

std::optional<AssembledScene> Exposure::moment_from(int part, SceneCache& cache) const {
    for (int m = 0; m < moments_ && moments_ < parts_; ++m)
        if (m * parts_ / moments_ == part)
            return scene_of(rows_of(part, (m + 1) * parts_ / moments_), cache);
    return std::nullopt;
}

namespace {

/// Returns the rows of `window` that are exposed in a part, or all of them if the passes need the
/// whole image.
PixelWindow rows_of_part(const Exposure& exposure, int part, bool needs_all,
                         const PixelWindow& window) {
    if (needs_all) return window;
    PixelWindow rows = window;
    while (rows.y0 < rows.y1 && exposure.fraction(part, rows.y0) == 0) ++rows.y0;
    while (rows.y1 > rows.y0 && exposure.fraction(part, rows.y1 - 1) == 0) --rows.y1;
    return rows;
}

/// Combines the progress of the parts into that of the image.
class ReachedByParts {
  public:
    /// Includes a part. The errors of the parts' light paths are independent.
    void add(const ImageProgress& part) {
        samples_ += part.paths.samples;
        if (part.paths.error) squares_ += *part.paths.error * *part.paths.error;
        fast_.include_multiple_error(part);
        snow_ = std::max(snow_, part.snow_particles);
    }
    void report(int parts, int samples_of_pixel, ImageProgress& reached) const {
        if (samples_ > 0) {
            reached.paths = {samples_of_pixel, {}};
            if (squares_ > 0) reached.paths.error = std::sqrt(squares_) / parts;
        }
        reached.include_multiple_error(fast_);
        reached.snow_particles = snow_;
    }

  private:
    int samples_ = 0;
    double squares_ = 0;
    ImageProgress fast_;      // maxima of the parts' errors of multiple scattering
    std::uint64_t snow_ = 0;  // particles of the part that has most of them
};

}  // namespace

double fraction_of_pixels(Stage stage, double fraction) {
    return stage == Stage::render ? fraction : stage == Stage::forward_scatter ? 1 : 0;
}

void render_exposure(const Exposure& exposure, const AssembledScene& scene, SceneCache& cache,
                     PassList& passes, const LightOfPart& light_of_part, Rendering& rendering) {
    const SceneDesc& desc = scene.desc();
    if (desc.water.snow && desc.water.snow->in_ground_truth)
        throw InputError(
            "water.snow.ground_truth: held is for images in which nothing but the snow moves while "
            "the shutter is open; give --set water.snow.ground_truth=ignored");
    const LayerPlan& plan = rendering.plan;
    Film& film = rendering.film;
    const PassNeeds needs = passes.needs(plan);
    const int parts = exposure.part_count();
    ReachedByParts reached_by_parts;
    // MultipleScatteringPass uses the same random numbers in every part.
    const ExposureMean::Errors errors = integrator_kind(desc.render.integrator).traces_paths
                                            ? ExposureMean::Errors::independent
                                            : ExposureMean::Errors::alike;
    ExposureMean mean(plan, rendering.colour, errors, film);
    const Camera truth_camera = camera_of_truth(scene.image);
    const auto find_truth = [&](const AssembledScene& then, const LightTransport& transport,
                                const std::function<bool(int row)>& has_truth) {
        Rendering truth = make_rendering(then, truth_camera, transport, {}, rendering,
                                         rendering.pixels.matchers());
        truth.has_truth = has_truth;
        passes.run(Pass::Of::truth, truth);
    };
    const bool truth_differs = exposure.is_rolling() && exposure.moves_surfaces();
    bool is_shared = false;
    for (int k = 0; k < parts; ++k) {
        const StageProgressCallback tell = [&](Stage stage, double fraction) {
            rendering.progress(Stage::render, (k + fraction_of_pixels(stage, fraction)) / parts);
        };
        tell(Stage::render, 0);
        throw_if_stopped();
        if (const auto moment = exposure.moment_from(k, cache)) {
            is_shared = true;
            const DeepShadows light = light_of_part(*moment);
            const LightTransport transport = make_light_transport(*moment, light, needs.paths);
            ImageProgress none;
            Rendering middle = make_rendering(*moment, *moment->camera, transport, light,
                                              {plan, rendering.colour, film, tell, none});
            passes.share(middle);
        }
        const AssembledScene part = exposure.part(k, cache);
        const DeepShadows light = light_of_part(part);
        const LightTransport transport = make_light_transport(part, light, needs.paths);
        const PixelWindow rows = rows_of_part(exposure, k, needs.whole_image, film.window());
        if (rows.y0 < rows.y1) {
            Film image(film.width(), film.height(), rows, film.channel_names());
            ImageProgress reached;
            Rendering of_part = make_rendering(part, *part.camera, transport, light,
                                               {plan, rendering.colour, image, tell, reached});
            of_part.is_shared = is_shared;
            run_light_passes(part, passes, of_part);
            reached_by_parts.add(reached);
            mean.add(image, [&](int row) { return exposure.fraction(k, row); });
        }
        if (truth_differs)
            find_truth(part, transport, [&](int row) { return exposure.has_middle(k, row); });
    }
    mean.finish();
    if (!truth_differs) find_truth(scene, rendering.pixels.transport(), {});
    reached_by_parts.report(parts, samples_of(desc.render), rendering.reached);
}

}  // namespace uw
