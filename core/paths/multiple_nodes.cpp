#include "core/paths/multiple_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"

namespace uw {

namespace {

// Lattices of paths, each with random numbers of its own: two for each half of a node, and their
// spread gives the variance.
constexpr int k_node_batches = 4, k_batches_of_half = 2;
// Least share of a surface's light that is taken to reach the camera.
constexpr double k_least_seen = 1e-3;

enum NodeStream : std::uint64_t {
    k_node_water = 1,
    k_node_diffuse = 2,
    k_node_glossy = 3,
    k_mirrored = 4,
    k_pilot = 5
};

// The variance of the mean over a half's batches, from all batches' sum and sum of squares.
double variance_of_half(double sum, double squares) {
    const double mean = sum / k_node_batches;
    const double of_batch = std::max(0.0, squares / k_node_batches - mean * mean) * k_node_batches /
                            (k_node_batches - 1);
    return of_batch / k_batches_of_half;
}

void store(std::span<const double> sums, double scale, std::vector<float>& values) {
    values.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) values[i] = static_cast<float>(sums[i] * scale);
}

}  // namespace

struct MultipleNodes::Workspace {
    CameraSegment segment, surface_segment;
    SurfaceLight light;
    std::vector<double> seen;   // radiance of the surface
    std::vector<double> water;  // as MultipleNode::water
    std::vector<double> interval_mean, interval_squares, batch_mean;
    std::vector<double> surface;
};

/// Adds up terms by the interval in which they leave the camera ray.
class MultipleNodes::WaterSum final : public PathTerms {
  public:
    WaterSum(const DistanceIntervals& intervals, const MultipleNodeOptions& options,
             std::size_t bands, Workspace& w)
        : intervals_(intervals), options_(options), bands_(bands), w_(w) {}

    void add(const PathTerm& term) override {
        const std::size_t i = intervals_.at(term.distance);
        const std::size_t group = std::min(term.lamp, options_.groups - 1);
        double* sum = &w_.water[(i * options_.groups + group) * bands_];
        double mean = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            sum[b] += term.radiance[b];
            mean += term.radiance[b];
        }
        w_.batch_mean[i] += mean;
    }

  private:
    const DistanceIntervals& intervals_;
    const MultipleNodeOptions& options_;
    std::size_t bands_;
    Workspace& w_;
};

class MultipleNodes::SurfaceSum final : public PathTerms {
  public:
    SurfaceSum(const MultipleNodeOptions& options, std::size_t bands, std::vector<double>& sum,
               bool leaves_out_mirrored)
        : options_(options), bands_(bands), sum_(sum), leaves_out_mirrored_(leaves_out_mirrored) {}

    void add(const PathTerm& term) override {
        if (leaves_out_mirrored_ && PathTracer::is_mirrored(term)) return;
        const std::size_t group = std::min(term.lamp, options_.groups - 1);
        for (std::size_t b = 0; b < bands_; ++b) sum_[group * bands_ + b] += term.radiance[b];
        for (const double radiance : term.radiance) batch_ += radiance;
    }
    /// Ends a batch and returns its mean.
    double end_batch(double scale) { return std::exchange(batch_, 0.0) * scale; }

  private:
    const MultipleNodeOptions& options_;
    std::size_t bands_;
    std::vector<double>& sum_;
    bool leaves_out_mirrored_;
    double batch_ = 0;
};

MultipleNodes::Workspace& MultipleNodes::workspace_of_thread() {
    thread_local Workspace workspace;
    return workspace;
}

void MultipleNodes::estimate(double x, double y, std::uint64_t seed, MultipleNode& node) const {
    Workspace& w = workspace_of_thread();
    node = {};
    const std::optional<Ray> ray = rays_.refracted_ray(x, y);
    if (!ray) return;
    SurfaceSample sample{*ray, {}, x, y};
    const bool has_hit = scene_.surfaces->closest_hit(*ray, k_far, sample.hit);
    begin(sample, has_hit, w, node);
    trace_water(seed, w, node);
    if (has_hit) trace_surface(seed, options_.paths, w, node);
}

double MultipleNodes::relative_variance(double paths) const {
    constexpr int k_fewest_across = 4, k_most_across = 16, k_paths = 64;
    const int across =
        std::clamp(static_cast<int>(std::sqrt(paths / k_paths)), k_fewest_across, k_most_across);
    const auto count = static_cast<std::size_t>(across) * static_cast<std::size_t>(across);
    MultipleNodeOptions options = options_;
    options.paths = k_paths;
    const MultipleNodes pilot(rays_, scene_, transport_, weights_, options);
    std::vector<double> lights(count), variances(count);
    parallel_for(lights.size(), [&](std::size_t at) {
        const auto i = static_cast<int>(at) % across, j = static_cast<int>(at) / across;
        MultipleNode node;
        pilot.estimate((i + 0.5) * rays_.width() / across, (j + 0.5) * rays_.height() / across,
                       PathRandom::seed_of(static_cast<std::uint64_t>(i),
                                           static_cast<std::uint64_t>(j), k_pilot),
                       node);
        lights[at] = node.mean_light;
        double variance = node.diffuse_variance * node.surface_seen * node.surface_seen;
        for (const float of_interval : node.water_variance)
            variance += static_cast<double>(of_interval);
        variances[at] = variance * k_paths / 2;  // of either half's mean
    });
    const double light = std::accumulate(lights.begin(), lights.end(), 0.0);
    const double variance = std::accumulate(variances.begin(), variances.end(), 0.0);
    return light > 0 ? variance * static_cast<double>(count) / (light * light) : 0;
}

void MultipleNodes::estimate_surface(const SurfaceSample& sample, int paths,
                                     NodeLight& light) const {
    Workspace& w = workspace_of_thread();
    MultipleNode node;
    begin(sample, true, w, node);
    const auto x = static_cast<std::uint64_t>(64 * sample.x);
    const auto y = static_cast<std::uint64_t>(64 * sample.y);
    trace_surface(PathRandom::seed_of(x, y, 1), paths, w, node);
    light = std::move(node.halves[0]);
    const NodeLight& other = node.halves[1];
    for (std::size_t k = 0; k < light.diffuse.size(); ++k)
        light.diffuse[k] = 0.5F * (light.diffuse[k] + other.diffuse[k]);
    for (std::size_t k = 0; k < light.glossy.size(); ++k)
        light.glossy[k] = 0.5F * (light.glossy[k] + other.glossy[k]);
}

void MultipleNodes::begin(const SurfaceSample& sample, bool has_hit, Workspace& w,
                          MultipleNode& node) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    node.has_ray = true;
    node.reach = has_hit ? sample.hit.distance : k_far;
    weights_.find(sample.ray, node.weights);
    for (std::size_t k = 0; k < node.weights.size(); ++k)
        node.weights[k] *= static_cast<float>(intervals_.share(k / bands, k % bands, node.reach));
    node.mean_weights.assign(intervals_.count(), 0.0F);
    for (std::size_t k = 0; k < node.weights.size(); ++k)
        node.mean_weights[k / bands] += node.weights[k] / static_cast<float>(bands);
    w.seen.clear();
    if (has_hit) {
        transport_.surfaces->evaluate_one(sample, w.light);
        const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands));
        w.seen.assign(bands, 0.0);
        Spectrum brdf;
        for (std::size_t j = 0; j < w.light.emitter_count(); ++j) {
            if (!w.light.visible(0, j)) continue;
            reflection.brdf(w.light.emitters()[j].origin(sample.hit.position), brdf);
            for (std::size_t b = 0; b < bands; ++b)
                w.seen[b] += w.light.irradiance(0, j, b) * brdf[b];
        }
        node.surface = NodeSurface{sample.hit.object_id, sample.hit.position, sample.hit.normal,
                                   reflection.is_glossy()};
    }
    transport_.paths->begin(sample.ray, has_hit ? &sample.hit : nullptr, w.seen, w.segment);
    node.mean_light = w.segment.light.own;
}

void MultipleNodes::trace_water(std::uint64_t seed, Workspace& w, MultipleNode& node) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    const std::size_t intervals = intervals_.count();
    const int in_batch = std::max(1, options_.paths / k_node_batches);
    const double scale = 1.0 / (in_batch * static_cast<double>(bands));
    w.interval_mean.assign(intervals, 0.0);
    w.interval_squares.assign(intervals, 0.0);
    w.batch_mean.assign(intervals, 0.0);
    WaterSum sum(intervals_, options_, bands, w);
    for (int batch = 0; batch < k_node_batches; ++batch) {
        NodeLight& half = node.halves[static_cast<std::size_t>(batch / k_batches_of_half)];
        if (batch % k_batches_of_half == 0) {
            w.water.assign(intervals * options_.groups * bands, 0.0);
            half.water_mean.assign(intervals, 0.0F);
        }
        for (int i = 0; i < in_batch; ++i) {
            PathRandom random(
                PathRandom::seed_of(seed, k_node_water, static_cast<std::uint64_t>(batch)),
                static_cast<std::uint32_t>(i));
            transport_.paths->trace_water(w.segment, random, sum);
        }
        for (std::size_t i = 0; i < intervals; ++i) {
            const double mean = std::exchange(w.batch_mean[i], 0.0) * scale;
            w.interval_mean[i] += mean;
            w.interval_squares[i] += mean * mean;
            half.water_mean[i] += static_cast<float>(mean / k_batches_of_half);
        }
        store(w.water, 1.0 / (in_batch * k_batches_of_half), half.water);
    }
    for (std::size_t i = 0; i < intervals; ++i) {
        node.water_variance.push_back(
            static_cast<float>(variance_of_half(w.interval_mean[i], w.interval_squares[i])));
        node.mean_light += w.interval_mean[i] / k_node_batches;
    }
}

void MultipleNodes::estimate_mirrored(const SurfaceSample& sample, int paths,
                                      std::vector<double>& radiance) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    radiance.assign(options_.groups * bands, 0.0);
    SurfaceSum sum(options_, bands, radiance, false);
    const auto x = static_cast<std::uint64_t>(64 * sample.x);
    const auto y = static_cast<std::uint64_t>(64 * sample.y);
    SurfaceSample glossy = sample;
    glossy.hit.reflectance = {};
    for (int i = 0; i < paths; ++i) {
        PathRandom random(PathRandom::seed_of(x, y, k_mirrored), static_cast<std::uint32_t>(i));
        transport_.paths->trace_mirrored(glossy, random, sum);
    }
    for (double& value : radiance) value /= paths;
}

// Diffuse reflection as of a white surface, whose colour is that of each pixel; gloss as it is.
void MultipleNodes::trace_surface(std::uint64_t seed, int paths, Workspace& w,
                                  MultipleNode& node) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    const int in_batch = std::max(1, paths / k_node_batches);
    const auto trace = [&](NodeStream stream, double share, std::vector<float> NodeLight::*values) {
        std::array<double, k_node_batches> means{};
        SurfaceSum sum(options_, bands, w.surface, stream == k_node_glossy);
        for (int batch = 0; batch < k_node_batches; ++batch) {
            if (batch % k_batches_of_half == 0) w.surface.assign(options_.groups * bands, 0.0);
            for (int i = 0; i < in_batch; ++i) {
                PathRandom random(
                    PathRandom::seed_of(seed, stream, static_cast<std::uint64_t>(batch)),
                    static_cast<std::uint32_t>(i));
                transport_.paths->trace_surface(w.surface_segment, random, sum);
            }
            const auto half = static_cast<std::size_t>(batch / k_batches_of_half);
            store(w.surface, 1.0 / (in_batch * k_batches_of_half * share),
                  node.halves[half].*values);
            means[static_cast<std::size_t>(batch)] =
                sum.end_batch(1.0 / (in_batch * static_cast<double>(bands) * share));
        }
        return means;
    };
    w.surface_segment = w.segment;
    SurfaceHit& hit = w.surface_segment.water.hit;
    for (std::size_t b = 0; b < bands; ++b)
        node.surface_seen += hit.reflectance[b] * w.segment.transmittance[b];
    node.surface_seen /= static_cast<double>(bands);
    hit.reflectance = per_band(bands, [](std::size_t) { return 1.0; });
    hit.has_material = false;
    // Weights are those of what the camera sees, so that paths end as they would in a pixel.
    const double share = std::max(node.surface_seen, k_least_seen);
    std::ranges::fill(w.surface_segment.transmittance, share);
    double sum = 0, squares = 0;
    const auto means = trace(k_node_diffuse, share, &NodeLight::diffuse);
    for (std::size_t batch = 0; batch < means.size(); ++batch) {
        node.halves[batch / k_batches_of_half].diffuse_mean += means[batch] / k_batches_of_half;
        sum += means[batch];
        squares += means[batch] * means[batch];
    }
    node.diffuse_variance = variance_of_half(sum, squares);
    node.mean_light += node.surface_seen * sum / k_node_batches;
    if (!node.surface->is_glossy) return;
    hit.reflectance = {};
    hit.has_material = true;
    std::ranges::fill(w.surface_segment.transmittance, 1.0);
    trace(k_node_glossy, 1, &NodeLight::glossy);
}

}  // namespace uw
