#include "dataset/pinhole_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "core/paths/lattice_fit.h"
#include "dataset/surface_points.h"
#include "render/image_scene.h"

namespace uw {

ModelError model_error(const CameraDesc& model, std::span<const SeenPixel> seen) {
    CameraDesc at_origin = model;
    at_origin.world_from_camera = Affine();
    at_origin.lens.reset();
    const Camera camera(at_origin);
    const double diagonal = std::hypot(model.width, model.height);
    std::vector<double> errors;
    double squares = 0;
    for (const SeenPixel& s : seen) {
        const auto pixel = camera.project(s.point);
        const double error =
            pixel ? std::hypot(pixel->x - s.pixel.x, pixel->y - s.pixel.y) : diagonal;
        errors.push_back(error);
        squares += error * error;
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::ranges::nth_element(errors, middle);
    return {*middle, std::sqrt(squares / static_cast<double>(errors.size())),
            *std::ranges::max_element(errors)};
}

namespace {

/// A lens as a sum: a point is imaged at `first` plus each coefficient times its term, in units of
/// the focal length.
struct LensTerms {
    static constexpr std::size_t k_most = 5;
    using Place = std::array<double, 2>;

    Place first{};
    std::array<Place, k_most> terms{};
};

/// The lens that is fitted: which coefficients it has, and its terms for a point.
class FittedLens {
  public:
    explicit FittedLens(const DistortionDesc& own)
        : is_fisheye_(own.model == DistortionDesc::Model::fisheye),
          radial_(is_fisheye_                ? 4
                  : has_radial_above(own, 2) ? 3
                                             : 2) {}

    std::size_t count() const { return is_fisheye_ ? radial_ : radial_ + 2; }

    /// Whether the lens could image the point at all.
    bool sees(const Point3& point) const { return is_fisheye_ || point.z > 0; }

    LensTerms terms_of(const Point3& p) const {
        LensTerms t;
        const double across = std::hypot(p.x, p.y);
        if (is_fisheye_) {
            const double angle = std::atan2(across, p.z);
            const double scale = across > 0 ? angle / across : 1 / p.z;
            t.first = {scale * p.x, scale * p.y};
            add_radial(t, angle * angle);
            return t;
        }
        const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
        t.first = {x, y};
        add_radial(t, r2);
        t.terms[radial_] = {2 * x * y, r2 + 2 * y * y};
        t.terms[radial_ + 1] = {r2 + 2 * x * x, 2 * x * y};
        return t;
    }

    DistortionDesc desc(std::span<const double> coefficients) const {
        DistortionDesc desc;
        if (is_fisheye_) desc.model = DistortionDesc::Model::fisheye;
        std::copy_n(coefficients.begin(), radial_, desc.k.begin());
        if (!is_fisheye_) std::ranges::copy(coefficients.last(2), desc.p.begin());
        return desc;
    }

  private:
    /// Powers of `square` times the undistorted place.
    void add_radial(LensTerms& t, double square) const {
        double power = 1;
        for (std::size_t i = 0; i < radial_; ++i) {
            power *= square;
            t.terms[i] = {power * t.first[0], power * t.first[1]};
        }
    }

    bool is_fisheye_;
    std::size_t radial_;
};

/// The least squares of a fit: fx, fy, cx, cy, then the lens's coefficients.
class PinholeSquares {
  public:
    PinholeSquares(const FittedLens& lens, std::span<const SeenPixel> seen)
        : size_(4 + lens.count()) {
        for (const SeenPixel& s : seen)
            if (lens.sees(s.point)) points_.push_back({lens.terms_of(s.point), s.pixel});
    }

    /// The sum of the squared errors [pixels^2].
    double sum(std::span<const double> at) const {
        double squares = 0;
        for (const Imaged& point : points_)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                const double missing = point.seen(axis) - place(point, axis, at);
                squares += missing * missing;
            }
        return squares;
    }

    /// The step of Gauss and Newton from there; empty if the points do not determine it.
    std::vector<double> step(std::span<const double> at) const {
        std::vector<double> normal(size_ * size_), right(size_), row(size_);
        for (const Imaged& point : points_)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                std::ranges::fill(row, 0);
                row[axis] = imaged(point, axis, at);
                row[2 + axis] = 1;
                for (std::size_t i = 4; i < size_; ++i)
                    row[i] = at[axis] * point.lens.terms[i - 4][axis];
                const double missing = point.seen(axis) - place(point, axis, at);
                for (std::size_t i = 0; i < size_; ++i) {
                    right[i] += row[i] * missing;
                    for (std::size_t j = 0; j <= i; ++j) normal[i * size_ + j] += row[i] * row[j];
                }
            }
        constexpr double k_min_pivot = 1e-12;
        CholeskyFactor factor;
        if (!factor.factor(normal, size_, k_min_pivot)) return {};
        factor.solve(right);
        return right;
    }

  private:
    struct Imaged {
        LensTerms lens;
        ImagePoint pixel;

        double seen(std::size_t axis) const { return axis == 0 ? pixel.x : pixel.y; }
    };

    /// Where the lens images a point, in units of the focal length.
    double imaged(const Imaged& point, std::size_t axis, std::span<const double> at) const {
        double sum = point.lens.first[axis];
        for (std::size_t i = 4; i < size_; ++i) sum += at[i] * point.lens.terms[i - 4][axis];
        return sum;
    }
    double place(const Imaged& point, std::size_t axis, std::span<const double> at) const {
        return at[axis] * imaged(point, axis, at) + at[2 + axis];
    }

    std::size_t size_;
    std::vector<Imaged> points_;
};

}  // namespace

CameraDesc fit_pinhole(const CameraDesc& camera, std::span<const SeenPixel> seen) {
    const FittedLens lens(camera.distortion);
    const PinholeSquares squares(lens, seen);
    const IntrinsicsDesc& air = camera.intrinsics;
    // Starts with an undistorted lens: apart from products of focal length and coefficients the
    // problem is linear, so that a few steps suffice.
    std::vector<double> here{air.fx, air.fy, air.cx, air.cy};
    here.resize(4 + lens.count());
    double least = squares.sum(here);
    constexpr int k_max_steps = 100;
    constexpr double k_min_damping = 1e-3;  // of a step
    constexpr double k_gain = 1e-12;        // relative, of the sum: less is rounding
    for (int i = 0; i < k_max_steps; ++i) {
        const std::vector<double> step = squares.step(here);
        if (step.empty())
            throw InputError(fmt::format(
                "{}: what the camera sees through its port does not determine a pinhole; leave "
                "--pinhole-fit out, or let the camera see surfaces all over its image",
                camera.where));
        double damping = 1, sum = least;
        std::vector<double> there;
        do {
            there = here;
            for (std::size_t k = 0; k < there.size(); ++k) there[k] += damping * step[k];
            sum = squares.sum(there);
            damping *= 0.5;
        } while (!(sum < least) && damping > k_min_damping);
        if (!(sum < least)) break;
        const bool is_last = least - sum <= k_gain * least;
        here = std::move(there);
        least = sum;
        if (is_last) break;
    }
    CameraDesc fitted = camera;
    fitted.port.reset();
    fitted.intrinsics = {here[0], here[1], here[2], here[3]};
    fitted.distortion = lens.desc(std::span(here).subspan(4));
    return fitted;
}

namespace {

/// The pixels of a camera in a few of its views: first the `on_surfaces` pixels that show a
/// surface, then the others.
struct SeenByCamera {
    std::vector<SeenPixel> pixels;
    std::size_t on_surfaces = 0;
    std::vector<double> distances;  // of surfaces, ascending [m]

    double quantile(double fraction) const {
        return distances[static_cast<std::size_t>(fraction *
                                                  static_cast<double>(distances.size() - 1))];
    }
};

SeenByCamera seen_by_camera(const DatasetDefinition& definition, std::size_t draw,
                            std::size_t camera, const SceneDesc& scene, const Surfaces& surfaces) {
    constexpr std::size_t k_max_views_of_camera = 16;
    constexpr int k_side = 32;
    const std::size_t frames = definition.frames.size();
    const std::size_t views = std::min(frames, k_max_views_of_camera);
    SeenByCamera seen;
    std::vector<ImageSight> open;
    std::vector<Affine> camera_from_world;  // of those
    for (std::size_t i = 0; i < views; ++i) {
        const View view{draw, i * frames / views, camera};
        const Camera eye(camera_of_view(definition, scene, view));
        const Affine from_world = eye.world_from_camera().inverse();
        for (const ImageSight& sight : sights_of(eye, k_side, surfaces)) {
            if (!sight.hit) {
                open.push_back(sight);
                camera_from_world.push_back(from_world);
                continue;
            }
            seen.pixels.push_back({sight.pixel, from_world * sight.hit->position});
            seen.distances.push_back(glm::length(from_origin(seen.pixels.back().point)));
        }
    }
    seen.on_surfaces = seen.pixels.size();
    if (seen.on_surfaces == 0) return seen;
    std::ranges::sort(seen.distances);
    // Where no surface is visible the model should be right at the usual distance: an unconstrained
    // polynomial would be far off there, and other views may show a surface there.
    for (std::size_t i = 0; i < open.size(); ++i)
        seen.pixels.push_back(
            {open[i].pixel, camera_from_world[i] * open[i].ray.at(seen.quantile(0.5))});
    return seen;
}

}  // namespace

PinholeFits fit_pinholes(const DatasetDefinition& definition, std::size_t draw,
                         const SceneDesc& scene, const Surfaces& surfaces) {
    PinholeFits fits;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        auto& fit = fits.emplace_back();
        CameraDesc desc = camera_of_view(definition, scene, {draw, 0, camera});
        if (!desc.port) continue;
        const SeenByCamera seen = seen_by_camera(definition, draw, camera, scene, surfaces);
        if (seen.on_surfaces == 0) continue;
        const std::span on_surfaces = std::span(seen.pixels).first(seen.on_surfaces);
        const CameraDesc fitted = fit_pinhole(desc, seen.pixels);
        desc.port.reset();
        fit = PinholeFit{seen.quantile(0.05),
                         seen.quantile(0.5),
                         seen.quantile(0.95),
                         model_error(desc, on_surfaces),
                         model_error(fitted, on_surfaces),
                         fitted.intrinsics,
                         fitted.distortion};
    }
    return fits;
}

std::string pinhole_file(const DatasetDefinition& definition, std::size_t draw) {
    return definition.folder(draw) + "views/pinholes.json";
}

namespace {

Json error_json(const ModelError& error) {
    return {{"median_px", error.median}, {"rms_px", error.rms}, {"worst_px", error.worst}};
}

ModelError error_from(const Json& json) {
    return {json.at("median_px").get<double>(), json.at("rms_px").get<double>(),
            json.at("worst_px").get<double>()};
}

Json fit_json(const PinholeFit& fit) {
    const IntrinsicsDesc& i = fit.intrinsics;
    return {{"surfaces_m", {fit.nearest, fit.median, fit.farthest}},
            {"in_air", error_json(fit.in_air)},
            {"fitted", error_json(fit.fitted)},
            {"model",
             fit.distortion.model == DistortionDesc::Model::fisheye ? "fisheye" : "brown-conrady"},
            {"intrinsics", {i.fx, i.fy, i.cx, i.cy}},
            {"k", fit.distortion.k},
            {"p", fit.distortion.p}};
}

PinholeFit fit_from(const Json& json) {
    PinholeFit fit;
    const auto numbers = [&json](const char* key, auto... into) {
        std::size_t at = 0;
        ((*into = json.at(key).at(at++).template get<double>()), ...);
    };
    numbers("surfaces_m", &fit.nearest, &fit.median, &fit.farthest);
    fit.in_air = error_from(json.at("in_air"));
    fit.fitted = error_from(json.at("fitted"));
    if (json.at("model") == "fisheye") fit.distortion.model = DistortionDesc::Model::fisheye;
    IntrinsicsDesc& i = fit.intrinsics;
    numbers("intrinsics", &i.fx, &i.fy, &i.cx, &i.cy);
    json.at("k").get_to(fit.distortion.k);
    json.at("p").get_to(fit.distortion.p);
    return fit;
}

}  // namespace

std::string pinhole_text(const PinholeFits& fits) {
    Json list = Json::array();
    for (const auto& fit : fits) list.push_back(fit ? fit_json(*fit) : Json(nullptr));
    return json_text(list);
}

PinholeFits read_pinholes(const std::filesystem::path& file, std::size_t cameras) {
    std::ifstream in = open_own_file(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    try {
        PinholeFits fits;
        for (const Json& entry : Json::parse(in))
            fits.push_back(entry.is_null() ? std::nullopt : std::optional(fit_from(entry)));
        if (fits.size() == cameras) return fits;
    } catch (const Json::exception&) {
        // Reported below.
    }
    throw InputError(
        fmt::format("{}: is not what uwvdb wrote there; make the set again", file.string()));
}

CameraDesc without_port(CameraDesc camera, const std::optional<PinholeFit>& fit, bool is_fitted) {
    if (camera.port && is_fitted && fit) {
        camera.intrinsics = fit->intrinsics;
        camera.distortion = fit->distortion;
    }
    camera.port.reset();
    return camera;
}

std::string error_text(const ModelError& error) {
    return fmt::format("{:.3g} px in the median, {:.3g} px RMS, {:.3g} px at most", error.median,
                       error.rms, error.worst);
}

namespace {

/// The camera of a rig with the greatest error in air; null if that does not matter.
const PinholeFit* max_off(const PinholeFits& fits) {
    const PinholeFit* most = nullptr;
    for (const auto& fit : fits)
        if (fit && (most == nullptr || fit->in_air.rms > most->in_air.rms)) most = &*fit;
    constexpr double k_negligible = 0.1;  // [pixels]
    return most == nullptr || most->in_air.rms < k_negligible ? nullptr : most;
}

}  // namespace

std::string fitted_message(const std::string& formats, const PinholeFits& fits) {
    const PinholeFit* most = max_off(fits);
    if (formats.empty() || most == nullptr) return {};
    return fmt::format(
        "--format {} has no words for a port: the cameras there are pinholes, fitted to surfaces "
        "{:.3g} to {:.3g} m away, and off by {} (those in air: {:.3g} px in the median)",
        formats, most->nearest, most->farthest, error_text(most->fitted), most->in_air.median);
}

std::string in_air_message(const std::string& formats, const std::string& fittable,
                           const PinholeFits& fits) {
    const PinholeFit* most = max_off(fits);
    if (formats.empty() || most == nullptr) return {};
    const std::string whose = fittable.empty()      ? "those of colmap, nerfstudio, euroc and mcap"
                              : fittable == formats ? "them"
                                                    : "those of " + fittable;
    return fmt::format(
        "--format {} has no words for a port: the cameras there are those in air, and off by {}; "
        "--pinhole-fit fits {} to what is seen in the water, to {:.3g} px in the median",
        formats, error_text(most->in_air), whose, most->fitted.median);
}

}  // namespace uw
