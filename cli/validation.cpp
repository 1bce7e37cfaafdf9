#include "cli/validation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "camera/image_size.h"
#include "cli/direct_sum.h"
#include "core/planes_integrator.h"
#include "core/quadrature_integrator.h"
#include "core/reference_integrator.h"

namespace uw {

namespace {

constexpr double k_quadrature_tolerance = 1e-5;
constexpr int k_fewest_planes = 8;
// Pixels darker than this share of the mean are compared relative to it.
constexpr double k_dark = 0.01;

// In a plume as rough as its voxels, columns interpolated between a lamp's rays and the straight
// lines between a ray's knots leave 0.2 %; this many tolerances.
constexpr double k_rough_water = 3;

// Slabs of the sum with forward scatter, which has no Richardson limit: TODO.
constexpr int k_forward_planes = 512;

const char* const k_volume = "volume";
const char* const k_planes_limit = "planes, limit";
const char* const k_constant_grid = "constant VDB";
const char* const k_quadrature = "quadrature";
const char* const k_reference = "reference";
const char* const k_volume_on_grids = "volume, own grids";
const char* const k_reference_on_grids = "reference, own grids";
const char* const k_direct_sum = "direct sum";

struct Component {
    const char* name;
    std::vector<Spectrum> MethodImage::*image;
};
const Component k_direct{"direct", &MethodImage::direct};
const Component k_forward{"forward", &MethodImage::forward};
const Component k_backscatter{"backscatter", &MethodImage::backscatter};

std::string forward_scattered(const std::string& method) {
    return method + ", forward scatter";
}

SceneDesc small_image(const SceneDesc& desc, int longest_side) {
    SceneDesc small = desc;
    CameraDesc& camera = small.camera;
    const double scale =
        std::min(1.0, static_cast<double>(longest_side) / std::max(camera.width, camera.height));
    const int width = std::max(1, static_cast<int>(std::lround(camera.width * scale)));
    const int height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
    resize_image(camera, width, height);
    small.render.integrator = RenderDesc::Integrator::volume;
    small.render.samples = 1;
    // What is compared is the radiance in the water.
    small.render.output = RenderDesc::Output::radiance;
    if (camera.port) camera.port->fresnel = camera.port->radiance_in_air = false;
    return small;
}

// Over the pixels that `counted` marks.
double largest_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                          const std::vector<char>& counted, std::size_t band) {
    const double floor = k_dark * mean_over_pixels(b, band);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(a[i][band] - b[i][band]);
        if (counted[i] != 0 && difference > 0)
            largest = std::max(largest, difference / std::max(b[i][band], floor));
    }
    return largest;
}

double rms_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      std::size_t band) {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += (a[i][band] - b[i][band]) * (a[i][band] - b[i][band]);
    const double mean = mean_over_pixels(b, band);
    return squares == 0 ? 0 : std::sqrt(squares / static_cast<double>(a.size())) / mean;
}

/// Collects images and compares them.
class SceneTrial {
  public:
    SceneTrial(const SceneDesc& desc, const std::string& name, const ValidationOptions& options)
        : desc_(small_image(desc, options.longest_side)), options_(options) {
        result_.name = name;
        result_.width = desc_.camera.width;
        result_.height = desc_.camera.height;
        result_.bands_nm = desc_.water.bands_nm;
    }

    SceneValidation run() {
        const auto start = std::chrono::steady_clock::now();
        const TrialScene trial = make_trial(desc_);
        TrialScene uniform = desc_.volumes.empty() ? make_trial(desc_) : homogenised(trial, desc_);
        result_.smooth = smooth_pixels(uniform);
        compare_before_forward_scatter(trial, uniform);
        if (desc_.water.forward_scatter.K > 0) compare_forward_scatter(trial, std::move(uniform));
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        result_.seconds = elapsed.count();
        return std::move(result_);
    }

  private:
    void compare_before_forward_scatter(const TrialScene& trial, const TrialScene& uniform) {
        const std::vector<Component> components{k_direct, k_backscatter};
        render(k_volume, uniform, *on_trial(uniform));
        render(k_quadrature, uniform,
               QuadratureIntegrator(uniform.scene.lit(), k_quadrature_tolerance));
        compare(k_volume, k_quadrature, components, k_all);
        sum_planes(uniform);
        compare(k_volume, k_planes_limit, components, k_smooth);
        const TrialScene grid = with_constant_grid(uniform, desc_, 1);
        render(k_constant_grid, grid, *on_trial(grid));
        compare(k_constant_grid, k_volume, components, k_all);
        render(k_reference, uniform, ReferenceIntegrator(uniform.scene.lit()));
        compare(k_volume, k_reference, components, k_smooth);
        if (desc_.volumes.empty()) return;
        render(k_volume_on_grids, trial, *on_trial(trial));
        render(k_reference_on_grids, trial, ReferenceIntegrator(trial.scene.lit()));
        compare(k_volume_on_grids, k_reference_on_grids, components, k_smooth, k_rough_water);
    }

    void compare_forward_scatter(const TrialScene& trial, TrialScene uniform) {
        const std::vector<Component> components{k_forward, k_backscatter};
        const std::string volume = forward_scattered(k_volume);
        render_forward(volume, uniform, uniform.light_fields, *on_trial(uniform));
        const std::string direct_sum = forward_scattered(k_direct_sum);
        options_.say(result_.name + ": " + direct_sum);
        result_.images[direct_sum] = forward_by_direct_sum(
            uniform, QuadratureIntegrator(uniform.scene.lit(), k_quadrature_tolerance),
            options_.proceed);
        compare(volume, direct_sum, {k_forward}, k_all);
        const TrialScene grid = with_constant_grid(uniform, desc_, 0.5);
        const std::string constant_grid = forward_scattered(k_constant_grid);
        render_forward(constant_grid, grid, grid.light_fields, *on_trial(grid));
        compare(constant_grid, volume, components, k_all, 3);
        const std::string reference = forward_scattered(k_reference);
        render_forward(reference, uniform, {}, ReferenceIntegrator(uniform.scene.lit()));
        compare(volume, reference, components, k_smooth);
        if (!desc_.volumes.empty()) {
            const std::string own = forward_scattered(k_volume_on_grids);
            render_forward(own, trial, trial.light_fields, *on_trial(trial));
            const std::string reference_own = forward_scattered(k_reference_on_grids);
            render_forward(reference_own, trial, {}, ReferenceIntegrator(trial.scene.lit()));
            compare(own, reference_own, components, k_smooth, k_rough_water);
        }
        const TrialScene planes = with_planes(std::move(uniform), desc_, k_forward_planes);
        const std::string sum = forward_scattered("planes, " + std::to_string(k_forward_planes));
        render_forward(sum, planes, {}, *make_integrator(planes.scene, {}));
        compare(volume, sum, components, k_smooth, 3);
    }

    std::unique_ptr<Integrator> on_trial(const TrialScene& trial) const {
        if (options_.volume) return options_.volume(trial.scene, trial.light_fields);
        return make_integrator(trial.scene, trial.light_fields);
    }

    void render(const std::string& method, const TrialScene& trial, const Integrator& integrator) {
        options_.say(result_.name + ": " + method);
        result_.images[method] = render_method(trial, integrator, options_.proceed);
    }

    void render_forward(const std::string& method, const TrialScene& trial,
                        const std::vector<std::shared_ptr<const LampLightField>>& light_fields,
                        const Integrator& integrator) {
        options_.say(result_.name + ": " + method);
        result_.images[method] =
            render_forward_scatter(trial, light_fields, integrator, options_.proceed);
    }

    // Methods that step over a shadow's edge are held to the largest difference where there is
    // none.
    enum Where { k_all, k_smooth };

    void compare(const std::string& left, const std::string& right,
                 const std::vector<Component>& components, Where where, double share = 1) {
        const std::vector<char> counted =
            where == k_smooth ? result_.smooth : std::vector<char>(result_.smooth.size(), 1);
        const auto count = static_cast<std::size_t>(std::count(counted.begin(), counted.end(), 1));
        const MethodImage& a = result_.images.at(left);
        const MethodImage& b = result_.images.at(right);
        for (const auto& [name, component] : components) {
            for (std::size_t band = 0; band < result_.bands_nm.size(); ++band) {
                Check check{left,
                            right,
                            name,
                            band,
                            where == k_all,
                            count,
                            0,
                            0,
                            share * options_.tolerance,
                            3 * options_.tolerance};
                check.largest = largest_difference(a.*component, b.*component, counted, band);
                check.rms = rms_difference(a.*component, b.*component, band);
                result_.checks.push_back(check);
            }
        }
    }

    // Sums over ever more slabs; the midpoint rule's error falls with the square of the thickness,
    // so that (4 fine - coarse) / 3 is their limit (Richardson).
    void sum_planes(const TrialScene& uniform) {
        std::vector<MethodImage> sums;
        for (int count = k_fewest_planes; count <= options_.most_planes; count *= 2) {
            const Slabs slabs = planes_of(uniform, desc_, count);
            const PlanesIntegrator integrator(uniform.scene.lit(),
                                              uniform.scene.camera->world_from_camera(), slabs);
            const std::string method = "planes, " + std::to_string(count);
            render(method, uniform, integrator);
            sums.push_back(result_.images[method]);
        }
        MethodImage limit = sums.back();
        const MethodImage& coarse = sums[sums.size() - 2];
        for (std::size_t i = 0; i < limit.backscatter.size(); ++i)
            for (std::size_t b = 0; b < k_max_bands; ++b)
                limit.backscatter[i][b] += (limit.backscatter[i][b] - coarse.backscatter[i][b]) / 3;
        for (std::size_t n = 0; n < sums.size(); ++n) {
            PlanesStep step{k_fewest_planes << n, 0, 0};
            for (std::size_t band = 0; band < result_.bands_nm.size(); ++band)
                step.error =
                    std::max(step.error, largest_difference(sums[n].backscatter, limit.backscatter,
                                                            result_.smooth, band));
            if (n > 0 && step.error > 0)
                step.order = std::log2(result_.planes.back().error / step.error);
            result_.planes.push_back(step);
        }
        result_.images[k_planes_limit] = std::move(limit);
    }

    SceneDesc desc_;
    const ValidationOptions& options_;
    SceneValidation result_;
};

}  // namespace

double mean_over_pixels(const std::vector<Spectrum>& image, std::size_t band) {
    double sum = 0;
    for (const Spectrum& pixel : image) sum += pixel[band];
    return sum / static_cast<double>(image.size());
}

bool SceneValidation::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed(); });
}

SceneValidation validate_scene(const SceneDesc& desc, const std::string& name,
                               const ValidationOptions& options) {
    return SceneTrial(desc, name, options).run();
}

}  // namespace uw
