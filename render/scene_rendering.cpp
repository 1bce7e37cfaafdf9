#include "render/scene_rendering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator_table.h"
#include "core/passes/multiple_light.h"
#include "core/passes/render_film.h"
#include "core/passes/snow_image.h"
#include "render/marine_snow.h"

namespace uw {

namespace {

// Slabs of water that begin at a distance s are k_growth (s + offset) thick, with the smaller of
// two offsets. Where a surface cuts a slab, the light of the part before it is spread over the
// whole slab in the pixels beside it: a halo around depth edges, of first order in the thickness.
// It is up to 0.25 % of the backscatter in what `uwvdb validate` renders, no more than the error of
// mixing blur widths.
constexpr double k_growth = 0.06;
constexpr double k_offset = 0.3;        // m
constexpr double k_offset_depth = 0.6;  // optical depth
// The angle between the rays along which slabs are integrated. Their light is blurred before it is
// seen, by kernels wider than a tenth of that.
constexpr double k_slab_spacing = 0.0091;  // rad
// How far in-scatter that is interpolated between pixels may be from that of their own rays
// (InScatterLattice), relative, where the lattice is confirmed; the image is interpolated from
// closer nodes and has a quarter of that error.
constexpr double k_in_scatter_tolerance = 4e-3;
constexpr double k_draft_tolerance = 0.05;
// How far the columns of a lamp's map may be off between two of its rays, as optical depth: rays
// half as far apart are used. A camera's ray meets hundreds of such errors, of either sign; those
// along a ray, which add up, are held to less (ColumnFace).
constexpr double k_column_tolerance = 0.02;
// Rays per pixel for what is not a mean over light paths, in images that are.
constexpr int k_most_samples_beside_paths = 16;

std::vector<double> growing_slabs(double near, double far, double attenuation) {
    double offset = k_offset;
    if (attenuation > 0) offset = std::min(offset, k_offset_depth / attenuation);
    const double count =
        std::max(1.0, std::ceil(std::log1p((far - near) / offset) / std::log1p(k_growth)));
    std::vector<double> faces;
    for (int i = 0; i <= static_cast<int>(count); ++i)
        faces.push_back(near + offset * std::expm1(std::log1p((far - near) / offset) * i / count));
    faces.back() = far;
    return faces;
}

std::vector<double> slab_faces(const AssembledScene& scene) {
    const Slabs& slabs = scene.slabs.value();
    std::vector<double> faces;
    if (integrator_kind(scene.desc().render.integrator).sums_slabs) {
        for (int i = 0; i <= slabs.count; ++i) faces.push_back(slabs.boundary(i));
        return faces;
    }
    // All of the water, wherever the slabs of `backscatter_first` are.
    PlanesDesc all;
    const Slabs water = place_slabs(all, *scene.camera, scene.lit());
    const Medium& medium = scene.water.medium;
    const double attenuation = medium.uniform.attenuation().greatest(medium.wavelengths_nm.size());
    faces = growing_slabs(water.near, water.far, attenuation);
    for (const double face : {slabs.boundary(0), slabs.boundary(1)})
        if (face > water.near && face < water.far) faces.push_back(face);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

double angle_between(const Ray& a, const Ray& b) {
    return std::atan2(glm::length(glm::cross(a.direction, b.direction)),
                      glm::dot(a.direction, b.direction));
}

// Pixels per radian in the water, at the centre of the image; if the centre does not see through
// the port, at the closest position that does.
ScatterPlane scatter_plane(const Camera& camera) {
    ScatterPlane plane{camera.width(), camera.height(), 1, 1};
    constexpr int k_steps = 64;
    double nearest = 1e300;
    for (int j = 0; j <= k_steps; ++j) {
        for (int i = 0; i <= k_steps; ++i) {
            const double u = static_cast<double>(i) / k_steps - 0.5;
            const double v = static_cast<double>(j) / k_steps - 0.5;
            if (u * u + v * v >= nearest) continue;
            const double x = (u + 0.5) * plane.width, y = (v + 0.5) * plane.height;
            const auto left = camera.refracted_ray(x - 0.5, y),
                       right = camera.refracted_ray(x + 0.5, y);
            const auto above = camera.refracted_ray(x, y - 0.5),
                       below = camera.refracted_ray(x, y + 0.5);
            if (!left || !right || !above || !below) continue;
            nearest = u * u + v * v;
            plane.focal_x = 1 / angle_between(*left, *right);
            plane.focal_y = 1 / angle_between(*above, *below);
        }
    }
    return plane;
}

}  // namespace

ForwardScatterSetup forward_scatter_setup(const AssembledScene& scene,
                                          const DeepShadows& deep_shadows) {
    ForwardScatterSetup setup;
    setup.desc = scene.desc().water.forward_scatter;
    setup.plane = scatter_plane(*scene.camera);
    setup.faces = slab_faces(scene);
    if (in_scatter_tolerance(scene.desc().render) > 0)
        setup.spacing = std::max(1.0, std::floor(k_slab_spacing * setup.plane.focal_x));
    // Planes of constant camera z do not cover a view wider than a hemisphere.
    setup.shells = scene.desc().camera.distortion.model == DistortionDesc::Model::fisheye;
    setup.sensor = SensorModel(scene.desc());
    setup.has_snow = scene.snow != nullptr;
    const Slabs& slabs = scene.slabs.value();
    setup.first = {slabs.boundary(0), slabs.boundary(1)};
    const ConcentrationField* field = scene.field.get();
    const std::vector<Lamp>* emitters = &scene.emitters;
    setup.lamp_column = [&deep_shadows, field, emitters](std::size_t emitter, const Point3& x,
                                                         std::span<double> column) {
        if (deep_shadows.empty())
            field->column((*emitters)[emitter].origin(x), x, column);
        else
            deep_shadows[emitter]->columns(std::span<const Point3>(&x, 1), column);
    };
    return setup;
}

DeepShadowOptions deep_shadow_options(RenderDesc::Quality quality, const Medium& medium) {
    DeepShadowOptions options;
    if (quality == RenderDesc::Quality::exact)
        options.shadow_resolution = 2048;
    else
        options.column_tolerance = DepthTolerance(medium, k_column_tolerance);
    if (quality != RenderDesc::Quality::draft) return options;
    options.shadow_resolution = 128;
    options.columns_per_voxel = 0.75;
    return options;
}

double in_scatter_tolerance(const RenderDesc& render) {
    const bool exact = render.quality == RenderDesc::Quality::exact;
    if (exact || !integrator_kind(render.integrator).interpolates_between_pixels) return 0;
    return render.quality == RenderDesc::Quality::draft ? k_draft_tolerance
                                                        : k_in_scatter_tolerance;
}

// By the quality: what leaves a standard error of less than 1 % where light crosses an optical
// depth of about one, and 5 % for drafts.
MultipleLightOptions multiple_light_options(const SceneDesc& scene, const LayerPlan& plan) {
    MultipleLightOptions options;
    options.lamps = plan.has_lamps();
    options.nodes = 5000;
    options.cells = 1'000'000;
    options.paths = 1'000'000;
    options.error = 0.009;
    if (scene.render.quality == RenderDesc::Quality::draft) {
        options.nodes = 1000;
        options.cells = 100'000;
        options.paths = 30'000;
        options.error = 0;
    }
    if (scene.render.quality == RenderDesc::Quality::exact) {
        options.nodes = 20000;
        options.cells = 4'000'000;
        options.paths = 16'000'000;
        options.error = 0;
    }
    return options;
}

LayerPlan layer_plan(const ImageScene& image, std::string_view request, const PathRequest& paths) {
    const SceneDesc& scene = image.desc();
    const bool traces_paths = integrator_kind(scene.render.integrator).traces_paths;
    for (const auto& [requested, option] :
         {std::pair{paths.error.has_value(), "--error"}, std::pair{paths.orders > 0, "--orders"}})
        if (requested && !traces_paths)
            throw UsageError(fmt::format(
                "{}: is for --integrator path only; write that, or leave this out", option));
    std::vector<std::string> names;
    names.reserve(scene.lamps.size());
    for (const LampDesc& lamp : scene.lamps) names.push_back(lamp.name);
    const bool several = paths.error || samples_of(scene.render) > 1;
    const std::optional<SensorDesc>& sensor = scene.camera.sensor;
    return {request, scene.water.bands_nm, names,
            LayerSupply{.multiple = scattering_of(scene.render) == RenderDesc::Scattering::multiple,
                        .snow = scene.water.snow.has_value(),
                        .error = traces_paths && several,
                        .flow = image.choice().frame.has_value(),
                        .disparity = scene.cameras.size() > 1,
                        .orders = paths.orders,
                        .sensor_values = sensor ? value_count(sensor->mosaic) : 0}};
}

bool needs_slabs(const SceneDesc& scene, const LayerPlan& plan) {
    const PlanesDesc& planes = scene.render.planes;
    return integrator_kind(scene.render.integrator).sums_slabs ||
           in_scatter_parts(plan).first_slab || scene.water.forward_scatter.K > 0 || planes.near ||
           planes.far;
}

PixelRenderer pixel_renderer(const AssembledScene& scene, const LightTransport& transport,
                             const InScatterParts& parts, const PointMatchers& matchers) {
    int samples = samples_of(scene.desc().render);
    if (integrator_kind(scene.desc().render.integrator).traces_paths)
        samples = std::min(samples, k_most_samples_beside_paths);
    return {*scene.camera,
            scene.lit(),
            transport,
            {samples, scene.total_samples, scene.first_sample},
            scene.slabs.value_or(Slabs{}),
            SensorModel(scene.desc()),
            parts,
            matchers};
}

SnowLayer snow_layer(const AssembledScene& scene, const DeepShadows& deep_shadows,
                     const LightTransport& transport, const PixelWindow& window,
                     const std::function<bool(double)>& progress, const ImageCallbacks& reached) {
    const SnowModel& model = *scene.snow;
    const auto depth = [snow = scene.snow](double distance) { return snow->drawn_depth(distance); };
    WaterVeil veil(*scene.camera, *transport.integrator, depth);
    const LitScene lit = scene.lit();
    const SnowLighting lighting(lit, deep_shadows);
    const std::vector<ExposureView> views = exposure_views(scene.image);
    const SensorModel sensor(scene.desc());
    const SnowPlacing placing{.model = model,
                              .desc = *scene.desc().water.snow,
                              .time = scene.image.time().value_or(0),
                              .views = views,
                              .surfaces = *scene.surfaces,
                              .lighting = lighting,
                              .veil = veil,
                              .sensor = sensor};
    const SnowSplats splats = placing.splats(window, [&](double fraction) {
        if (!progress(fraction)) throw Interrupted();
    });
    if (reached.particles) reached.particles(splats.splats.size());
    return {SnowImage(window, scene.water.medium.wavelengths_nm.size(), splats), std::move(veil),
            depth};
}

void render_scene(const AssembledScene& scene, const DeepShadows& deep_shadows,
                  const LightTransport& transport, const LayerPlan& plan, const BandColour& colour,
                  Film& film, const RenderProgress& progress, const PathGoal& goal,
                  const ImageCallbacks& reached, const PointMatchers& matchers) {
    const PixelRenderer renderer =
        pixel_renderer(scene, transport, in_scatter_parts(plan), matchers);
    const double tolerance = in_scatter_tolerance(scene.desc().render);
    const auto told = [&progress](const std::string& stage) {
        return [&progress, stage](double fraction) { return progress(stage, fraction); };
    };
    const auto begin = [&progress](const std::string& stage) {
        if (!progress(stage, 0)) throw Interrupted();
    };
    PixelAdditions additions;
    std::optional<SnowLayer> snow;
    if (scene.snow) {
        begin("snow");
        snow = snow_layer(scene, deep_shadows, transport, film.window(), told("snow"), reached);
        additions.snow = &*snow;
        additions.snow_in_ground_truth = scene.desc().water.snow->in_ground_truth;
    }
    if (transport.paths && !integrator_kind(scene.desc().render.integrator).traces_paths) {
        begin("multiple scattering");
        MultipleLight multiple(renderer, multiple_light_options(scene.desc(), plan));
        multiple.prepare(film.window(), told("multiple scattering"));
        if (reached.multiple) reached.multiple(multiple.error());
        additions.multiple = &multiple;
        begin("render");
        render_film(renderer, tolerance, plan, colour, film, told("render"), {}, additions);
        return;
    }
    begin("render");
    if (transport.paths) {
        render_path_film(renderer, goal, plan, colour, film, told("render"), reached.paths);
        return;
    }
    if (scene.desc().water.forward_scatter.K == 0) {
        render_film(renderer, tolerance, plan, colour, film, told("render"), {}, additions);
        return;
    }
    const ForwardScatterSetup setup = forward_scatter_setup(scene, deep_shadows);
    ForwardPass forward(renderer, scene.lit(), setup, plan);
    render_film(
        renderer, tolerance, plan, colour, film, told("render"),
        [&](int x, int y, const RenderedPixel& pixel) { forward.keep(x, y, pixel); }, additions);
    forward.run(told("forward scatter"));
    forward.write(plan, colour, film);
}

}  // namespace uw
