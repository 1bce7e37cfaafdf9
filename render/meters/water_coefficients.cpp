#include "render/meters/water_coefficients.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/geometry/mesh.h"
#include "core/image/colour.h"
#include "core/light/integrator_table.h"
#include "render/meters/target_probe.h"
#include "render/renderer.h"

namespace uw {

namespace {

/// Pixels along each side of the images.
constexpr int k_axis_pixels = 3;

CameraDesc axis_camera(const CameraDesc& camera) {
    CameraDesc axis = camera;
    axis.trajectory.reset();
    axis.sensor.reset();
    axis.lens.reset();
    axis.line_time = 0;
    axis.width = axis.height = k_axis_pixels;
    axis.intrinsics.cx = axis.intrinsics.cy = 0.5 * k_axis_pixels;
    return axis;
}

/// A square across the camera's axis, in world space, facing the camera.
GeometryDesc square_target(const CameraDesc& camera, double distance, double side,
                           double reflectance, std::size_t bands) {
    TriangleMesh mesh;
    const Vector3 normal = glm::normalize(camera.world_from_camera.apply_to_vector({0, 0, -1}));
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const Point3 corner =
            camera.world_from_camera * Point3{0.5 * side * x, 0.5 * side * y, distance};
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(static_cast<float>(corner[axis]));
            mesh.normals.push_back(static_cast<float>(normal[axis]));
        }
    }
    mesh.triangles = {0, 2, 1, 0, 3, 2};
    GeometryDesc target;
    target.mesh = std::make_shared<TriangleMesh>(std::move(mesh));
    target.mesh_name = fmt::format("target {} {} {}", distance, side, reflectance);
    target.reflectance = PerBand(bands, reflectance);
    return target;
}

/// What a few pixels see, their mean.
struct AxisView {
    Spectrum total, clean, transmittance;
    double path = 0;
};

class AxisRenderer {
  public:
    AxisRenderer(const ImageScene& scene, double error) : scene_(scene) {
        if (scattering_of(scene.desc().render) == RenderDesc::Scattering::single) return;
        // The error is that of a pixel; their mean is better by the root of their number.
        paths_.error = k_axis_pixels * error;
    }

    AxisView view(std::vector<GeometryDesc> targets) {
        renderer_.set_scene(scene_.with([&](SceneDesc& desc) {
            desc.geometry = std::move(targets);
            desc.camera = axis_camera(desc.camera);
            desc.water.forward_scatter = {};
            desc.water.snow.reset();
            desc.render.output = RenderDesc::Output::radiance;
            desc.render.shutter = 0;
            // Nodes over the image, as `volume` has them, are of no use to a few pixels.
            if (paths_.error) desc.render.integrator = RenderDesc::Integrator::path;
        }));
        constexpr const char* k_layers = "total,clean,transmittance,path";
        const LayerPlan plan = layer_plan(renderer_.scene(), k_layers, paths_);
        const Film& film = renderer_.render({.layers = k_layers, .paths = paths_});
        const std::size_t bands = plan.band_count();
        AxisView view;
        const auto add_to = [&](Spectrum& sum, Layer layer, std::span<const float> pixel) {
            const auto first = static_cast<std::size_t>(std::max(0, plan.first_channel(layer)));
            for (std::size_t b = 0; b < bands; ++b)
                sum[b] += static_cast<double>(pixel[first + b]) / k_pixels;
        };
        for (int y = 0; y < k_axis_pixels; ++y)
            for (int x = 0; x < k_axis_pixels; ++x) {
                const std::span<const float> pixel = film.pixel(x, y);
                add_to(view.total, Layer::total, pixel);
                add_to(view.clean, Layer::clean, pixel);
                add_to(view.transmittance, Layer::transmittance, pixel);
                view.path += static_cast<double>(
                                 pixel[static_cast<std::size_t>(plan.first_channel(Layer::path))]) /
                             k_pixels;
            }
        if (const auto& error = renderer_.report().paths.error; error && paths_.error)
            error_ = std::max(error_.value_or(0), *error / k_axis_pixels);
        return view;
    }

    std::optional<double> error() const { return error_; }

  private:
    static constexpr double k_pixels = k_axis_pixels * k_axis_pixels;

    const ImageScene& scene_;
    PathRequest paths_;  // with an error to reach: of scenes in all light
    Renderer renderer_;
    std::optional<double> error_;
};

/// The side of a target that more than covers the pixels.
double side_at(const CameraDesc& camera, double distance, const TargetSeriesOptions& options) {
    constexpr double k_covered = 4;
    const double pixel = distance / std::min(camera.intrinsics.fx, camera.intrinsics.fy);
    return std::max(options.side, k_covered * k_axis_pixels * pixel);
}

void check_axis(const CameraDesc& desc, double nearest) {
    const auto ray = Camera(desc).refracted_ray(desc.intrinsics.cx, desc.intrinsics.cy);
    if (!ray)
        throw InputError(
            "camera: the principal point sees no water; targets are set up on the camera's axis");
    const Vector3 axis = glm::normalize(desc.world_from_camera.apply_to_vector({0, 0, 1}));
    const double begin = glm::dot(ray->origin - desc.world_from_camera * Point3{0, 0, 0}, axis);
    if (!(nearest > begin))
        throw InputError(fmt::format(
            "camera.port: the water begins {:g} m before the camera, and the nearest target is at "
            "{:g} m; set it up farther away",
            begin, nearest));
}

}  // namespace

TargetSeriesSet measure_targets(const ImageScene& scene, const TargetSeriesOptions& options,
                                const std::function<void(double)>& progress) {
    const CameraDesc camera = axis_camera(scene.desc().camera);
    check_axis(camera, options.nearest);
    const std::vector<double>& bands_nm = scene.desc().water.bands_nm;
    const std::size_t bands = bands_nm.size();
    const int views = 2 * options.count + 1;
    int done = 0;
    AxisRenderer renderer(scene, options.error);
    const auto view = [&](std::vector<GeometryDesc> targets) {
        throw_if_stopped();
        const AxisView seen = renderer.view(std::move(targets));
        if (progress) progress(static_cast<double>(++done) / views);
        return seen;
    };

    TargetSeriesSet set;
    std::vector<AxisView> white, black;
    for (const double distance :
         target_distances(options.nearest, options.farthest, options.count)) {
        const double side = side_at(camera, distance, options);
        white.push_back(view({square_target(camera, distance, side, 1, bands)}));
        black.push_back(view({square_target(camera, distance, side, 0, bands)}));
        set.ranges.push_back(white.back().path);
    }
    const AxisView open = view({});
    set.error = renderer.error();

    const auto add = [&](const std::string& name,
                         const std::function<double(const Spectrum&)>& of) {
        TargetSeries& series = set.series.emplace_back();
        series.name = name;
        for (std::size_t i = 0; i < white.size(); ++i) {
            series.backscatter.push_back(of(black[i].total));
            series.signal.push_back(of(white[i].total) - series.backscatter.back());
            series.clean.push_back(of(white[i].clean));
        }
        series.background = of(open.total);
        series.attenuation = -std::log(of(white[0].transmittance)) / set.ranges[0];
    };
    for (std::size_t b = 0; b < bands; ++b)
        add(fmt::format("{:g} nm", bands_nm[b]), [b](const Spectrum& light) { return light[b]; });
    using Response = ColourDesc::Response;
    const Response response = scene.desc().render.colour.response;
    if (bands == 3 && (response == Response::automatic || response == Response::bands)) return set;
    const BandColour colour = make_band_colour(scene.desc().render.colour, bands_nm);
    for (std::size_t c = 0; c < 3; ++c)
        add(std::string(1, "RGB"[c]),
            [&colour, c](const Spectrum& light) { return colour(light)[c]; });
    return set;
}

double FormulaFit::worst_misfit() const {
    double worst = 0;
    for (const double value : misfit)
        if (std::abs(value) > std::abs(worst)) worst = value;
    return worst;
}

std::optional<std::size_t> FormulaFit::breaks_at(double tolerance) const {
    for (std::size_t i = 0; i < misfit.size(); ++i)
        if (std::abs(misfit[i]) > tolerance) return i;
    return std::nullopt;
}

namespace {

constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

/// The minimum of a function with one, by golden sections.
double least_at(const std::function<double(double)>& function, double low, double high) {
    constexpr double k_golden = 0.6180339887498949;
    constexpr int k_sections = 100;  // to the last bits of a double
    double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
    double at_a = function(a), at_b = function(b);
    for (int i = 0; i < k_sections; ++i) {
        if (at_a < at_b) {
            high = std::exchange(b, a);
            at_b = at_a;
            a = high - k_golden * (high - low);
            at_a = function(a);
        } else {
            low = std::exchange(a, b);
            at_a = at_b;
            b = low + k_golden * (high - low);
            at_b = function(b);
        }
    }
    return 0.5 * (low + high);
}

/// beta_B by least squares.
double backscatter_coefficient(const std::vector<double>& ranges, const TargetSeries& series) {
    const auto misfit = [&](double log_beta) {
        double sum = 0;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            const double formula = -series.background * std::expm1(-std::exp(log_beta) * ranges[i]);
            sum += (formula - series.backscatter[i]) * (formula - series.backscatter[i]);
        }
        return sum;
    };
    // From where the farthest target has a thousandth of B_inf to where the nearest has all of it.
    const double low = std::log(1e-3 / ranges.back()), high = std::log(50 / ranges.front());
    // The sum may have two minima: the best of a lattice is close to the lower one.
    constexpr int k_lattice = 64;
    const double step = (high - low) / k_lattice;
    int best = 0;
    for (int i = 1; i <= k_lattice; ++i)
        if (misfit(low + i * step) < misfit(low + best * step)) best = i;
    return std::exp(least_at(misfit, low + (best - 1) * step, low + (best + 1) * step));
}

}  // namespace

std::optional<FormulaFit> fit_formula(const std::vector<double>& ranges, const TargetSeries& series,
                                      const FormulaOptions& options) {
    FormulaFit fit;
    fit.background = series.background;
    const std::size_t count = ranges.size();
    const auto clean = [&](std::size_t i) {
        return options.divides_falloff ? series.clean[i] : 1.0;
    };
    // Images are of single precision: less of the target's light is rounding of the backscatter.
    constexpr double k_min_signal = 1e-5;
    const auto tells = [&](std::size_t i) {
        return clean(i) > 0 && series.signal[i] > k_min_signal * series.backscatter[i];
    };
    const auto decay = [&](std::size_t i) { return std::log(series.signal[i] / clean(i)); };
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    std::size_t told = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!tells(i)) continue;
        ++told;
        const double target = options.reflectance * series.signal[i];
        const double weight = target / (target + std::max(0.0, series.backscatter[i]));
        w += weight;
        wx += weight * ranges[i];
        wy += weight * decay(i);
        wxx += weight * ranges[i] * ranges[i];
        wxy += weight * ranges[i] * decay(i);
    }
    if (told < 2) return std::nullopt;
    const double slope = (wxy - wx * wy / w) / (wxx - wx * wx / w);
    const double factor = std::exp((wy - slope * wx) / w);
    fit.beta_d = -slope;
    fit.beta_b = series.background > 0 ? backscatter_coefficient(ranges, series) : k_unknown;
    for (std::size_t i = 0; i < count; ++i) {
        fit.white.push_back(factor * clean(i));
        if (i + 1 < count)
            fit.beta_d_here.push_back(tells(i) && tells(i + 1)
                                          ? (decay(i) - decay(i + 1)) / (ranges[i + 1] - ranges[i])
                                          : k_unknown);
        const double left = 1 - series.backscatter[i] / series.background;
        fit.beta_b_here.push_back(left > 0 ? -std::log(left) / ranges[i] + 0.0 : k_unknown);
        const double exact = options.reflectance * series.signal[i] + series.backscatter[i];
        const double veil =
            series.background > 0 ? -series.background * std::expm1(-fit.beta_b * ranges[i]) : 0;
        const double formula =
            options.reflectance * fit.white[i] * std::exp(-fit.beta_d * ranges[i]) + veil;
        fit.misfit.push_back(exact > 0 ? formula / exact - 1 : k_unknown);
    }
    return fit;
}

}  // namespace uw
