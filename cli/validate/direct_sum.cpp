#include "cli/validate/direct_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

using Image = std::vector<Spectrum>;

// Mirror images are summed out to this many image sides; light that goes farther is spread evenly.
// Doubling it changes no pixel by more than 2e-4 (exponential, 6 pixels wide).
constexpr int k_reach_sides = 4;
// A kernel narrower than this leaves all its light in its pixel [pixels].
constexpr double k_narrowest = 1e-6;

/// Fractions of one pixel's light that reach the pixels 0..reach away from it in either direction.
class Kernel {
  public:
    Kernel(ForwardScatterDesc::Shape shape, double width_x, double width_y, int reach)
        : side_(static_cast<std::size_t>(reach) + 1), shares_(side_ * side_) {
        const double s = std::max(width_x, k_narrowest), t = std::max(width_y, k_narrowest);
        for (std::size_t j = 0; j < side_; ++j)
            for (std::size_t i = 0; i < side_; ++i)
                shares_[j * side_ + i] = corner(shape, (static_cast<double>(i) + 0.5) / s,
                                                (static_cast<double>(j) + 0.5) / t);
        outside_ = 1 - 4 * shares_.back();
        // From integrals over [0, x] x [0, y] to those over pixels; the kernel is even.
        const auto difference = [this](std::size_t begin, std::size_t step) {
            double* const first = shares_.data() + begin;
            for (std::size_t i = side_ - 1; i > 0; --i) first[i * step] -= first[(i - 1) * step];
            first[0] *= 2;
        };
        for (std::size_t i = 0; i < side_; ++i) difference(i * side_, 1);
        for (std::size_t i = 0; i < side_; ++i) difference(i, side_);
    }

    double share(int across, int down) const {
        return shares_[static_cast<std::size_t>(std::abs(down)) * side_ +
                       static_cast<std::size_t>(std::abs(across))];
    }
    /// The fraction that goes farther than the reach.
    double outside() const { return outside_; }

  private:
    // Integral over [0, x] x [0, y], in units of s: of the exponential kernel the solid angle of
    // the rectangle seen from height 1, over 2 pi; of a Gaussian of variance 2.
    static double corner(ForwardScatterDesc::Shape shape, double x, double y) {
        if (shape == ForwardScatterDesc::Shape::exponential)
            return std::atan2(x * y, std::sqrt(1 + x * x + y * y)) / (2 * std::numbers::pi);
        return std::erf(x / 2) * std::erf(y / 2) / 4;
    }

    std::size_t side_;
    std::vector<double> shares_;
    double outside_ = 0;
};

// Where the mirror images of an image `side` pixels long have pixel `i`.
int mirrored(int i, int side) {
    const int place = ((i % (2 * side)) + 2 * side) % (2 * side);
    return place < side ? place : 2 * side - 1 - place;
}

/// What a camera's pixels see of surfaces.
struct SurfaceImage {
    Image irradiance, response;               // W/m^2; radiance at the camera per irradiance [1/sr]
    Image direct;                             // radiance at the camera that was not scattered
    std::vector<double> to_lamps, to_camera;  // m
    std::vector<char> in_water;               // whether a ray enters it
};

class DirectSum {
  public:
    DirectSum(const TrialScene& trial, const std::function<bool()>& proceed)
        : trial_(trial),
          proceed_(proceed),
          desc_(trial.scene().desc.water.forward_scatter),
          plane_(forward_scatter_setup(trial.scene(), trial.light()).plane),
          bands_(static_cast<std::size_t>(trial.scene().water.medium.band_count())),
          pixels_(static_cast<std::size_t>(trial.width() * trial.height())) {}

    Image forward(const SurfaceLighting& lighting) const {
        const SurfaceImage seen = trace(lighting);
        Image forward = scattered(seen.irradiance, seen.to_lamps);  // (14)
        Image radiance(pixels_);
        for_each([&](std::size_t i, std::size_t b) {
            forward[i][b] *= seen.response[i][b];
            radiance[i][b] = seen.direct[i][b] + forward[i][b];
        });
        const Image signal = scattered(radiance, seen.to_camera);  // (16)
        for_each([&](std::size_t i, std::size_t b) {
            if (seen.in_water[i] != 0) forward[i][b] += signal[i][b];
        });
        return forward;
    }

  private:
    void for_each(const std::function<void(std::size_t pixel, std::size_t band)>& body) const {
        for (std::size_t i = 0; i < pixels_; ++i)
            for (std::size_t b = 0; b < bands_; ++b) body(i, b);
    }

    SurfaceImage trace(const SurfaceLighting& lighting) const {
        SurfaceImage seen{Image(pixels_),
                          Image(pixels_),
                          Image(pixels_),
                          std::vector<double>(pixels_),
                          std::vector<double>(pixels_),
                          std::vector<char>(pixels_)};
        const std::vector<Lamp>& emitters = trial_.scene().emitters;
        const auto lamps = static_cast<double>(trial_.scene().lamps.size());
        parallel_for(pixels_, [&](std::size_t i) {
            const int x = static_cast<int>(i) % trial_.width();
            const int y = static_cast<int>(i) / trial_.width();
            const std::optional<Ray> ray = trial_.scene().camera->refracted_ray(x + 0.5, y + 0.5);
            if (!ray) return;
            seen.in_water[i] = 1;
            SurfaceSample sample{*ray, {}, x + 0.5, y + 0.5};
            const SurfaceHit& hit = sample.hit;
            if (!trial_.scene().surfaces->closest_hit(*ray, k_far, sample.hit)) return;
            SurfaceLight light;
            lighting.evaluate_one(sample, light);
            seen.to_camera[i] = hit.distance;
            for (const Lamp& emitter : emitters)
                seen.to_lamps[i] +=
                    distance(emitter.origin(hit.position), hit.position) * emitter.share() / lamps;
            const SurfaceReflection reflection(*trial_.scene().surfaces, sample,
                                               static_cast<int>(bands_));
            Spectrum brdf;
            for (std::size_t j = 0; j < emitters.size(); ++j) {
                if (!light.visible(0, j)) continue;
                reflection.brdf(emitters[j].origin(hit.position), brdf);
                for (std::size_t b = 0; b < bands_; ++b) {
                    seen.irradiance[i][b] += light.irradiance(0, j, b);
                    seen.direct[i][b] += light.irradiance(0, j, b) * brdf[b];
                }
            }
            for (std::size_t b = 0; b < bands_; ++b) {
                const double transmittance = light.to_camera(0)[b];
                seen.response[i][b] = hit.reflectance[b] * std::numbers::inv_pi * transmittance;
                if (reflection.emits()) seen.direct[i][b] += reflection.emission()[b];
                seen.direct[i][b] *= transmittance;
            }
        });
        return seen;
    }

    // The change due to `light` when every pixel spreads its own over its own range.
    Image scattered(const Image& light, const std::vector<double>& range) const {
        const auto height = static_cast<std::size_t>(trial_.height());
        const auto width = static_cast<std::size_t>(trial_.width());
        std::vector<Image> of_rows(height);
        parallel_for(height, [&](std::size_t y) {
            if (!proceed_()) throw Interrupted();
            of_rows[y].resize(pixels_);
            for (std::size_t x = 0; x < width; ++x)
                spread(static_cast<int>(x), static_cast<int>(y), light[y * width + x],
                       range[y * width + x], of_rows[y]);
        });
        Image sum(pixels_);
        for (const Image& row : of_rows)
            for_each([&](std::size_t i, std::size_t b) { sum[i][b] += row[i][b]; });
        return sum;
    }

    void spread(int x, int y, const Spectrum& light, double range, Image& image) const {
        Spectrum scattered{};
        for (std::size_t b = 0; b < bands_; ++b) {
            const double c = trial_.scene().water.medium.uniform.attenuation(static_cast<int>(b));
            scattered[b] = light[b] * desc_.K * (std::exp(-desc_.G * range) - std::exp(-c * range));
        }
        if (*std::max_element(scattered.begin(), scattered.end()) == 0) return;
        const int reach = k_reach_sides * std::max(trial_.width(), trial_.height());
        const double per_pixel = desc_.B * range / (2 * std::numbers::pi);
        const Kernel kernel(desc_.shape, plane_.focal_x * per_pixel, plane_.focal_y * per_pixel,
                            reach);
        std::vector<std::size_t> columns;
        for (int across = -reach; across <= reach; ++across)
            columns.push_back(static_cast<std::size_t>(mirrored(x + across, trial_.width())));
        std::vector<double> shares(pixels_, kernel.outside() / static_cast<double>(pixels_));
        for (int down = -reach; down <= reach; ++down) {
            const auto row = static_cast<std::size_t>(mirrored(y + down, trial_.height()));
            double* const into = shares.data() + row * static_cast<std::size_t>(trial_.width());
            for (std::size_t i = 0; i < columns.size(); ++i)
                into[columns[i]] += kernel.share(static_cast<int>(i) - reach, down);
        }
        for (std::size_t i = 0; i < pixels_; ++i)
            for (std::size_t b = 0; b < bands_; ++b) image[i][b] += shares[i] * scattered[b];
    }

    const TrialScene& trial_;
    const std::function<bool()>& proceed_;
    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    std::size_t bands_, pixels_;
};

}  // namespace

std::vector<Spectrum> forward_by_direct_sum(const TrialScene& trial,
                                            const SurfaceLighting& lighting,
                                            const std::function<bool()>& proceed) {
    return DirectSum(trial, proceed).forward(lighting);
}

}  // namespace uw
