#include "render/validation/validation_methods.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "camera/camera.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/light/medium.h"
#include "core/light/planes_integrator.h"
#include "core/passes/forward_scatter_pass.h"
#include "core/passes/pixel_renderer.h"
#include "media/volumes/stratified_field.h"
#include "media/volumes/vdb_writer.h"

namespace uw {

namespace {

constexpr int k_mean_samples = 64;     // along each edge of the field's bounds
constexpr int k_grid_side = 48;        // voxels of the constant grid along each edge
constexpr double k_reach_depths = 15;  // optical depths that the constant grid extends

template <class Scene>
Renderer make_renderer(Scene scene) {
    Renderer renderer;
    renderer.set_scene(std::move(scene));
    return renderer;
}

// `scene` without its volumes, the light that they give off, and strata, in the water of `medium`.
AssembledScene in_water(const ImageScene& scene, Medium medium) {
    Renderer renderer = make_renderer(scene.with([](SceneDesc& desc) {
        desc.volumes.clear();
        std::erase_if(desc.lamps,
                      [](const LampDesc& lamp) { return lamp.emissive_volume.has_value(); });
    }));
    AssembledScene parts = renderer.assemble();
    parts.water.medium = std::move(medium);
    parts.water.strata = nullptr;
    parts.scattering = nullptr;
    parts.field = make_field({}, parts.water.medium.constituent_count(), nullptr);
    return parts;
}

// Mean concentration of each constituent over the grids' bounds; without grids, those at `camera`.
std::vector<double> mean_concentrations(const ConcentrationField& field, const Point3& camera) {
    std::vector<double> mean(static_cast<std::size_t>(field.constituent_count()));
    const Bounds bounds = field.grids().bounds();
    if (bounds.empty()) {
        field.sample(camera, mean);
        return mean;
    }
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
        std::visit(
            [](auto& port) {
                port.fresnel = port.radiance_in_air = false;
                port.dispersion = {};  // what is compared has one ray for all bands
            },
            *camera.port);
}

TrialScene make_trial(const ImageScene& scene) {
    return splatted(make_renderer(scene));
}

TrialScene homogenised(const TrialScene& trial, const ImageScene& scene) {
    Medium medium = trial.scene().water.medium;
    const std::vector<double> mean = mean_concentrations(
        *trial.scene().field, at_origin_plus(trial.scene().camera->world_from_camera().offset()));
    for (std::size_t k = 0; k < mean.size(); ++k)
        add_scaled(medium.uniform, medium.constituents[k].per_unit, mean[k]);
    medium.constituents.clear();
    return splatted(make_renderer(in_water(scene, std::move(medium))));
}

TrialScene with_constant_grid(const TrialScene& trial, const ImageScene& scene, double fraction) {
    Medium medium = trial.scene().water.medium;
    const OpticalCoefficients whole = medium.uniform;
    const OpticalCoefficients none{{}, std::vector<Spectrum>(whole.scattering.size())};
    Constituent water{.name = "water", .unit = "1", .per_unit = none};
    add_scaled(water.per_unit, whole, fraction);
    medium.uniform = none;
    add_scaled(medium.uniform, whole, 1 - fraction);
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

    const ImageScene reduced = scene.with([&](SceneDesc& desc) {
        ForwardScatterDesc& forward = desc.water.forward_scatter;
        forward.G *= 1 - fraction;
        forward.B *= 1 - fraction;
    });
    AssembledScene parts = in_water(reduced, std::move(medium));
    parts.field =
        load_volumes({volume}, {{{GridLoad{0, 1.0}}}}, 1, parts.volume_reports, parts.warnings);
    return splatted(make_renderer(std::move(parts)));
}

Slabs planes_of(const TrialScene& trial, int count) {
    PlanesDesc planes = trial.scene().desc().render.planes;
    planes.count = count;
    return place_slabs(planes, *trial.scene().camera, trial.scene().lit());
}

MethodImage render_method(const TrialScene& trial, const LightTransport& transport) {
    const auto pixels =
        static_cast<std::size_t>(trial.width()) * static_cast<std::size_t>(trial.height());
    MethodImage image;
    image.direct.resize(pixels);
    image.backscatter.resize(pixels);
    const PixelRenderer renderer(*trial.scene().camera, trial.scene().lit(), transport, {},
                                 trial.scene().slabs.value());
    parallel_for(static_cast<std::size_t>(trial.height()), [&](std::size_t row) {
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
    const LayerPlan plan = layer_plan(trial.scene().image, layers);
    const std::size_t bands = trial.scene().desc().water.bands_nm.size();
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

double mean_over_pixels(const std::vector<Spectrum>& image, std::size_t band) {
    double sum = 0;
    for (const Spectrum& pixel : image) sum += pixel[band];
    return sum / static_cast<double>(image.size());
}

double max_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      const std::vector<char>& counted, std::size_t band, double dark) {
    const double floor = dark * mean_over_pixels(b, band);
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

namespace {

constexpr int k_fewest_planes = 8;
// No more shadow rays than this for a sum that is refined beyond the requested number of slabs.
constexpr std::size_t k_max_shadow_rays = 20'000'000;

// The largest relative difference of the backscatter over smooth pixels and bands.
double max_change(const MethodImage& from, const MethodImage& to, const std::vector<char>& smooth,
                  std::size_t bands) {
    double largest = 0;
    for (std::size_t band = 0; band < bands; ++band)
        largest = std::max(largest,
                           max_difference(from.backscatter, to.backscatter, smooth, band, k_dark));
    return largest;
}

MethodImage sum_over(const TrialScene& uniform, int count) {
    const LightTransport transport{
        std::make_unique<PlanesIntegrator>(uniform.scene().lit(),
                                           uniform.scene().camera->world_from_camera(),
                                           planes_of(uniform, count)),
        std::make_unique<DirectLighting>(uniform.scene().lit())};
    return render_method(uniform, transport);
}

}  // namespace

PlaneSums sum_planes_to_limit(const TrialScene& uniform, const std::vector<char>& smooth,
                              const PlaneSumOptions& options) {
    const std::size_t bands = uniform.scene().desc().water.bands_nm.size();
    const auto rays_of = [&](int count) {
        return static_cast<std::size_t>(count) * uniform.scene().emitters.size() * smooth.size();
    };
    std::vector<MethodImage> sums;
    const auto rough = [&] {
        return max_change(sums.back(), sums[sums.size() - 2], smooth, bands) > options.tolerance;
    };
    for (int count = k_fewest_planes;
         count <= options.max_planes || (rays_of(count) <= k_max_shadow_rays && rough());
         count *= 2) {
        options.say(planes_name(count));
        sums.push_back(sum_over(uniform, count));
    }
    PlaneSums result{sums.back(), sums.back(), sums[sums.size() - 2], {}};
    for (std::size_t i = 0; i < result.limit.backscatter.size(); ++i)
        result.limit.backscatter[i] +=
            (result.limit.backscatter[i] - result.coarser.backscatter[i]) / 3;
    for (std::size_t n = 0; n < sums.size(); ++n) {
        PlanesStep step{k_fewest_planes << n, max_change(sums[n], result.limit, smooth, bands), 0};
        if (n > 0 && step.error > 0) step.order = std::log2(result.steps.back().error / step.error);
        result.steps.push_back(step);
    }
    return result;
}

std::string planes_name(int count) {
    return "planes, " + std::to_string(count);
}

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
        : side_(static_cast<std::size_t>(reach) + 1), fractions_(side_ * side_) {
        const double s = std::max(width_x, k_narrowest), t = std::max(width_y, k_narrowest);
        for (std::size_t j = 0; j < side_; ++j)
            for (std::size_t i = 0; i < side_; ++i)
                fractions_[j * side_ + i] = corner(shape, (static_cast<double>(i) + 0.5) / s,
                                                   (static_cast<double>(j) + 0.5) / t);
        outside_ = 1 - 4 * fractions_.back();
        // Differences turn integrals over [0, x] x [0, y] into those over pixels; the kernel is
        // even.
        const auto difference = [this](std::size_t begin, std::size_t step) {
            double* const first = fractions_.data() + begin;
            for (std::size_t i = side_ - 1; i > 0; --i) first[i * step] -= first[(i - 1) * step];
            first[0] *= 2;
        };
        for (std::size_t i = 0; i < side_; ++i) difference(i * side_, 1);
        for (std::size_t i = 0; i < side_; ++i) difference(i, side_);
    }

    double fraction(int across, int down) const {
        return fractions_[static_cast<std::size_t>(std::abs(down)) * side_ +
                          static_cast<std::size_t>(std::abs(across))];
    }
    /// The fraction that goes beyond these pixels.
    double outside() const { return outside_; }

  private:
    // Integral over [0, x] x [0, y], in units of s: for the exponential kernel the solid angle of
    // the rectangle as viewed from height 1, over 2 pi; for the Gaussian one of variance 2.
    static double corner(ForwardScatterDesc::Shape shape, double x, double y) {
        if (shape == ForwardScatterDesc::Shape::exponential)
            return std::atan2(x * y, std::sqrt(1 + x * x + y * y)) / (2 * std::numbers::pi);
        return std::erf(x / 2) * std::erf(y / 2) / 4;
    }

    std::size_t side_;
    std::vector<double> fractions_;
    double outside_ = 0;
};

// The pixel of an image of `side` pixels that its mirror images have at position `i`.
int mirrored(int i, int side) {
    const int place = ((i % (2 * side)) + 2 * side) % (2 * side);
    return place < side ? place : 2 * side - 1 - place;
}

/// The surfaces at a camera's pixels.
struct SurfaceImage {
    Image irradiance, response;               // W/m^2; radiance at the camera per irradiance [1/sr]
    Image direct;                             // radiance at the camera that was not scattered
    std::vector<double> to_lamps, to_camera;  // m
    std::vector<char> in_water;               // whether a ray enters it
};

class DirectSum {
  public:
    explicit DirectSum(const TrialScene& trial)
        : trial_(trial),
          desc_(trial.scene().desc().water.forward_scatter),
          plane_(scatter_plane(*trial.scene().camera)),
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
                seen.to_lamps[i] += distance(emitter.origin(hit.position), hit.position) *
                                    emitter.fraction() / lamps;
            const SurfaceReflection reflection(*trial_.scene().surfaces, sample,
                                               static_cast<int>(bands_));
            Spectrum brdf;
            for (std::size_t j = 0; j < emitters.size(); ++j) {
                if (!light.visible(0, j)) continue;
                brdf_for(emitters[j], reflection, sample, brdf);
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
        std::vector<double> fractions(pixels_, kernel.outside() / static_cast<double>(pixels_));
        for (int down = -reach; down <= reach; ++down) {
            const auto row = static_cast<std::size_t>(mirrored(y + down, trial_.height()));
            double* const into = fractions.data() + row * static_cast<std::size_t>(trial_.width());
            for (std::size_t i = 0; i < columns.size(); ++i)
                into[columns[i]] += kernel.fraction(static_cast<int>(i) - reach, down);
        }
        for (std::size_t i = 0; i < pixels_; ++i)
            for (std::size_t b = 0; b < bands_; ++b) image[i][b] += fractions[i] * scattered[b];
    }

    const TrialScene& trial_;
    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    std::size_t bands_, pixels_;
};

}  // namespace

std::vector<Spectrum> forward_by_direct_sum(const TrialScene& trial,
                                            const SurfaceLighting& lighting) {
    return DirectSum(trial).forward(lighting);
}

}  // namespace uw
