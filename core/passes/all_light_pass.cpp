#include "core/passes/all_light_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/paths/multiple_nodes.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/surface_glow.h"

namespace uw {

namespace {

constexpr int k_least_spacing = 4;
constexpr double k_most_numbers = 1e7;  // kept, for the whole image

}  // namespace

WeightLattice::WeightLattice(const RaySource& rays, const IntervalWeights& weights,
                             const PixelWindow& window)
    : uniform_(weights.of_uniform_water()) {
    if (!weights.vary()) return;
    const double numbers =
        static_cast<double>(rays.width()) * rays.height() * static_cast<double>(uniform_.size());
    spacing_ =
        std::max(k_least_spacing, static_cast<int>(std::ceil(std::sqrt(numbers / k_most_numbers))));
    column_ = window.x0 / spacing_;
    row_ = window.y0 / spacing_;
    const int columns = (window.x1 + spacing_ - 1) / spacing_ - column_ + 1;
    const int rows = (window.y1 + spacing_ - 1) / spacing_ - row_ + 1;
    rays_.assign(columns, rows);
    parallel_for(rays_.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto ray = rays.refracted_ray((column_ + i) * static_cast<double>(spacing_),
                                            (row_ + j) * static_cast<double>(spacing_));
        if (ray)
            weights.find(*ray, rays_[at]);
        else
            rays_[at] = uniform_;
    });
}

void WeightLattice::find(double x, double y, std::vector<float>& weights) const {
    if (rays_.size() == 0) {
        weights = uniform_;
        return;
    }
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, rays_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, rays_.height() - 2);
    weights.assign(uniform_.size(), 0.0F);
    const auto add = [&](int column, int row, double share) {
        const std::vector<float>& corner = rays_(column, row);
        for (std::size_t k = 0; k < weights.size(); ++k)
            weights[k] += static_cast<float>(share) * corner[k];
    };
    add(i, j, (1 - u + i) * (1 - v + j));
    add(i + 1, j, (u - i) * (1 - v + j));
    add(i, j + 1, (1 - u + i) * (v - j));
    add(i + 1, j + 1, (u - i) * (v - j));
}

namespace {

/// The radiance of surfaces that SurfaceGlow blurs: by direct light and emission, which are exact,
/// and roughly by the light that has been scattered or reflected before: as much as in proportion
/// to the direct light and, beside it, from an even ambient light explains most of it.
class GlowSource {
  public:
    /// Estimates the rough part for each group and band. Both references must outlive this object.
    GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator);

    /// The radiance at the camera of `sample`, number `index` of `light`, by group and band. Thread
    /// safe.
    void find_radiance(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                       std::span<double> radiance) const;

  private:
    struct Indirect {
        double per_direct = 0;
        double ambient = 0;  // what a white surface would reflect [W m^-2 sr^-1]
    };

    void find_indirect();
    void add_direct(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                    std::span<double> radiance) const;

    const PixelRenderer& pixels_;
    const MultipleNodes& estimator_;
    std::size_t bands_;
    std::vector<Indirect> indirect_;  // by group and band
};

GlowSource::GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator)
    : pixels_(pixels),
      estimator_(estimator),
      bands_(static_cast<std::size_t>(pixels.band_count())) {
    find_indirect();
}

void GlowSource::find_radiance(const SurfaceSample& sample, const SurfaceLight& light,
                               std::size_t index, std::span<double> radiance) const {
    std::ranges::fill(radiance, 0.0);
    add_direct(sample, light, index, radiance);
    const std::span<const double> to_camera = light.to_camera(index);
    for (std::size_t k = 0; k < radiance.size(); ++k) {
        const double white = sample.hit.reflectance[k % bands_] * to_camera[k % bands_];
        radiance[k] += indirect_[k].per_direct * radiance[k] + indirect_[k].ambient * white;
    }
}

// Adds what the surface emits, and the light of lamps that it reflects.
void GlowSource::add_direct(const SurfaceSample& sample, const SurfaceLight& light,
                            std::size_t index, std::span<double> radiance) const {
    const std::size_t groups = estimator_.options().groups;
    const LitScene& scene = pixels_.scene();
    const std::span<const double> to_camera = light.to_camera(index);
    const SurfaceReflection reflection(*scene.surfaces, sample, static_cast<int>(bands_));
    if (reflection.emits())
        for (std::size_t b = 0; b < bands_; ++b)
            radiance[(groups - 1) * bands_ + b] += reflection.emission()[b] * to_camera[b];
    Spectrum brdf;
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(index, j)) continue;
        const Lamp& emitter = light.emitters()[j];
        reflection.brdf(emitter.origin(sample.hit.position), brdf);
        double* sum = &radiance[std::min(emitter.index(), groups - 1) * bands_];
        for (std::size_t b = 0; b < bands_; ++b)
            sum[b] += light.irradiance(index, j, b) * brdf[b] * to_camera[b];
    }
}

// By least squares over a few surfaces all over the image, whatever part of it is rendered.
void GlowSource::find_indirect() {
    constexpr int k_across = 16, k_paths = 64;
    const RaySource& rays = pixels_.rays();
    const std::size_t values = estimator_.options().groups * bands_;
    // What the camera sees of a surface, by group and band.
    struct Seen {
        std::vector<double> direct, indirect, white;  // white: per ambient light
    };
    std::vector<Seen> seen(k_across * k_across);
    parallel_for(seen.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % k_across, j = static_cast<int>(at) / k_across;
        const double x = (i + 0.5) * rays.width() / k_across;
        const double y = (j + 0.5) * rays.height() / k_across;
        const std::optional<Ray> ray = rays.refracted_ray(x, y);
        if (!ray) return;
        SurfaceSample sample{*ray, {}, x, y};
        if (!pixels_.scene().surfaces->closest_hit(*ray, k_far, sample.hit)) return;
        SurfaceLight light;
        pixels_.transport().surfaces->evaluate_one(sample, light);
        Seen& of = seen[at];
        of.direct.assign(values, 0.0);
        add_direct(sample, light, 0, of.direct);
        NodeLight diffuse;
        estimator_.estimate_surface(sample, k_paths, diffuse);
        for (std::size_t k = 0; k < values; ++k) {
            of.white.push_back(sample.hit.reflectance[k % bands_] *
                               std::as_const(light).to_camera(0)[k % bands_]);
            of.indirect.push_back(static_cast<double>(diffuse.diffuse[k]) * of.white.back());
        }
    });
    indirect_.assign(values, {});
    for (std::size_t k = 0; k < values; ++k) {
        double dd = 0, dw = 0, ww = 0, di = 0, wi = 0;
        for (const Seen& of : seen) {
            if (of.direct.empty()) continue;
            dd += of.direct[k] * of.direct[k];
            dw += of.direct[k] * of.white[k];
            ww += of.white[k] * of.white[k];
            di += of.direct[k] * of.indirect[k];
            wi += of.white[k] * of.indirect[k];
        }
        // Neither may be negative; if one is, the other stands alone.
        constexpr double k_independent = 1e-6;
        const double determinant = dd * ww - dw * dw;
        Indirect& of = indirect_[k];
        if (determinant > k_independent * dd * ww) {
            of.per_direct = (di * ww - wi * dw) / determinant;
            of.ambient = (wi * dd - di * dw) / determinant;
        }
        if (!(of.ambient > 0)) of = {dd > 0 ? di / dd : 0, 0};
        if (!(of.per_direct > 0)) of = {0, ww > 0 ? wi / ww : 0};
    }
}

/// How much is spent on the light that was scattered or reflected more than once.
struct MultipleLightOptions {
    int paths = 0;       // in the whole image, of each kind, at its nodes, at most
    double error = 0;    // standard error for which fewer will do, relative to the image's mean
    int nodes = 0;       // about as many
    int cells = 0;       // of the surfaces' glow, at most
    bool lamps = false;  // each lamp's light by itself
};

// The paths of a node: more would leave less noise than there is light between the nodes of a small
// image.
constexpr int k_fewest_node_paths = 16, k_most_node_paths = 1024;
// What smoothing leaves of the variance of nodes, in the example scenes: 0.03 to 0.06, in plumes
// more.
constexpr double k_smoothed_variance = 0.04;
constexpr double k_least_share_of_paths = 0.2;
// The share of the paths that go into the question how many are needed.
constexpr double k_pilot_share = 0.05;
// Nodes see the same surface as a pixel if its normal agrees with theirs (k_least_node_cosine) and
// it lies no farther from their tangent plane than this, relative to its distance.
constexpr double k_most_slope = 0.35;
constexpr double k_least_cosine_of_match = 0.7;  // of normals, where no node agrees better
constexpr int k_search = 3;            // cells around a pixel without a match at its corners
constexpr int k_paths_of_sample = 32;  // where there is none at all
constexpr int k_mirrored_paths = 8;    // of a pixel whose surfaces are glossy

double lerp_weight(double t, int side) {
    return side == 0 ? 1 - t : t;
}

// The least that leaves no more nodes, apart from those at the edges.
int spacing_for(const RaySource& rays, int nodes) {
    const double area = static_cast<double>(rays.width()) * rays.height();
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(area / nodes))));
}

// In the whole image.
int node_count(const RaySource& rays, int spacing) {
    return ((rays.width() + spacing - 1) / spacing + 1) *
           ((rays.height() + spacing - 1) / spacing + 1);
}

}  // namespace

/// The light of AllLightPass in one image.
class MultipleLight {
  public:
    /// `pixels` must outlive this object; its transport has paths.
    MultipleLight(const PixelRenderer& pixels, const MultipleLightOptions& options);

    /// Estimates the light of the pixels of `window`. Throws Interrupted, and InputError if the
    /// nodes do not fit into free memory.
    void prepare(const PixelWindow& window, const ShareCallback& progress);

    /// Adds a pixel's light to multiple_volume, multiple_surface and the lamps of `result`. The
    /// samples of `view` begin at `first_sample` of `light`. Thread safe.
    void add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
             PixelResult& result) const;

    /// The standard error of this light: the RMS over the nodes over the mean of all light.
    double error() const { return error_; }

  private:
    struct Corner {
        const SmoothNode* node;
        double weight;
    };

    void limit_paths(double error);
    void take_away_glow(Grid2D<MultipleNode>& raw);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_matches(double x, double y, const SurfaceHit& hit,
                      std::vector<Corner>& matches) const;
    void find_matches(double x, double y, const SurfaceHit& hit, double least_cosine,
                      std::vector<Corner>& matches) const;
    void add_water(const PixelView& view, std::span<double> light) const;
    void add_volume(const PixelView& view, PixelResult& result) const;
    void add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                     PixelResult& result) const;
    void give(std::size_t group, std::size_t band, double radiance, PixelResult& result) const;

    const PixelRenderer& pixels_;
    std::size_t bands_;
    int spacing_ = 1;           // of the nodes [pixels]
    int column_ = 0, row_ = 0;  // of the first node of nodes_
    DistanceIntervals intervals_;
    IntervalWeights weights_;
    MultipleNodes estimator_;
    WeightLattice weight_lattice_;  // from prepare on, as the following
    Grid2D<SmoothNode> nodes_;
    int cells_ = 0;
    std::optional<SurfaceGlow> glow_;
    double error_ = 0;
};

MultipleLight::MultipleLight(const PixelRenderer& pixels, const MultipleLightOptions& options)
    : pixels_(pixels),
      bands_(static_cast<std::size_t>(pixels.band_count())),
      spacing_(spacing_for(pixels.rays(), options.nodes)),
      intervals_(pixels.rays(), pixels.scene()),
      weights_(pixels.scene(), intervals_),
      estimator_(pixels.rays(), pixels.scene(), pixels.transport(), weights_,
                 {options.lamps ? static_cast<std::size_t>(pixels.lamp_count()) + 1 : 1,
                  std::clamp(options.paths / node_count(pixels.rays(), spacing_),
                             k_fewest_node_paths, k_most_node_paths)}),
      cells_(options.cells) {
    if (options.error > 0) limit_paths(options.error);
}

// To those that are needed for a standard error.
void MultipleLight::limit_paths(double error) {
    const int most = estimator_.options().paths;
    const double variance =
        estimator_.relative_variance(k_pilot_share * most * node_count(pixels_.rays(), spacing_));
    const double needed = k_smoothed_variance * variance / (error * error);
    const double least = std::max<double>(k_fewest_node_paths, k_least_share_of_paths * most);
    if (needed < most) estimator_.set_paths(static_cast<int>(std::max(needed, least)));
}

void MultipleLight::prepare(const PixelWindow& window, const ShareCallback& progress) {
    // The corners of all cells in the window, and what these are fitted to.
    constexpr int k_margin = k_smoothing_reach + k_search + 1;
    const RaySource& rays = pixels_.rays();
    column_ = std::max(0, window.x0 / spacing_ - k_margin);
    row_ = std::max(0, window.y0 / spacing_ - k_margin);
    const int last_column = std::min((rays.width() + spacing_ - 1) / spacing_,
                                     (window.x1 - 1) / spacing_ + 1 + k_margin);
    const int last_row = std::min((rays.height() + spacing_ - 1) / spacing_,
                                  (window.y1 - 1) / spacing_ + 1 + k_margin);
    const int columns = last_column - column_ + 1, rows = last_row - row_ + 1;
    Grid2D<MultipleNode> raw;
    require_room_for_nodes(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                           intervals_.count(), estimator_.options().groups, pixels_.scene());
    raw.assign(columns, rows);
    std::atomic<std::size_t> done = 0;
    const std::size_t count = raw.size();
    parallel_for(count, [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto column = static_cast<std::uint64_t>(column_ + i);
        const auto row = static_cast<std::uint64_t>(row_ + j);
        estimator_.estimate((column_ + i) * static_cast<double>(spacing_),
                            (row_ + j) * static_cast<double>(spacing_),
                            PathRandom::seed_of(column, row), raw(i, j));
        progress(static_cast<double>(++done) / static_cast<double>(count));
    });
    take_away_glow(raw);
    weight_lattice_ = WeightLattice(rays, weights_, window);
    nodes_ = smoothed(raw, intervals_, estimator_.options().groups);
    double variance = 0, light = 0;
    for (const SmoothNode& node : nodes_) {
        light += node.mean_light;
        variance += node.variance;
    }
    const auto all = static_cast<double>(nodes_.size());
    error_ = light > 0 ? std::sqrt(variance * all) / light : 0;
}

// Computes the glow, and leaves in the nodes what they hold beside it.
void MultipleLight::take_away_glow(Grid2D<MultipleNode>& raw) {
    const std::size_t groups = estimator_.options().groups;
    const GlowSource source(pixels_, estimator_);
    const auto radiance = [&](const SurfaceSample& sample, const SurfaceLight& light,
                              std::size_t index, std::span<double> channels) {
        source.find_radiance(sample, light, index, channels);
    };
    std::vector<SurfaceGlow::Position> positions;
    for (int j = 0; j < raw.height(); ++j)
        for (int i = 0; i < raw.width(); ++i)
            positions.push_back({(column_ + i) * static_cast<double>(spacing_),
                                 (row_ + j) * static_cast<double>(spacing_)});
    glow_.emplace(pixels_.rays(), pixels_.scene(), *pixels_.transport().surfaces, intervals_,
                  groups * bands_, cells_, radiance, positions);
    const std::size_t values = groups * bands_;
    for (std::size_t n = 0; n < raw.size(); ++n) {
        MultipleNode& node = raw[n];
        if (!node.has_ray) continue;
        const std::span<const float> glow = glow_->of_node(n);
        for (std::size_t i = 0; i < glow_->interval_count(); ++i) {
            if (intervals_.begin(i) >= node.reach) break;
            for (NodeLight& half : node.halves) {
                float mean = 0;
                for (std::size_t k = 0; k < values; ++k) {
                    half.water[i * values + k] -= glow[i * values + k];
                    mean += glow[i * values + k];
                }
                half.water_mean[i] -= mean / static_cast<float>(bands_);
            }
        }
    }
}

void MultipleLight::find_corners(double x, double y, std::vector<Corner>& corners) const {
    corners.clear();
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, nodes_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, nodes_.height() - 2);
    for (const int below : {0, 1})
        for (const int right : {0, 1})
            corners.push_back({&nodes_(i + right, j + below),
                               lerp_weight(u - i, right) * lerp_weight(v - j, below)});
}

void MultipleLight::give(std::size_t group, std::size_t band, double radiance,
                         PixelResult& result) const {
    if (group < result.lamps.size()) result.lamps[group][band] += radiance;
}

void MultipleLight::add_water(const PixelView& view, std::span<double> light) const {
    thread_local std::vector<Corner> corners;
    thread_local std::vector<float> weights;
    weight_lattice_.find(view.x, view.y, weights);
    find_corners(view.x, view.y, corners);
    const std::size_t intervals = intervals_.count();
    const std::size_t groups = estimator_.options().groups;
    for (std::size_t d = 0; d < view.distances.size(); ++d) {
        for (std::size_t interval = 0; interval < intervals; ++interval) {
            const double begin = intervals_.begin(interval);
            if (begin >= view.distances[d]) break;
            double total = 0;
            for (const Corner& corner : corners)
                if (corner.node->known_to > begin) total += corner.weight;
            if (!(total > 0)) break;
            for (std::size_t b = 0; b < bands_; ++b) {
                const double share = view.weights[d] / total *
                                     static_cast<double>(weights[interval * bands_ + b]) *
                                     intervals_.share(interval, b, view.distances[d]);
                for (std::size_t group = 0; group < groups; ++group) {
                    double sum = 0;
                    for (const Corner& corner : corners)
                        if (corner.node->known_to > begin)
                            sum +=
                                corner.weight *
                                corner.node->light.water[(interval * groups + group) * bands_ + b];
                    light[group * bands_ + b] += share * sum;
                }
            }
        }
    }
}

// What nodes hold beside the glow is a difference, and so noisy; light is not below zero.
void MultipleLight::add_volume(const PixelView& view, PixelResult& result) const {
    thread_local std::vector<double> light;
    const std::size_t groups = estimator_.options().groups;
    light.assign(groups * bands_, 0.0);
    add_water(view, light);
    for (std::size_t d = 0; d < view.distances.size(); ++d)
        glow_->add(view.x, view.y, view.distances[d], view.weights[d], light);
    for (std::size_t group = 0; group < groups; ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const double radiance = std::max(0.0, light[group * bands_ + b]);
            result.multiple_volume[b] += radiance;
            give(group, b, radiance, result);
        }
    }
}

// The corners that see the surface; if none does, nodes around them, by nearness. Normals that
// differ more will do where none agrees better: on rough ground nodes cannot have them all.
void MultipleLight::find_matches(double x, double y, const SurfaceHit& hit,
                                 std::vector<Corner>& matches) const {
    for (const double least_cosine : {k_least_node_cosine, k_least_cosine_of_match}) {
        find_matches(x, y, hit, least_cosine, matches);
        if (!matches.empty()) return;
    }
}

void MultipleLight::find_matches(double x, double y, const SurfaceHit& hit, double least_cosine,
                                 std::vector<Corner>& matches) const {
    const auto sees = [&](const SmoothNode& node) {
        if (!node.surface || node.surface->object_id != hit.object_id) return false;
        const NodeSurface& surface = *node.surface;
        if (glm::dot(surface.normal, hit.normal) < least_cosine) return false;
        const Vector3 between = hit.position - surface.position;
        return std::abs(glm::dot(between, surface.normal)) <= k_most_slope * glm::length(between);
    };
    find_corners(x, y, matches);
    std::erase_if(matches,
                  [&](const Corner& corner) { return corner.weight <= 0 || !sees(*corner.node); });
    if (!matches.empty()) return;
    const double u = x / spacing_ - column_, v = y / spacing_ - row_;
    for (int reach = 1; reach <= k_search && matches.empty(); ++reach) {
        for (int j = std::max(0, static_cast<int>(v) - reach);
             j <= std::min(nodes_.height() - 1, static_cast<int>(v) + 1 + reach); ++j) {
            for (int i = std::max(0, static_cast<int>(u) - reach);
                 i <= std::min(nodes_.width() - 1, static_cast<int>(u) + 1 + reach); ++i) {
                if (!sees(nodes_(i, j))) continue;
                const double square = (i - u) * (i - u) + (j - v) * (j - v);
                matches.push_back({&nodes_(i, j), 1 / (square * square + 1e-6)});
            }
        }
    }
}

void MultipleLight::add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                                PixelResult& result) const {
    thread_local std::vector<Corner> matches;
    thread_local SmoothNode own;
    find_matches(sample.x, sample.y, sample.hit, matches);
    if (matches.empty()) {
        // Too small for the lattice.
        estimator_.estimate_surface(sample, k_paths_of_sample, own.light);
        matches.push_back({&own, 1});
    }
    double total = 0;
    for (const Corner& match : matches) total += match.weight;
    const SurfaceReflection reflection(*pixels_.scene().surfaces, sample, static_cast<int>(bands_));
    thread_local std::vector<double> mirrored;
    if (reflection.is_glossy())
        estimator_.estimate_mirrored(sample, std::max(1, k_mirrored_paths / pixels_.samples()),
                                     mirrored);
    const double weight = 1.0 / pixels_.samples();
    for (std::size_t group = 0; group < estimator_.options().groups; ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            double diffuse = 0, glossy = 0;
            for (const Corner& match : matches) {
                diffuse += match.weight * match.node->light.diffuse[group * bands_ + b];
                if (!match.node->light.glossy.empty())
                    glossy += match.weight * match.node->light.glossy[group * bands_ + b];
            }
            double reflected = sample.hit.reflectance[b] * diffuse / total;
            if (reflection.is_glossy()) reflected += glossy / total + mirrored[group * bands_ + b];
            // What nodes give is smoothed by fits, which may fall below zero where it is dark.
            const double radiance = weight * to_camera[b] * std::max(0.0, reflected);
            result.multiple_surface[b] += radiance;
            give(group, b, radiance, result);
        }
    }
}

void MultipleLight::add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
                        PixelResult& result) const {
    if (!view.ray) return;
    add_volume(view, result);
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        add_surface(view.samples[i], light.to_camera(first_sample + i), result);
}

namespace {

// What leaves a standard error of less than 1 % where light crosses an optical depth of about one,
// and 5 % for drafts.
MultipleLightOptions options_of(RenderDesc::Quality quality) {
    MultipleLightOptions options;
    options.nodes = 5000;
    options.cells = 1'000'000;
    options.paths = 1'000'000;
    options.error = 0.009;
    if (quality == RenderDesc::Quality::draft) {
        options.nodes = 1000;
        options.cells = 100'000;
        options.paths = 30'000;
        options.error = 0;
    }
    if (quality == RenderDesc::Quality::exact) {
        options.nodes = 20000;
        options.cells = 4'000'000;
        options.paths = 16'000'000;
        options.error = 0;
    }
    return options;
}

}  // namespace

AllLightPass::AllLightPass() : Pass("multiple scattering") {}
AllLightPass::~AllLightPass() = default;

PassNeeds AllLightPass::needs(const LayerPlan& /*plan*/) const {
    return {.paths = true};
}

void AllLightPass::provide(LayerSupply& supply) const {
    supply.layers |= {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface};
}

void AllLightPass::begin(Rendering& rendering) {
    light_.reset();
    if (!rendering.pixels.transport().paths) return;
    rendering.steps.emplace_back([this](const RenderedPixel& pixel) {
        light_->add(pixel.view, pixel.light, pixel.first_sample, pixel.result);
    });
}

void AllLightPass::run(Rendering& rendering) {
    if (!rendering.pixels.transport().paths) return;
    MultipleLightOptions options = options_of(rendering.desc.render.quality);
    options.lamps = rendering.plan.has_lamps();
    light_ = std::make_unique<MultipleLight>(rendering.pixels, options);
    light_->prepare(rendering.film.window(), rendering.progress_of(stage()));
    rendering.reached.multiple_error = light_->error();
}

}  // namespace uw
