#include "cli/validate/validation_methods.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "camera/image_size.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/files/scratch_folder.h"
#include "core/frame/pixel_renderer.h"
#include "core/optics/optical_depth.h"
#include "media/vdb/vdb_writer.h"

namespace uw {

namespace {

constexpr int k_mean_samples = 64;     // along each edge of the field's bounds
constexpr int k_grid_side = 48;        // voxels of the constant grid along each edge
constexpr double k_reach_depths = 15;  // optical depths that the constant grid extends

Renderer make_renderer(const ResolvedScene& scene, const std::function<bool()>& proceed) {
    Renderer renderer([proceed](const std::string&, double) { return proceed(); });
    renderer.set_scene(scene);
    return renderer;
}

// `scene` without its volumes, in the water of `medium`; not splatted.
Renderer in_water(ResolvedScene scene, Medium medium, const std::function<bool()>& proceed) {
    scene.edit().volumes.clear();
    Renderer renderer = make_renderer(scene, proceed);
    renderer.edit([&](AssembledScene& parts) { parts.water.medium = std::move(medium); });
    return renderer;
}

// Mean concentration of each constituent over the field's bounds.
std::vector<double> mean_concentrations(const ConcentrationField& field) {
    std::vector<double> mean(static_cast<std::size_t>(field.constituent_count()));
    const Bounds bounds = field.bounds();
    if (bounds.empty()) return mean;
    const Vector3 extent = bounds.max - bounds.min;
    std::vector<double> sample(mean.size());
    for (int i = 0; i < k_mean_samples; ++i) {
        for (int j = 0; j < k_mean_samples; ++j) {
            for (int k = 0; k < k_mean_samples; ++k) {
                const Vector3 at = (Vector3(i, j, k) + 0.5) / static_cast<double>(k_mean_samples);
                field.sample(bounds.min + at * extent, sample);
                for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += sample[c];
            }
        }
    }
    for (double& value : mean) value /= std::pow(k_mean_samples, 3);
    return mean;
}

void add_scaled(OpticalCoefficients& to, const OpticalCoefficients& from, double scale) {
    to.absorption += scale * from.absorption;
    for (std::size_t m = 0; m < to.scattering.size(); ++m)
        to.scattering[m] += scale * from.scattering[m];
}

// Bounds of everything that light passes between lamps and camera before it is extinguished.
Bounds reach_of(const TrialScene& trial) {
    Bounds bounds = trial.scene().surfaces->bounds();
    const Point3 camera = at_origin_plus(trial.scene().camera->world_from_camera().offset());
    for (const Lamp& lamp : trial.scene().emitters) bounds.extend(lamp.origin(camera));
    bounds.extend(camera);
    const AttenuationTable c(trial.scene().water.medium);
    const double least = c.uniform.least(static_cast<std::size_t>(c.band_count));
    const double margin = least > 0 ? std::min(k_reach_depths / least, 1e3) : 1e3;
    return {bounds.min - Vector3(margin), bounds.max + Vector3(margin)};
}

// Distances at which the lamp's beam ends abruptly. A soft edge has a finite slope and leaves the
// midpoint rule its order.
void append_hard_beam_edges(const Ray& ray, const Lamp& lamp, std::vector<double>& edges) {
    constexpr double k_step = 1e-6;
    std::vector<double> breaks;
    lamp.append_profile_breaks(ray, {0, k_far}, breaks);
    for (const double s : breaks) {
        const Point3 x = ray.at(s * (1 - k_step)), y = ray.at(s * (1 + k_step));
        const double before = lamp.relative_intensity(x - lamp.origin(x));
        const double after = lamp.relative_intensity(y - lamp.origin(y));
        if (std::abs(after - before) > 0.01) edges.push_back(s);
    }
}

TrialScene splatted(Renderer renderer) {
    renderer.assemble();
    renderer.splat();
    return {std::move(renderer)};
}

}  // namespace

void show_radiance_in_water(SceneDesc& scene, int longest_side) {
    CameraDesc& camera = scene.camera;
    const double scale =
        std::min(1.0, static_cast<double>(longest_side) / std::max(camera.width, camera.height));
    const int width = std::max(1, static_cast<int>(std::lround(camera.width * scale)));
    const int height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
    resize_image(camera, width, height);
    scene.render.output = RenderDesc::Output::radiance;
    scene.render.colour = {};
    if (camera.port)
        std::visit([](auto& port) { port.fresnel = port.radiance_in_air = false; }, *camera.port);
}

TrialScene make_trial(const ResolvedScene& scene, const std::function<bool()>& proceed) {
    return splatted(make_renderer(scene, proceed));
}

TrialScene homogenised(const TrialScene& trial, const ResolvedScene& scene,
                       const std::function<bool()>& proceed) {
    Medium medium = trial.scene().water.medium;
    const std::vector<double> mean = mean_concentrations(*trial.scene().field);
    for (std::size_t k = 0; k < mean.size(); ++k)
        add_scaled(medium.uniform, medium.constituents[k].per_unit, mean[k]);
    medium.constituents.clear();
    return splatted(in_water(scene, std::move(medium), proceed));
}

TrialScene with_constant_grid(const TrialScene& trial, const ResolvedScene& scene, double share,
                              const std::function<bool()>& proceed) {
    Medium medium = trial.scene().water.medium;
    const OpticalCoefficients whole = medium.uniform;
    const OpticalCoefficients none{{}, std::vector<Spectrum>(whole.scattering.size())};
    Constituent water{.name = "water", .unit = "1", .per_unit = none};
    add_scaled(water.per_unit, whole, share);
    medium.uniform = none;
    add_scaled(medium.uniform, whole, 1 - share);
    medium.constituents = {water};

    const Bounds bounds = reach_of(trial);
    const Vector3 extent = bounds.max - bounds.min;
    VdbOutputGrid ones;
    ones.name = "ones";
    ones.voxel_size = std::max({extent.x, extent.y, extent.z}) / k_grid_side;
    ones.origin = bounds.min;
    for (int axis = 0; axis < 3; ++axis)
        ones.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil(extent[axis] / ones.voxel_size)) + 1;
    ones.value = [](int, int, int) { return 1.0F; };
    const ScratchFolder folder;
    VolumeDesc volume;
    volume.file = folder.path() / "ones.vdb";
    volume.where = "constant grid";
    GridMappingDesc mapping;
    mapping.grid = ones.name;
    mapping.where = volume.where;
    volume.grids = {mapping};
    volume.centering = Centering::node;
    volume.up = UpAxis::y;
    write_vdb(volume.file, {ones}, {{"creator", "uwvdb validate"}});

    Renderer renderer = in_water(scene, std::move(medium), proceed);
    renderer.edit([&](AssembledScene& parts) {
        parts.field =
            load_volumes({volume}, {{{GridLoad{0, 1.0}}}}, 1, parts.volume_reports, parts.warnings);
        ForwardScatterDesc& forward = parts.desc.water.forward_scatter;
        forward.G *= 1 - share;
        forward.B *= 1 - share;
    });
    return splatted(std::move(renderer));
}

Slabs planes_of(const TrialScene& trial, int count) {
    PlanesDesc planes = trial.scene().desc.render.planes;
    planes.count = count;
    return place_slabs(planes, *trial.scene().camera, trial.scene().lit());
}

MethodImage render_method(const TrialScene& trial, const LightTransport& transport,
                          const std::function<bool()>& proceed) {
    const auto pixels =
        static_cast<std::size_t>(trial.width()) * static_cast<std::size_t>(trial.height());
    MethodImage image;
    image.direct.resize(pixels);
    image.backscatter.resize(pixels);
    const PixelRenderer renderer(*trial.scene().camera, trial.scene().lit(), transport, {},
                                 trial.scene().slabs.value());
    parallel_for(static_cast<std::size_t>(trial.height()), [&](std::size_t row) {
        if (!proceed()) throw Interrupted();
        PixelResult result;
        for (int x = 0; x < trial.width(); ++x) {
            renderer.render(x, static_cast<int>(row), result);
            const std::size_t i =
                row * static_cast<std::size_t>(trial.width()) + static_cast<std::size_t>(x);
            image.direct[i] = result.direct;
            image.backscatter[i] = result.backscatter;
        }
    });
    return image;
}

void render_forward_scatter(TrialScene& trial, const LightTransport& transport,
                            MethodImage& image) {
    const std::string layers = "forward,backscatter";
    const Film& film =
        trial.renderer.render({.layers = layers, .window = {}, .transport = &transport});
    const LayerPlan plan = layer_plan(trial.scene().desc, layers);
    const std::size_t bands = trial.scene().desc.water.bands_nm.size();
    const auto read = [&](Layer layer, std::vector<Spectrum>& component) {
        const auto first = static_cast<std::size_t>(plan.first_channel(layer));
        for (int y = 0; y < film.height(); ++y) {
            for (int x = 0; x < film.width(); ++x) {
                Spectrum& pixel = component.emplace_back();
                for (std::size_t band = 0; band < bands; ++band)
                    pixel[band] = static_cast<double>(film.pixel(x, y)[first + band]);
            }
        }
    };
    read(Layer::forward, image.forward);
    read(Layer::backscatter, image.blurred_backscatter);
}

std::vector<char> smooth_pixels(const TrialScene& trial) {
    constexpr double k_edge = 1e-3;  // of the ray's length: closer to its ends does not count
    std::vector<char> smooth(static_cast<std::size_t>(trial.width() * trial.height()), 1);
    parallel_for(smooth.size(), [&](std::size_t i) {
        const int x = static_cast<int>(i) % trial.width(), y = static_cast<int>(i) / trial.width();
        const auto ray = trial.scene().camera->refracted_ray(x + 0.5, y + 0.5);
        if (!ray) return;
        SurfaceHit hit;
        const double end =
            trial.scene().surfaces->closest_hit(*ray, k_far, hit) ? hit.distance : k_far;
        std::vector<Interval> lit;
        std::vector<double> edges;
        for (std::size_t j = 0; j < trial.scene().emitters.size(); ++j) {
            const Lamp& emitter = trial.scene().emitters[j];
            const Interval in_beam = emitter.beam(*ray, {0, end});
            trial.light()[j]->lit_intervals(*ray, in_beam, lit);
            edges.clear();
            for (const Interval& interval : lit) {
                edges.push_back(interval.begin);
                edges.push_back(interval.end);
            }
            append_hard_beam_edges(*ray, emitter, edges);
            for (const double s : edges)
                if (s > k_edge * end && s < (1 - k_edge) * end) smooth[i] = 0;
        }
    });
    return smooth;
}

}  // namespace uw
