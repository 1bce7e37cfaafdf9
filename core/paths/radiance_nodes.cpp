#include "core/paths/radiance_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/surface_reflection.h"

namespace uw {

namespace {

// Each node is estimated in independent batches of paths, two for each half; their spread gives the
// variance.
constexpr int k_node_batches = 4, k_batches_of_half = 2;
// Minimum fraction of a surface's light that is assumed to reach the camera.
constexpr double k_min_throughput = 1e-3;

enum NodeStream : std::uint64_t {
    k_node_water = 1,
    k_node_diffuse = 2,
    k_node_glossy = 3,
    k_mirrored = 4,
    k_node_lit = 5,
    k_scouting = 6
};

// The variance of the mean over a half's batches, from their sum and sum of squares.
double variance_of_half(double sum, double squares) {
    const double mean = sum / k_batches_of_half;
    return std::max(0.0, squares / k_batches_of_half - mean * mean) / (k_batches_of_half - 1);
}

void store(std::span<const double> sums, double scale, std::vector<float>& values) {
    values.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) values[i] = static_cast<float>(sums[i] * scale);
}

double scale_for(double expected, double typical) {
    constexpr double k_max_of_typical = 16;
    return typical > 0 ? std::clamp(expected / typical, 1.0, k_max_of_typical) : 1;
}

}  // namespace

NodePaths::NodePaths(const PathNumbers& numbers) : mean_(numbers) {
    parts_.assign(1, 1, Part{.numbers = numbers});
}

NodePaths::NodePaths(Grid2D<Part> parts, double width, double height)
    : parts_(std::move(parts)), width_(width), height_(height), mean_{0, 0, 0} {
    const auto count = static_cast<double>(parts_.size());
    for (const Part& part : parts_) {
        mean_.surface += part.numbers.surface / count;
        mean_.lit += part.numbers.lit / count;
        mean_.water += part.numbers.water / count;
    }
}

NodePaths::Part NodePaths::part_at(double x, double y) const {
    const auto split = [](double at, int parts) {
        const double place = std::clamp(at * parts - 0.5, 0.0, static_cast<double>(parts - 1));
        const int first = std::min(static_cast<int>(place), std::max(0, parts - 2));
        return std::pair(first, place - first);
    };
    const auto [i, u] = split(x / width_, parts_.width());
    const auto [j, v] = split(y / height_, parts_.height());
    Part sum{.numbers = {0, 0, 0}};
    const auto add = [&](int column, int row, double weight) {
        if (!(weight > 0)) return;
        const Part& part = parts_(column, row);
        sum.numbers.surface += weight * part.numbers.surface;
        sum.numbers.lit += weight * part.numbers.lit;
        sum.numbers.water += weight * part.numbers.water;
        sum.estimated_water += weight * part.estimated_water;
        sum.estimated_surface += weight * part.estimated_surface;
    };
    add(i, j, (1 - u) * (1 - v));
    add(i + 1, j, u * (1 - v));
    add(i, j + 1, (1 - u) * v);
    add(i + 1, j + 1, u * v);
    return sum;
}

PathNumbers NodePaths::of(const RadianceNode& node, double x, double y) const {
    const Part part = part_at(x, y);
    const double in_water = scale_for(node.estimated_water, part.estimated_water);
    return {
        .surface = part.numbers.surface * scale_for(node.estimated_surface, part.estimated_surface),
        .lit = part.numbers.lit * in_water,
        .water = part.numbers.water * in_water};
}

struct RadianceEstimator::Workspace {
    CameraSegment segment;
    SurfaceLight light;
    std::vector<double> direct;  // direct light that the surface reflects
    std::vector<double> water;   // as RadianceNode::water
    std::vector<double> interval_mean, interval_squares, batch_mean;  // of a half, and of a batch
    std::vector<double> lit_indirect;                                 // as RadianceNode's
    std::vector<double> surface;
};

/// Sums contributions by the interval in which they leave the camera ray.
class RadianceEstimator::WaterSum final : public ContributionSink {
  public:
    WaterSum(const DistanceIntervals& intervals, std::size_t groups, std::size_t bands,
             Workspace& w)
        : intervals_(intervals), groups_(groups), bands_(bands), w_(w) {}

    /// The contributions that follow belong to one path among `count`, either towards lit surfaces
    /// or in the water alone.
    void begin_path(int count, bool is_lit) {
        weight_ = 1.0 / count;
        is_lit_ = is_lit;
        path_ = 0;
    }
    /// The current path's light, summed over the bands.
    double of_path() const { return path_; }

    void add(const PathContribution& term) override {
        const std::size_t i = intervals_.at(term.distance);
        const std::size_t group = std::min(term.lamp, groups_ - 1);
        double* sum = &w_.water[(i * groups_ + group) * bands_];
        double mean = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            sum[b] += weight_ * term.radiance[b];
            mean += term.radiance[b];
        }
        w_.batch_mean[i] += weight_ * mean;
        path_ += mean;
        // Light that was looked up in the cache at a surface comes from no emitter.
        if (is_lit_ && term.reflections > 0 && term.emitter == k_no_emitter && !term.is_met)
            for (std::size_t b = 0; b < bands_; ++b)
                w_.lit_indirect[b] += weight_ * term.radiance[b];
    }

  private:
    const DistanceIntervals& intervals_;
    std::size_t groups_, bands_;
    Workspace& w_;
    double weight_ = 1, path_ = 0;
    bool is_lit_ = false;
};

class RadianceEstimator::SurfaceSum final : public ContributionSink {
  public:
    SurfaceSum(std::size_t groups, std::size_t bands, std::vector<double>& sum,
               bool leaves_out_mirrored)
        : groups_(groups), bands_(bands), sum_(sum), leaves_out_mirrored_(leaves_out_mirrored) {}

    void add(const PathContribution& term) override {
        if (leaves_out_mirrored_ && PathTracer::is_mirrored(term)) return;
        const std::size_t group = std::min(term.lamp, groups_ - 1);
        for (std::size_t b = 0; b < bands_; ++b) sum_[group * bands_ + b] += term.radiance[b];
        for (const double radiance : term.radiance) batch_ += radiance;
    }
    /// Ends a batch and returns its mean.
    double end_batch(double scale) { return std::exchange(batch_, 0.0) * scale; }

  private:
    std::size_t groups_, bands_;
    std::vector<double>& sum_;
    bool leaves_out_mirrored_;
    double batch_ = 0;
};

void RadianceEstimator::estimate_surface(const Place& place, const NodePaths& paths,
                                         RadianceNode& node) const {
    Workspace w;
    node = {};
    const std::optional<Ray> ray = rays_.refracted_ray(place.x, place.y);
    if (!ray) return;
    SurfaceSample sample{*ray, {}, place.x, place.y};
    const bool has_hit = scene_.surfaces->closest_hit(*ray, k_far, sample.hit);
    begin(sample, has_hit, w, node);
    if (!has_hit) return;
    const double number = paths.of(node, place.x, place.y).surface;
    node.surface_scale = number / paths.mean().surface;
    trace_surface(place.seed, static_cast<int>(std::lround(number)), w, node);
}

Point3 RadianceEstimator::find_lit_surfaces(const Place& place, int paths,
                                            std::vector<SurfaceSample>& samples) const {
    Workspace w;
    samples.clear();
    const std::optional<Ray> ray = rays_.refracted_ray(place.x, place.y);
    if (!ray) return {};
    SurfaceSample sample;
    const bool has_hit = scene_.surfaces->closest_hit(*ray, k_far, sample.hit);
    transport_.paths->begin(*ray, has_hit ? &sample.hit : nullptr, {}, w.segment);
    for (int i = 0; i < paths; ++i) {
        PathRandom random(PathRandom::seed_of(place.seed, k_scouting),
                          static_cast<std::uint32_t>(i));
        if (transport_.paths->find_lit_surface(w.segment, random, sample))
            samples.push_back(sample);
    }
    return ray->origin;
}

void RadianceEstimator::estimate_surface(const SurfaceSample& sample, int paths,
                                         NodeRadiance& light, SurfaceErrors& errors) const {
    Workspace w;
    RadianceNode node;
    begin(sample, true, w, node);
    const auto x = static_cast<std::uint64_t>(64 * sample.x);
    const auto y = static_cast<std::uint64_t>(64 * sample.y);
    trace_surface(PathRandom::seed_of(x, y, 1), paths, w, node);
    light = std::move(node.halves[0]);
    const auto merge = [&](std::vector<float>& values, const std::vector<float>& other,
                           std::vector<float>& error) {
        error.assign(values.empty() ? 0 : bands(), 0.0F);
        for (std::size_t k = 0; k < values.size(); ++k) {
            error[k % bands()] += 0.5F * (values[k] - other[k]);
            values[k] = 0.5F * (values[k] + other[k]);
        }
        for (float& value : error) value = std::abs(value);
    };
    merge(light.diffuse, node.halves[1].diffuse, errors.diffuse);
    merge(light.glossy, node.halves[1].glossy, errors.glossy);
}

void RadianceEstimator::begin(const SurfaceSample& sample, bool has_hit, Workspace& w,
                              RadianceNode& node) const {
    node.has_ray = true;
    node.max_distance = has_hit ? sample.hit.distance : k_far;
    w.direct.clear();
    if (has_hit) {
        transport_.surfaces->evaluate_one(sample, w.light);
        const SurfaceReflection reflection(*scene_.surfaces, sample, static_cast<int>(bands()));
        w.direct.assign(bands(), 0.0);
        Spectrum brdf;
        for (std::size_t j = 0; j < w.light.emitter_count(); ++j) {
            if (!w.light.visible(0, j)) continue;
            brdf_for(w.light.emitters()[j], reflection, sample, brdf);
            for (std::size_t b = 0; b < bands(); ++b)
                w.direct[b] += w.light.irradiance(0, j, b) * brdf[b];
        }
        node.surface = NodeSurface{sample.hit.object_id, sample.hit.position, sample.hit.normal,
                                   reflection.is_glossy()};
    }
    transport_.paths->begin(sample.ray, has_hit ? &sample.hit : nullptr, w.direct, w.segment);
    const ExpectedLight& expected = w.segment.expected;
    node.mean_light = expected.is_known ? expected.pixel : 0;
    node.estimated_water = expected.pixel - expected.of_surface;
    if (!has_hit) return;
    constexpr double k_min_reflectance = 0.1;
    double reflectance = 0;
    for (std::size_t b = 0; b < bands(); ++b)
        reflectance += sample.hit.reflectance[b] / static_cast<double>(bands());
    node.estimated_surface = expected.of_surface / std::max(reflectance, k_min_reflectance);
}

void RadianceEstimator::estimate_water(const Place& place, const NodePaths& paths,
                                       const IrradianceCache& indirect, double typical_light,
                                       RadianceNode& node) const {
    Workspace w;
    const std::optional<Ray> ray = rays_.refracted_ray(place.x, place.y);
    if (!ray) return;
    SurfaceHit hit;
    const bool has_hit = scene_.surfaces->closest_hit(*ray, k_far, hit);
    const std::size_t count = intervals_.count();
    weights_.find(*ray, node.weights);
    for (std::size_t k = 0; k < node.weights.size(); ++k)
        node.weights[k] *= static_cast<float>(
            intervals_.fraction_before(k / bands(), k % bands(), node.max_distance));
    node.mean_weights.assign(count, 0.0F);
    for (std::size_t k = 0; k < node.weights.size(); ++k)
        node.mean_weights[k / bands()] += node.weights[k] / static_cast<float>(bands());
    // Paths in the water alone are not guided by the surface.
    transport_.paths->begin(*ray, has_hit ? &hit : nullptr, {}, w.segment);
    w.segment.paths = {};
    ExpectedLight& expected = w.segment.expected;
    if (expected.is_known) expected.pixel = std::max(expected.pixel, node.mean_light);
    if (expected.is_known && weights_.vary()) {
        // Particles may be lit anywhere, which the lamps' guides do not know. If more were expected
        // of dark water than it has, roulette would leave it a few paths that are far too bright.
        constexpr double k_ambient = 1, k_min_expected = 0.2;
        expected.ambient = std::max(expected.ambient, k_ambient * typical_light);
        expected.pixel = std::max(expected.pixel, k_min_expected * typical_light);
    }
    const double per_band = 1.0 / static_cast<double>(bands());
    w.batch_mean.assign(count, 0.0);
    w.lit_indirect.assign(bands(), 0.0);
    WaterSum sum(intervals_, groups_, bands(), w);
    const PathNumbers numbers = paths.of(node, place.x, place.y);
    node.water_scale = (numbers.lit + numbers.water) / (paths.mean().lit + paths.mean().water);
    const auto trace = [&](NodeStream stream, int batch, double all, RadianceNode::Moments& moments,
                           const auto& trace_one) {
        const int in_batch = std::max(1, static_cast<int>(std::lround(all / k_node_batches)));
        const int in_all = in_batch * k_node_batches;
        for (int i = 0; i < in_batch; ++i) {
            PathRandom random(
                PathRandom::seed_of(place.seed, stream, static_cast<std::uint64_t>(batch)),
                static_cast<std::uint32_t>(i));
            sum.begin_path(in_batch, stream == k_node_lit);
            moments.work += trace_one(random) / in_all;
            const double of_path = sum.of_path() * per_band;
            moments.mean += of_path / in_all;
            moments.variance += of_path * of_path / in_all;
        }
    };
    for (int batch = 0; batch < k_node_batches; ++batch) {
        NodeRadiance& half = node.halves[static_cast<std::size_t>(batch / k_batches_of_half)];
        if (batch % k_batches_of_half == 0) {
            w.water.assign(count * groups_ * bands(), 0.0);
            w.interval_mean.assign(count, 0.0);
            w.interval_squares.assign(count, 0.0);
        }
        trace(k_node_lit, batch, numbers.lit, node.lit, [&](PathRandom& random) {
            return transport_.paths->trace_lit_surfaces(w.segment, indirect, random, sum);
        });
        trace(k_node_water, batch, numbers.water, node.water, [&](PathRandom& random) {
            return transport_.paths->trace_water(w.segment, random, sum);
        });
        for (std::size_t i = 0; i < count; ++i) {
            const double mean = std::exchange(w.batch_mean[i], 0.0) * per_band;
            w.interval_mean[i] += mean;
            w.interval_squares[i] += mean * mean;
            node.mean_light += mean / k_node_batches;
        }
        if (batch % k_batches_of_half != k_batches_of_half - 1) continue;
        store(w.water, 1.0 / k_batches_of_half, half.water);
        store(w.interval_mean, 1.0 / k_batches_of_half, half.water_mean);
        half.water_variance.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            half.water_variance[i] =
                static_cast<float>(variance_of_half(w.interval_mean[i], w.interval_squares[i]));
    }
    store(w.lit_indirect, 1.0 / k_node_batches, node.lit_indirect);
    for (RadianceNode::Moments* moments : {&node.lit, &node.water})
        moments->variance = std::max(0.0, moments->variance - moments->mean * moments->mean);
}

void RadianceEstimator::estimate_mirrored(const SurfaceSample& sample, int paths,
                                          std::vector<double>& radiance,
                                          std::vector<double>& squares) const {
    std::vector<double> of_path;
    PathScratch scratch;
    radiance.assign(groups_ * bands(), 0.0);
    squares.assign(bands(), 0.0);
    SurfaceSum sum(groups_, bands(), of_path, false);
    const auto x = static_cast<std::uint64_t>(64 * sample.x);
    const auto y = static_cast<std::uint64_t>(64 * sample.y);
    SurfaceSample glossy = sample;
    glossy.hit.reflectance = {};
    for (int i = 0; i < paths; ++i) {
        PathRandom random(PathRandom::seed_of(x, y, k_mirrored), static_cast<std::uint32_t>(i));
        of_path.assign(radiance.size(), 0.0);
        transport_.paths->trace_mirrored(glossy, random, sum, scratch);
        for (std::size_t b = 0; b < bands(); ++b) {
            double light = 0;
            for (std::size_t k = b; k < of_path.size(); k += bands()) light += of_path[k];
            squares[b] += light * light;
        }
        for (std::size_t k = 0; k < radiance.size(); ++k) radiance[k] += of_path[k];
    }
    for (double& value : radiance) value /= paths;
}

// Diffuse reflection is estimated for a white surface, as each pixel has a colour of its own; the
// specular lobe is estimated as it is.
void RadianceEstimator::trace_surface(std::uint64_t seed, int paths, Workspace& w,
                                      RadianceNode& node) const {
    const std::size_t bands = this->bands();
    const int in_batch = std::max(1, paths / k_node_batches);
    const auto trace = [&](NodeStream stream, double throughput,
                           std::vector<float> NodeRadiance::*values) {
        std::array<double, k_node_batches> means{};
        SurfaceSum sum(groups_, bands, w.surface, stream == k_node_glossy);
        for (int batch = 0; batch < k_node_batches; ++batch) {
            if (batch % k_batches_of_half == 0) w.surface.assign(groups_ * bands, 0.0);
            for (int i = 0; i < in_batch; ++i) {
                PathRandom random(
                    PathRandom::seed_of(seed, stream, static_cast<std::uint64_t>(batch)),
                    static_cast<std::uint32_t>(i));
                node.surface_work += transport_.paths->trace_surface(w.segment, random, sum) /
                                     (in_batch * k_node_batches);
            }
            const auto half = static_cast<std::size_t>(batch / k_batches_of_half);
            store(w.surface, 1.0 / (in_batch * k_batches_of_half * throughput),
                  node.halves[half].*values);
            means[static_cast<std::size_t>(batch)] =
                sum.end_batch(1.0 / (in_batch * static_cast<double>(bands) * throughput));
        }
        return means;
    };
    w.segment.paths = {};
    SurfaceHit& hit = w.segment.water.hit;
    for (std::size_t b = 0; b < bands; ++b) {
        const double throughput = hit.reflectance[b] * w.segment.transmittance[b];
        node.surface_throughput_by_band.push_back(static_cast<float>(throughput));
        node.surface_throughput += throughput / static_cast<double>(bands);
    }
    hit.reflectance = per_band(bands, [](std::size_t) { return 1.0; });
    hit.has_material = false;
    // The throughput is the camera's, so that Russian roulette ends paths as it would in a pixel.
    const double throughput = std::max(node.surface_throughput, k_min_throughput);
    std::ranges::fill(w.segment.transmittance, throughput);
    const auto means = trace(k_node_diffuse, throughput, &NodeRadiance::diffuse);
    for (std::size_t half = 0; half < node.halves.size(); ++half) {
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < k_batches_of_half; ++i) {
            const double mean = means[half * k_batches_of_half + i];
            sum += mean;
            squares += mean * mean;
        }
        NodeRadiance& light = node.halves[half];
        light.diffuse_mean = sum / k_batches_of_half;
        light.diffuse_variance = variance_of_half(sum, squares);
        node.mean_light += node.surface_throughput * sum / k_node_batches;
    }
    if (!node.surface->is_glossy) return;
    hit.reflectance = {};
    hit.has_material = true;
    std::ranges::fill(w.segment.transmittance, 1.0);
    trace(k_node_glossy, 1, &NodeRadiance::glossy);
}

}  // namespace uw
