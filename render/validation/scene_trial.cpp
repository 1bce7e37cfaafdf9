#include "render/validation/scene_trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/light/reference_integrator.h"
#include "render/light_points.h"

namespace uw {

namespace {

constexpr int k_longest_side = 48;  // of the image that is compared [pixels]
constexpr int k_max_planes = 512;   // more where shadow edges leave the finest sum rough
constexpr double k_quadrature_tolerance = 1e-5;

// In a plume as rough as its voxels, interpolating columns between a lamp's rays, and linearly
// between a ray's knots, leaves an error of 0.2 %; this many tolerances.
constexpr double k_rough_water = 3;

// Likewise, with forward scatter. Kernels between neighbouring widths are mixtures: they misplace
// up to 0.25 % of the light, on surfaces and again on its way to the camera, and are up to 1.7 %
// too high at the centre, which shows where a small thing is bright (0.4 % in
// assets/scenes/plume.yaml). The RMS, which may be three tolerances as everywhere, is the sharper
// test. Light lost by a bright pixel bears no relation to that of a dark one: pixels darker than
// the mean are compared with the mean.
constexpr double k_mixed_kernels = 10;
constexpr double k_dark_in_mixtures = 1;
// Where a surface cuts a slab of water, the light of the part before it is spread over the whole
// slab in the pixels beside it: at depth edges this leaves an error of first order in the slabs'
// thickness, 0.23 % in the suite and 0.4 % in assets/scenes/plume.yaml with K = 1. The slabs of the
// planes integrator are thin and reveal nearly all of it; water that is half in a VDB has slabs
// like those of uniform water, but in other places.
constexpr double k_cut_slabs = 5;
constexpr double k_other_slabs = 3;

const char* const k_volume = "volume";
const char* const k_planes_limit = "planes, limit";
const char* const k_constant_grid = "constant VDB";
const char* const k_quadrature = "quadrature";
const char* const k_reference = "reference";
const char* const k_volume_on_grids = "volume, own grids";
const char* const k_reference_on_grids = "reference, own grids";
const char* const k_direct_sum = "direct sum";

void make_small(SceneDesc& small) {
    if (small.camera.distortion.model == DistortionDesc::Model::fisheye)
        throw InputError(
            "validate: it includes sums over slabs parallel to the image plane, but a fisheye lens "
            "can see past them; give --set camera.distortion='{k: [0, 0, 0]}'");
    show_radiance_in_water(small, k_longest_side);
    small.render.integrator = RenderDesc::Integrator::volume;
    small.render.scattering = RenderDesc::Scattering::single;
    small.render.quality = RenderDesc::Quality::exact;
    small.render.samples = 1;
}

bool scatters_in_all_bands(const Medium& medium) {
    const Spectrum b = medium.uniform.total_scattering();
    return std::ranges::all_of(b.first(medium.wavelengths_nm.size()),
                               [](double of_band) { return of_band != 0; });
}

/// Collects images and compares them.
class SceneTrial {
  public:
    SceneTrial(const ImageScene& scene, const std::string& name, const ValidationOptions& options,
               const TransportChange& under_test)
        : scene_(scene.with(make_small)), options_(options), under_test_(under_test) {
        result_.name = name;
        result_.width = scene_.desc().camera.width;
        result_.height = scene_.desc().camera.height;
        result_.bands_nm = scene_.desc().water.bands_nm;
    }

    SceneValidation run() {
        const auto start = std::chrono::steady_clock::now();
        TrialScene trial = make_trial(scene_);
        if (trial.scene().glass)
            throw InputError(
                "validate: it compares light that scatters once on straight rays, which glass "
                "bends; remove the surfaces of glass");
        std::optional<TrialScene> mixed;
        if (varies()) mixed = homogenised(trial, scene_);
        TrialScene& uniform = mixed ? *mixed : trial;
        result_.smooth = smooth_pixels(uniform);
        result_.notes = pointed_lamp_notes(trial.scene(), find_pointed_lamps(trial.scene()));
        compare_before_forward_scatter(trial, uniform);
        if (scene_.desc().water.forward_scatter.K > 0) compare_forward_scatter(trial, uniform);
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        result_.seconds = elapsed.count();
        return std::move(result_);
    }

  private:
    /// Whether the water is not the same everywhere.
    bool varies() const {
        return !scene_.desc().volumes.empty() || scene_.desc().water.profile.has_value();
    }

    void compare_before_forward_scatter(TrialScene& trial, TrialScene& uniform) {
        const std::vector<Component> both{k_direct, k_backscatter};
        render(k_volume, uniform, on_trial(uniform));
        render(
            k_quadrature, uniform,
            {std::make_unique<QuadratureIntegrator>(uniform.scene().lit(), k_quadrature_tolerance),
             std::make_unique<UniformWaterLighting>(uniform.scene().lit())});
        compare(k_volume, k_quadrature, both, {});
        sum_planes(uniform);
        compare(k_volume, k_planes_limit, both, {.where = k_smooth, .coarser = &coarser_sum_});
        TrialScene grid = with_constant_grid(uniform, scene_, 1);
        render(k_constant_grid, grid, on_trial(grid));
        compare(k_constant_grid, k_volume, both, {});
        render(k_reference, uniform, by_reference(uniform));
        compare(k_volume, k_reference, both, {.where = k_smooth});
        if (!varies()) return;
        render(k_volume_on_grids, trial, on_trial(trial));
        render(k_reference_on_grids, trial, by_reference(trial));
        compare(k_volume_on_grids, k_reference_on_grids, both,
                {.where = k_smooth, .tolerances = k_rough_water});
    }

    void compare_forward_scatter(TrialScene& trial, TrialScene& uniform) {
        const std::vector<Component> both{k_forward, k_blurred_backscatter};
        scatter(k_volume, uniform, on_trial(uniform));
        options_.say(result_.name + ": " + k_direct_sum);
        result_.images[k_direct_sum].forward =
            forward_by_direct_sum(uniform, UniformWaterLighting(uniform.scene().lit()));
        compare(k_volume, k_direct_sum, {k_forward},
                {.tolerances = k_mixed_kernels, .dark = k_dark_in_mixtures});
        compare_half_constant_grid(uniform);
        scatter_without_splats(k_reference, uniform, RenderDesc::Integrator::reference,
                               uniform.scene().slabs.value());
        compare(k_volume, k_reference, both, {.where = k_smooth});
        if (varies()) {
            scatter(k_volume_on_grids, trial, on_trial(trial));
            scatter_without_splats(k_reference_on_grids, trial, RenderDesc::Integrator::reference,
                                   trial.scene().slabs.value());
            compare(k_volume_on_grids, k_reference_on_grids, both,
                    {.where = k_smooth, .tolerances = k_rough_water});
        }
        const int finest = result_.planes.back().count;
        const std::string sum = planes_name(finest);
        scatter_without_splats(sum, uniform, RenderDesc::Integrator::planes,
                               planes_of(uniform, finest));
        compare(k_volume, sum, both, {.where = k_smooth, .tolerances = k_cut_slabs});
    }

    // Half of the water stays uniform: the blur is measured relative to what it scatters, which is
    // nothing if all water is in the grid.
    void compare_half_constant_grid(const TrialScene& uniform) {
        if (!scatters_in_all_bands(uniform.scene().water.medium)) {
            options_.say(result_.name + ": " + k_constant_grid +
                         ", forward scatter: left out; the water does not scatter in every band");
            return;
        }
        TrialScene grid = with_constant_grid(uniform, scene_, 0.5);
        scatter(k_constant_grid, grid, on_trial(grid));
        compare(k_constant_grid, k_volume, {k_forward, k_blurred_backscatter},
                {.tolerances = k_other_slabs});
    }

    LightTransport on_trial(TrialScene& trial) const {
        LightTransport honest = trial.renderer.make_transport();
        return under_test_ ? under_test_(std::move(honest)) : std::move(honest);
    }

    static LightTransport by_reference(const TrialScene& trial) {
        return {std::make_unique<ReferenceIntegrator>(trial.scene().lit()),
                std::make_unique<DirectLighting>(trial.scene().lit())};
    }

    void render(const std::string& method, const TrialScene& trial,
                const LightTransport& transport) {
        options_.say(result_.name + ": " + method);
        result_.images[method] = render_method(trial, transport);
    }

    void scatter(const std::string& method, TrialScene& trial, const LightTransport& transport) {
        options_.say(result_.name + ": " + method + ", forward scatter");
        render_forward_scatter(trial, transport, result_.images[method]);
    }

    // Does so by an integrator that uses no splatted light or columns.
    void scatter_without_splats(const std::string& method, const TrialScene& trial,
                                RenderDesc::Integrator which, const Slabs& slabs) {
        AssembledScene parts = trial.scene();
        parts.image = parts.image.with([&](SceneDesc& desc) { desc.render.integrator = which; });
        parts.slabs = slabs;
        TrialScene other;
        other.renderer.set_scene(std::move(parts));
        scatter(method, other, other.renderer.make_transport());
    }

    // The error of a method itself if its image still changes this much; none if it has converged.
    static double own_error(double change, double tolerance) {
        return change > tolerance ? change : 0;
    }

    // Methods that step over shadow edges are held to the largest difference only in pixels without
    // any.
    enum Where { k_all, k_smooth };
    struct Measure {
        Where where = k_all;
        double tolerances = 1;  // `largest` may be this many times the requested one
        double dark = k_dark;   // fraction of the mean
        // The right method's image in steps twice as wide: that its error halves from the one to
        // the other, as it does where the integrand jumps, leaves it as large as the change.
        const MethodImage* coarser = nullptr;
    };

    void compare(const std::string& left, const std::string& right,
                 const std::vector<Component>& components, const Measure& measure) {
        const bool everywhere = measure.where == k_all;
        const std::vector<char> counted =
            everywhere ? std::vector<char>(result_.smooth.size(), 1) : result_.smooth;
        const auto count = static_cast<std::size_t>(std::count(counted.begin(), counted.end(), 1));
        for (const Component& component : components) {
            const std::vector<Spectrum>& a = result_.images.at(left).*component.image;
            const std::vector<Spectrum>& b = result_.images.at(right).*component.image;
            for (std::size_t band = 0; band < result_.bands_nm.size(); ++band) {
                Check check{left, right, component, band, everywhere, count, measure.dark};
                check.largest = max_difference(a, b, counted, band, measure.dark);
                check.rms = rms_difference(a, b, band);
                check.tolerance = measure.tolerances * options_.tolerance;
                check.rms_tolerance = 3 * options_.tolerance;
                if (measure.coarser) {
                    const std::vector<Spectrum>& coarser = measure.coarser->*component.image;
                    check.own = own_error(max_difference(b, coarser, counted, band, measure.dark),
                                          check.tolerance);
                    check.tolerance += check.own;
                    check.rms_tolerance +=
                        own_error(rms_difference(b, coarser, band), check.rms_tolerance);
                }
                result_.checks.push_back(check);
            }
        }
    }

    void sum_planes(const TrialScene& uniform) {
        PlaneSums sums = sum_planes_to_limit(
            uniform, result_.smooth,
            {options_.tolerance, k_max_planes,
             [&](const std::string& sum) { options_.say(result_.name + ": " + sum); }});
        result_.images[k_planes_limit] = std::move(sums.limit);
        result_.images[planes_name(sums.steps.back().count)] = std::move(sums.finest);
        coarser_sum_ = std::move(sums.coarser);
        result_.planes = std::move(sums.steps);
    }

    ImageScene scene_;
    const ValidationOptions& options_;
    const TransportChange& under_test_;
    SceneValidation result_;
    MethodImage coarser_sum_;  // over half the slabs of the finest sum
};

}  // namespace

SceneValidation validate_scene(const ImageScene& scene, const std::string& name,
                               const ValidationOptions& options,
                               const TransportChange& under_test) {
    return SceneTrial(scene, name, options, under_test).run();
}

SceneValidation validate_scene(const ImageScene& scene, const std::string& name,
                               const ValidationOptions& options) {
    return validate_scene(scene, name, options, {});
}

}  // namespace uw
