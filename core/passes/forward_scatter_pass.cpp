#include "core/passes/forward_scatter_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator_table.h"
#include "core/passes/forward_images.h"
#include "core/passes/pixel_pass.h"
#include "core/passes/water_scatter.h"

namespace uw {

namespace {

// Memory limit for the slabs processed at once [bytes].
constexpr double k_slab_bytes = 256e6;

// A slab of water that begins at a distance s is k_growth (s + offset) thick, with the smaller of
// the two offsets. Where a surface cuts a slab, neighbouring pixels spread the light of the part in
// front of it over the whole slab. The resulting halo around depth edges is of first order in the
// thickness. In the images of `uwvdb validate`, it is up to 0.25 % of the backscatter, no more than
// the error of interpolating blur widths.
constexpr double k_growth = 0.06;
constexpr double k_offset = 0.3;        // m
constexpr double k_offset_depth = 0.6;  // optical depth
// The angle between the rays along which slabs are integrated. Their light is then blurred by
// kernels wider than a tenth of that angle.
constexpr double k_slab_spacing = 0.0091;  // rad

// Makes a value finite and non-negative, so that it can be blurred.
float as_light(double value) {
    constexpr double k_max = 1e30;
    return value > 0 ? static_cast<float>(std::min(value, k_max)) : 0.0F;
}

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

std::vector<double> slab_faces(const Rendering& rendering) {
    const Slabs& slabs = rendering.pixels.in_scatter().slabs();
    std::vector<double> faces;
    if (integrator_kind(rendering.desc.render.integrator).sums_slabs) {
        for (int i = 0; i <= slabs.count; ++i) faces.push_back(slabs.boundary(i));
        return faces;
    }
    // The slabs cover all of the water, wherever those of `backscatter_first` are.
    const LitScene& scene = rendering.pixels.scene();
    const Slabs water = place_slabs(PlanesDesc(), rendering.pixels.rays(), scene);
    const Medium& medium = *scene.medium;
    const double attenuation = medium.uniform.attenuation().greatest(medium.wavelengths_nm.size());
    faces = growing_slabs(water.near, water.far, attenuation);
    for (const double face : {slabs.boundary(0), slabs.boundary(1)})
        if (face > water.near && face < water.far) faces.push_back(face);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

LampPaths::PointColumn lamp_column(const Rendering& rendering) {
    return [&scene = rendering.pixels.scene(), light = rendering.light](
               std::size_t emitter, const Point3& x, std::span<double> column) {
        if (light.empty())
            scene.field->column((*scene.emitters)[emitter].origin(x), x, column);
        else
            light[emitter]->columns(std::span<const Point3>(&x, 1), column);
    };
}

double angle_between(const Ray& a, const Ray& b) {
    return std::atan2(glm::length(glm::cross(a.direction, b.direction)),
                      glm::dot(a.direction, b.direction));
}

void for_each_row(const ScatterPlane& plane, const std::function<void(int y)>& row) {
    parallel_for(static_cast<std::size_t>(plane.height),
                 [&](std::size_t y) { row(static_cast<int>(y)); });
}

void check_memory(const ScatterPlane& plane, std::size_t values_per_pixel) {
    const double bytes = 4.0 * plane.width * plane.height * static_cast<double>(values_per_pixel);
    require_memory(bytes,
                   fmt::format("water.forward_scatter: {} x {} pixels need another", plane.width,
                               plane.height),
                   "render a smaller --size, leave out the lamps' layers, or set K to 0");
}

}  // namespace

/// Stores the pixels of an image, scatters their light, and adds it to the image.
class ForwardScattering {
  public:
    /// What `rendering` refers to must outlive this object. Throws InputError if there is not
    /// enough memory.
    explicit ForwardScattering(const Rendering& rendering);

    /// Stores what the second pass needs of a pixel. Thread safe.
    void keep(const RenderedPixel& pixel);

    /// Scatters everything stored. Throws Interrupted.
    void run(const ProgressCallback& progress);

    /// Adds the result to a film that contains the first pass, and whose window is the whole image.
    void write(const LayerPlan& plan, const BandColour& colour, Film& film) const;

  private:
    /// The light of a lamp whose layer is requested; the first group has that of all other lamps.
    struct Group {
        std::vector<std::size_t> lamps;
        std::vector<ImagePlane> direct;   // per band
        std::vector<ImagePlane> forward;  // per band; irradiance before (14)
    };
    struct SurfaceSums;

    void keep_surfaces(std::size_t i, const RenderedPixel& pixel);
    void add_surface(const RenderedPixel& pixel, std::size_t sample, SurfaceSums& sums) const;
    void scatter_surfaces();
    void scatter_water(const std::function<void(std::size_t slab)>& done);
    // The factors on the light of pixel `i` before and after the blur on its path to the camera.
    double factor_before(std::size_t i) const {
        return sensor_.factors_before_blur() ? pixel_factor_[i] : 1.0;
    }
    double factor_after(std::size_t i) const {
        return sensor_.factors_before_blur() ? 1.0 : pixel_factor_[i];
    }
    std::vector<ImagePlane> planes(std::size_t count) const {
        return std::vector<ImagePlane>(count, ImagePlane(plane_.width, plane_.height));
    }

    const PixelRenderer& renderer_;
    LitScene scene_;
    ForwardScatterDesc desc_;
    SensorModel sensor_;  // the renderer's
    ScatterPlane plane_;
    /// The range of `backscatter_first` in camera z, or in distance along rays; both ends are faces
    /// of slabs.
    Interval first_slab_;
    double spacing_ = 1;  // of the nodes at which in-scattering is integrated [pixels], >= 1
    LampPaths lamp_paths_;
    InScatterSlabs in_scatter_;
    std::size_t bands_;
    std::vector<Group> groups_;
    std::vector<std::size_t> group_of_lamp_;
    bool several_;                         // whether there is more than one group
    std::vector<ImagePlane> direct_;       // per band, unless it is that of the only group
    std::vector<ImagePlane> backscatter_;  // per band, from the first pass
    std::vector<ImagePlane> snow_;         // per band, if there is snow; it is not blurred
    std::vector<ImagePlane> added_;        // per group and band, added to the backscatter
    std::vector<ImagePlane> first_;        // the part in backscatter_first; empty if not requested
    std::vector<ImagePlane> response_;     // per band: radiance at the camera per irradiance [1/sr]
    Grid2D<float> pixel_factor_;
    PathImage from_lamps_, to_camera_;  // of the surfaces
    VisibleWater water_;
};

ScatterPlane scatter_plane(const RaySource& rays) {
    ScatterPlane plane{rays.width(), rays.height(), 1, 1};
    constexpr int k_steps = 64;
    double nearest = 1e300;
    for (int j = 0; j <= k_steps; ++j) {
        for (int i = 0; i <= k_steps; ++i) {
            const double u = static_cast<double>(i) / k_steps - 0.5;
            const double v = static_cast<double>(j) / k_steps - 0.5;
            if (u * u + v * v >= nearest) continue;
            const double x = (u + 0.5) * plane.width, y = (v + 0.5) * plane.height;
            const auto left = rays.refracted_ray(x - 0.5, y),
                       right = rays.refracted_ray(x + 0.5, y);
            const auto above = rays.refracted_ray(x, y - 0.5),
                       below = rays.refracted_ray(x, y + 0.5);
            if (!left || !right || !above || !below) continue;
            nearest = u * u + v * v;
            plane.focal_x = 1 / angle_between(*left, *right);
            plane.focal_y = 1 / angle_between(*above, *below);
        }
    }
    return plane;
}

ForwardScattering::ForwardScattering(const Rendering& rendering)
    : renderer_(rendering.pixels),
      scene_(renderer_.scene()),
      desc_(rendering.desc.water.forward_scatter),
      sensor_(rendering.desc),
      plane_(scatter_plane(renderer_.rays())),
      lamp_paths_(scene_, lamp_column(rendering)),
      // Planes of constant camera z do not cover a view wider than a hemisphere.
      in_scatter_(scene_, *renderer_.transport().integrator, lamp_paths_,
                  renderer_.rays().world_from_camera(), slab_faces(rendering),
                  rendering.desc.camera.distortion.model == DistortionDesc::Model::fisheye,
                  sensor_),
      bands_(static_cast<std::size_t>(renderer_.band_count())) {
    const Slabs& slabs = renderer_.in_scatter().slabs();
    first_slab_ = {slabs.boundary(0), slabs.boundary(1)};
    if (in_scatter_tolerance(rendering.desc.render) > 0)
        spacing_ = std::max(1.0, std::floor(k_slab_spacing * plane_.focal_x));
    const LayerPlan& plan = rendering.plan;
    const bool has_snow = rendering.snow != nullptr;
    groups_.emplace_back();
    for (std::size_t j = 0; j < scene_.lamp_count(); ++j) {
        const bool has_own = plan.first_channel_of_lamp(j) >= 0;
        if (has_own) groups_.emplace_back();
        group_of_lamp_.push_back(has_own ? groups_.size() - 1 : 0);
        groups_[group_of_lamp_.back()].lamps.push_back(j);
    }
    several_ = groups_.size() > 1;
    const bool first = plan.has(Layer::backscatter_first);
    const std::size_t constituents = scene_.medium->constituents.size();
    const std::size_t per_group = (first ? 4 : 3) * bands_;
    check_memory(plane_, 12 + groups_.size() * per_group +
                             (several_ || scene_.lamp_surfaces ? 3 : 2) * bands_ +
                             (has_snow ? bands_ : 0) + 2 * constituents);
    for (Group& group : groups_) {
        group.direct = planes(bands_);
        group.forward = planes(bands_);
    }
    if (several_ || scene_.lamp_surfaces) direct_ = planes(bands_);
    backscatter_ = planes(bands_);
    if (has_snow) snow_ = planes(bands_);
    added_ = planes(groups_.size() * bands_);
    if (first) first_ = planes(groups_.size() * bands_);
    response_ = planes(bands_);
    pixel_factor_.assign(plane_.width, plane_.height, 1.0F);
    from_lamps_ = to_camera_ = {plane_.width, plane_.height, constituents};
    water_ = {plane_.width, plane_.height};
}

void ForwardScattering::keep(const RenderedPixel& pixel) {
    const std::size_t i = pixel_factor_.index(pixel.x, pixel.y);
    pixel_factor_[i] = static_cast<float>(pixel.result.pixel_factor);
    if (pixel.view.ray) water_.set(i, pixel.view, in_scatter_.depth(*pixel.view.ray));
    for (std::size_t b = 0; b < bands_; ++b)
        backscatter_[b][i] = static_cast<float>(pixel.result.backscatter[b] * factor_before(i));
    for (std::size_t b = 0; b < direct_.size(); ++b)
        direct_[b][i] = as_light(pixel.result.direct[b] * factor_before(i));
    for (std::size_t b = 0; b < snow_.size(); ++b)
        snow_[b][i] = static_cast<float>(pixel.result.snow[b] * factor_before(i));
    if (!pixel.view.samples.empty()) keep_surfaces(i, pixel);
}

/// Sums over the samples of one pixel.
struct ForwardScattering::SurfaceSums {
    Spectrum response{};
    std::vector<Spectrum> irradiance, direct;  // per group
    WaterPath from_lamps, to_camera;
    std::vector<double> column;  // of one sample
};

void ForwardScattering::keep_surfaces(std::size_t i, const RenderedPixel& pixel) {
    SurfaceSums sums;
    const std::vector<SurfaceSample>& samples = pixel.view.samples;
    sums.irradiance.assign(groups_.size(), Spectrum{});
    sums.direct.assign(groups_.size(), Spectrum{});
    sums.from_lamps.reset(scene_.medium->constituents.size());
    sums.to_camera.reset(scene_.medium->constituents.size());
    for (std::size_t sample = 0; sample < samples.size(); ++sample)
        add_surface(pixel, sample, sums);
    const double factor = factor_before(i);
    for (std::size_t b = 0; b < bands_; ++b) {
        response_[b][i] = as_light(sums.response[b] * factor);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            groups_[g].forward[b][i] = as_light(sums.irradiance[g][b]);
            groups_[g].direct[b][i] = as_light(sums.direct[g][b] * factor);
        }
        // The forward-scattered light of lamps in view is part of the in-scattered light already.
        if (!several_)
            groups_[0].direct[b][i] =
                as_light((pixel.result.direct[b] - pixel.result.lamps_in_view[b]) * factor);
    }
    const auto set_mean = [&](const WaterPath& sum, PathImage& image) {
        WaterPath mean;
        mean.reset(sum.columns.size());
        mean.add(1.0 / static_cast<double>(samples.size()), sum.length, sum.columns);
        image.set(i, mean);
    };
    set_mean(sums.from_lamps, from_lamps_);
    set_mean(sums.to_camera, to_camera_);
}

void ForwardScattering::add_surface(const RenderedPixel& pixel, std::size_t sample,
                                    SurfaceSums& sums) const {
    const SurfaceSample& surface = pixel.view.samples[sample];
    const SurfaceHit& hit = surface.hit;
    const SurfaceLight& light = pixel.light;
    const std::size_t at = pixel.first_sample + sample;
    std::vector<double>& column = sums.column;
    column.assign(scene_.medium->constituents.size(), 0.0);
    if (!column.empty()) scene_.field->column(surface.ray.origin, hit.position, column);
    sums.to_camera.add(1, hit.distance, column);
    lamp_paths_.add_mean(1, hit.position, sums.from_lamps);
    const double weight = 1.0 / renderer_.samples();
    const double factor = sensor_.surface_factor(hit.distance);
    const std::span<const double> to_camera = light.to_camera(at);
    // Light that was scattered on its path has no single direction, so only the diffuse part of the
    // BRDF reflects it.
    for (std::size_t b = 0; b < bands_; ++b)
        sums.response[b] +=
            weight * hit.reflectance[b] * std::numbers::inv_pi * factor * to_camera[b];
    const auto add_irradiance = [&](std::size_t g, std::size_t j, Spectrum& irradiance) {
        for (std::size_t b = 0; b < bands_; ++b) {
            irradiance[b] = weight * light.irradiance(at, j, b);
            sums.irradiance[g][b] += irradiance[b];
        }
    };
    Spectrum irradiance, brdf;
    if (!several_) {  // the direct light is that of the pixel
        for (std::size_t j = 0; j < light.emitter_count(); ++j)
            if (light.visible(at, j)) add_irradiance(0, j, irradiance);
        return;
    }
    const SurfaceReflection reflection(*scene_.surfaces, surface, static_cast<int>(bands_));
    if (reflection.emits())
        for (std::size_t b = 0; b < bands_; ++b)
            sums.direct[0][b] += weight * reflection.emission()[b] * factor * to_camera[b];
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(at, j)) continue;
        const std::size_t g = group_of_lamp_[light.emitters()[j].index()];
        add_irradiance(g, j, irradiance);
        brdf_for(light.emitters()[j], reflection, surface, brdf);
        for (std::size_t b = 0; b < bands_; ++b)
            sums.direct[g][b] += irradiance[b] * brdf[b] * factor * to_camera[b];
    }
}

void ForwardScattering::run(const ProgressCallback& progress) {
    // In front of all surfaces, the error of a slab is of second order in its thickness, so it may
    // be twice as thick.
    if (spacing_ > 1) in_scatter_.join_pairs(water_.extent().nearest, first_slab_);
    const auto steps = static_cast<double>(in_scatter_.count()) + 1;
    const auto report = [&](std::size_t done) {
        progress(static_cast<double>(done) / steps);
        throw_if_stopped();
    };
    scatter_surfaces();
    report(1);
    scatter_water([&](std::size_t slab) { report(slab + 2); });
}

void ForwardScattering::scatter_surfaces() {
    PathScatter scatter(desc_, plane_, *scene_.medium);
    ImagePlane added(plane_.width, plane_.height), light = added;
    for (Group& group : groups_) {
        for (std::size_t b = 0; b < bands_; ++b) {
            ImagePlane& forward = group.forward[b];
            scatter.add(b, forward, from_lamps_);
            scatter.finish(added);
            for (std::size_t i = 0; i < light.size(); ++i) {
                forward[i] = response_[b][i] * added[i];
                light[i] = group.direct[b][i] + forward[i];
            }
            scatter.add(b, light, to_camera_);
            scatter.finish(added);
            for (std::size_t i = 0; i < light.size(); ++i)
                forward[i] += static_cast<float>(water_.alpha(i)) * added[i];
        }
    }
}

void ForwardScattering::scatter_water(const std::function<void(std::size_t slab)>& done) {
    std::vector<std::vector<std::size_t>> lamps;
    for (const Group& group : groups_) lamps.push_back(group.lamps);
    const SlabLattice lattice(renderer_, in_scatter_, water_, lamps, sensor_, spacing_);
    WaterScatter scatter(desc_, plane_, *scene_.medium, in_scatter_, water_, lattice, spacing_);
    const std::size_t constituents = scene_.medium->constituents.size();
    const double slab_bytes =
        4.0 * lattice.columns() * lattice.rows() *
        static_cast<double>((groups_.size() + 1) * bands_ + 2 + 2 * constituents);
    const auto slabs_at_once = static_cast<std::size_t>(
        std::clamp(k_slab_bytes / slab_bytes, 1.0, static_cast<double>(in_scatter_.count())));
    std::vector<SlabImages> slabs;
    for (std::size_t first = 0; first < in_scatter_.count(); first += slabs_at_once) {
        const std::size_t count = std::min(slabs_at_once, in_scatter_.count() - first);
        slabs.assign(count, lattice.images());
        lattice.integrate(first, slabs);
        for (std::size_t i = 0; i < count; ++i) {
            const double middle = in_scatter_.middle(first + i);
            const bool is_first = first_slab_.begin < middle && middle < first_slab_.end;
            scatter.add(first + i, slabs[i], is_first && !first_.empty() ? first_ : added_);
            done(first + i);
        }
    }
    scatter.finish();
    for (std::size_t n = 0; n < first_.size(); ++n)
        for (std::size_t i = 0; i < first_[n].size(); ++i) added_[n][i] += first_[n][i];
}

void ForwardScattering::write(const LayerPlan& plan, const BandColour& colour, Film& film) const {
    const std::vector<ImagePlane>& direct = direct_.empty() ? groups_[0].direct : direct_;
    for_each_row(plane_, [&](int y) {
        PixelResult pixel;
        for (int x = 0; x < plane_.width; ++x) {
            const std::size_t i = pixel_factor_.index(x, y);
            const auto sum = [&](const auto& of_group) {
                return per_band(bands_, [&](std::size_t b) {
                    double all = 0;
                    for (std::size_t g = 0; g < groups_.size(); ++g)
                        all += static_cast<double>(of_group(g, b));
                    return all;
                });
            };
            pixel.pixel_factor = factor_after(i);
            pixel.direct =
                per_band(bands_, [&](std::size_t b) { return static_cast<double>(direct[b][i]); });
            pixel.forward =
                sum([&](std::size_t g, std::size_t b) { return groups_[g].forward[b][i]; });
            pixel.backscatter =
                sum([&](std::size_t g, std::size_t b) { return added_[g * bands_ + b][i]; });
            for (std::size_t b = 0; b < bands_; ++b)
                pixel.backscatter[b] += static_cast<double>(backscatter_[b][i]);
            for (std::size_t b = 0; b < snow_.size(); ++b)
                pixel.snow[b] = static_cast<double>(snow_[b][i]);
            if (!first_.empty())
                pixel.backscatter_first =
                    sum([&](std::size_t g, std::size_t b) { return first_[g * bands_ + b][i]; });
            const std::span<float> channels = film.pixel(x, y);
            store_forward_scatter(pixel, plan, colour, channels);
            for (std::size_t g = 1; g < groups_.size(); ++g) {
                const auto own = [&](const ImagePlane* planes) {
                    return per_band(
                        bands_, [&](std::size_t b) { return static_cast<double>(planes[b][i]); });
                };
                pixel.forward = own(groups_[g].forward.data());
                pixel.backscatter = own(&added_[g * bands_]);
                add_forward_scatter_of_lamp(pixel, plan, groups_[g].lamps[0], channels);
            }
        }
    });
}

ForwardScatterPass::ForwardScatterPass() : Pass(Stage::forward_scatter) {}
ForwardScatterPass::~ForwardScatterPass() = default;

PassNeeds ForwardScatterPass::needs(const LayerPlan& /*plan*/) const {
    return {.slabs = true, .whole_image = true};
}

void ForwardScatterPass::provide(LayerSupply& supply) const {
    supply.layers |= {Layer::forward};
}

void ForwardScatterPass::begin(Rendering& rendering) {
    scattering_.reset();
    scattering_ = std::make_unique<ForwardScattering>(rendering);
    rendering.steps.emplace_back([this](const RenderedPixel& pixel) { scattering_->keep(pixel); });
}

void ForwardScatterPass::run(Rendering& rendering) {
    scattering_->run(rendering.progress_of(*stage()));
    scattering_->write(rendering.plan, rendering.colour, rendering.film);
    scattering_.reset();
}

}  // namespace uw
