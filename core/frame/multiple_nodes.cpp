#include "core/frame/multiple_nodes.h"

#include <algorithm>
#include <cmath>

#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

// Lattices of paths, each with random numbers of its own: their spread gives the variance.
constexpr int k_node_batches = 4;
// Least share of a surface's light that is taken to reach the camera.
constexpr double k_least_seen = 1e-3;

enum NodeStream : std::uint64_t { k_node_water = 1, k_node_diffuse = 2, k_node_glossy = 3 };

// The variance of the mean of k_node_batches values with this sum and sum of squares.
double variance_of_mean(double sum, double squares) {
    const double mean = sum / k_node_batches;
    return std::max(0.0, squares / k_node_batches - mean * mean) / (k_node_batches - 1);
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
    WaterSum(const MultipleNodeOptions& options, std::size_t bands, Workspace& w)
        : options_(options), bands_(bands), w_(w) {}

    void add(const PathTerm& term) override {
        const auto end = std::ranges::lower_bound(options_.distances, term.distance);
        const auto interval =
            std::clamp<std::ptrdiff_t>(end - options_.distances.begin() - 1, 0,
                                       static_cast<std::ptrdiff_t>(options_.distances.size()) - 2);
        const std::size_t group = std::min(term.lamp, options_.groups - 1);
        const auto i = static_cast<std::size_t>(interval);
        double* sum = &w_.water[(i * options_.groups + group) * bands_];
        double mean = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            sum[b] += term.radiance[b];
            mean += term.radiance[b];
        }
        w_.batch_mean[i] += mean;
    }

  private:
    const MultipleNodeOptions& options_;
    std::size_t bands_;
    Workspace& w_;
};

class MultipleNodes::SurfaceSum final : public PathTerms {
  public:
    SurfaceSum(const MultipleNodeOptions& options, std::size_t bands, std::vector<double>& sum)
        : options_(options), bands_(bands), sum_(sum) {}

    void add(const PathTerm& term) override {
        const std::size_t group = std::min(term.lamp, options_.groups - 1);
        for (std::size_t b = 0; b < bands_; ++b) {
            sum_[group * bands_ + b] += term.radiance[b];
            batch_ += term.radiance[b];
        }
    }
    void end_batch(double scale) {
        total_ += batch_ * scale;
        squares_ += batch_ * batch_ * scale * scale;
        batch_ = 0;
    }
    double mean() const { return total_ / k_node_batches; }
    double variance() const { return variance_of_mean(total_, squares_); }

  private:
    const MultipleNodeOptions& options_;
    std::size_t bands_;
    std::vector<double>& sum_;
    double batch_ = 0, total_ = 0, squares_ = 0;
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

void MultipleNodes::estimate_surface(const SurfaceSample& sample, int paths,
                                     MultipleNode& node) const {
    Workspace& w = workspace_of_thread();
    node = {};
    begin(sample, true, w, node);
    const auto x = static_cast<std::uint64_t>(64 * sample.x);
    const auto y = static_cast<std::uint64_t>(64 * sample.y);
    trace_surface(PathRandom::seed_of(x, y, 1), paths, w, node);
}

void MultipleNodes::begin(const SurfaceSample& sample, bool has_hit, Workspace& w,
                          MultipleNode& node) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    node.has_ray = true;
    node.reach = has_hit ? sample.hit.distance : k_far;
    w.seen.clear();
    if (has_hit) {
        transport_.surfaces->evaluate_one(sample, w.light);
        const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands));
        w.seen.assign(bands, 0.0);
        Spectrum brdf;
        for (std::size_t j = 0; j < w.light.lamp_count(); ++j) {
            if (!w.light.visible(0, j)) continue;
            reflection.brdf((*scene_.lamps)[j].position(), brdf);
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
    const std::size_t intervals = options_.distances.size() - 1;
    w.water.assign(intervals * options_.groups * bands, 0.0);
    w.interval_mean.assign(intervals, 0.0);
    w.interval_squares.assign(intervals, 0.0);
    w.batch_mean.assign(intervals, 0.0);
    WaterSum sum(options_, bands, w);
    const int in_batch = std::max(1, options_.paths / k_node_batches);
    const double scale = 1.0 / (in_batch * static_cast<double>(bands));
    for (int batch = 0; batch < k_node_batches; ++batch) {
        for (int i = 0; i < in_batch; ++i) {
            PathRandom random(
                PathRandom::seed_of(seed, k_node_water, static_cast<std::uint64_t>(batch)),
                static_cast<std::uint32_t>(i));
            transport_.paths->trace_water(w.segment, random, sum);
        }
        for (std::size_t i = 0; i < intervals; ++i) {
            const double mean = w.batch_mean[i] * scale;
            w.interval_mean[i] += mean;
            w.interval_squares[i] += mean * mean;
            w.batch_mean[i] = 0;
        }
    }
    node.water.resize(w.water.size());
    for (std::size_t i = 0; i < w.water.size(); ++i)
        node.water[i] = static_cast<float>(w.water[i] / (in_batch * k_node_batches));
    for (std::size_t i = 0; i < intervals; ++i) {
        node.water_mean.push_back(static_cast<float>(w.interval_mean[i] / k_node_batches));
        node.water_variance.push_back(
            static_cast<float>(variance_of_mean(w.interval_mean[i], w.interval_squares[i])));
        node.mean_light += node.water_mean.back();
    }
}

// Diffuse reflection as of a white surface, whose colour is that of each pixel; gloss as it is.
void MultipleNodes::trace_surface(std::uint64_t seed, int paths, Workspace& w,
                                  MultipleNode& node) const {
    const auto bands = static_cast<std::size_t>(scene_.medium->band_count());
    const int in_batch = std::max(1, paths / k_node_batches);
    const auto trace = [&](NodeStream stream, std::vector<float>& values) {
        w.surface.assign(options_.groups * bands, 0.0);
        SurfaceSum sum(options_, bands, w.surface);
        for (int batch = 0; batch < k_node_batches; ++batch) {
            for (int i = 0; i < in_batch; ++i) {
                PathRandom random(
                    PathRandom::seed_of(seed, stream, static_cast<std::uint64_t>(batch)),
                    static_cast<std::uint32_t>(i));
                transport_.paths->trace_surface(w.surface_segment, random, sum);
            }
            sum.end_batch(1.0 / (in_batch * static_cast<double>(bands)));
        }
        values.resize(w.surface.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<float>(w.surface[i] / (in_batch * k_node_batches));
        return sum;
    };
    w.surface_segment = w.segment;
    SurfaceHit& hit = w.surface_segment.water.hit;
    const Spectrum reflectance = hit.reflectance;
    hit.reflectance = per_band(bands, [](std::size_t) { return 1.0; });
    hit.has_material = false;
    for (std::size_t b = 0; b < bands; ++b)
        node.surface_seen +=
            reflectance[b] * w.segment.transmittance[b] / static_cast<double>(bands);
    // Of what the camera sees, so that paths end as they would in a pixel.
    const double share = std::max(node.surface_seen, k_least_seen);
    std::ranges::fill(w.surface_segment.transmittance, share);
    const SurfaceSum diffuse = trace(k_node_diffuse, node.diffuse);
    for (float& value : node.diffuse) value = static_cast<float>(value / share);
    node.diffuse_mean = diffuse.mean() / share;
    node.diffuse_variance = diffuse.variance() / (share * share);
    node.mean_light += node.surface_seen * node.diffuse_mean;
    if (!node.surface->is_glossy) return;
    hit.reflectance = {};
    hit.has_material = true;
    std::ranges::fill(w.surface_segment.transmittance, 1.0);
    trace(k_node_glossy, node.glossy);
}

}  // namespace uw
