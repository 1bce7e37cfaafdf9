#include "core/paths/node_lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.h"

namespace uw {

NodeLattice::Positions NodeLattice::Positions::over(const RaySource& rays, int spacing) {
    const auto steps = [&](int pixels) { return (pixels + spacing - 1) / spacing + 1; };
    const auto step = static_cast<double>(spacing);
    return {steps(rays.width()), steps(rays.height()), step, step, 0, 0};
}

NodeLattice::Positions NodeLattice::Positions::amid(const RaySource& rays, int parts) {
    return {parts,
            parts,
            static_cast<double>(rays.width()) / parts,
            static_cast<double>(rays.height()) / parts,
            0.5,
            1};
}

NodeLattice::NodeLattice(const RadianceEstimator& estimator, const Positions& positions)
    : estimator_(estimator), positions_(positions) {
    raw_.assign(positions.columns, positions.rows);
}

RadianceEstimator::Place NodeLattice::place(int i, int j) const {
    return {(i + positions_.offset) * positions_.step_x,
            (j + positions_.offset) * positions_.step_y,
            PathRandom::seed_of(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j),
                                positions_.seed)};
}

template <class Visit>
void NodeLattice::for_each(const NodeWindow& window, const ProgressCallback& progress,
                           const Visit& visit) const {
    const int columns = window.i1 - window.i0;
    const std::size_t count = window.size();
    std::atomic<std::size_t> done = 0;
    parallel_for(count, [&](std::size_t at) {
        visit(window.i0 + static_cast<int>(at) % columns,
              window.j0 + static_cast<int>(at) / columns);
        progress(static_cast<double>(++done) / static_cast<double>(count));
    });
}

namespace {

constexpr double k_visible_fraction = 0.85;  // of the time

void append(const NodeRadiance& light, std::vector<float>& radiance) {
    radiance.insert(radiance.end(), light.diffuse.begin(), light.diffuse.end());
}

}  // namespace

IrradianceCache NodeLattice::light_surfaces(const NodePaths& paths,
                                            const ProgressCallback& progress) {
    for_each(
        all(), [&](double fraction) { progress(k_visible_fraction * fraction); },
        [&](int i, int j) { estimator_.estimate_surface(place(i, j), paths, raw_(i, j)); });
    smooth_ = smoothed_surfaces(raw_, estimator_.groups(), estimator_.bands());
    const std::size_t values = estimator_.groups() * estimator_.bands();
    std::vector<IrradianceRecord> points;
    std::vector<float> radiance;
    for (const SmoothNode& node : smooth_) {
        if (!node.surface) continue;
        points.push_back({node.surface->position, node.surface->normal});
        append(node.light, radiance);
    }
    const std::vector<SurfaceSample> unseen =
        find_unseen_surfaces(IrradianceCache(points, radiance, values));
    std::vector<NodeRadiance> lights(unseen.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(unseen.size(), [&](std::size_t at) {
        SurfaceErrors errors;
        estimator_.estimate_surface(unseen[at], static_cast<int>(paths.mean().surface), lights[at],
                                    errors);
        progress(k_visible_fraction + (1 - k_visible_fraction) * static_cast<double>(++done) /
                                          static_cast<double>(unseen.size()));
    });
    for (std::size_t at = 0; at < unseen.size(); ++at) {
        points.push_back({unseen[at].hit.position, unseen[at].hit.normal});
        append(lights[at], radiance);
    }
    return {std::move(points), std::move(radiance), values};
}

// Traces a few paths from some of the nodes. Where they meet a surface on which no nearby record
// applies, a record is added.
std::vector<SurfaceSample> NodeLattice::find_unseen_surfaces(const IrradianceCache& visible) const {
    constexpr int k_step = 3, k_paths = 4;
    constexpr double k_max_spacing = 0.1;            // relative to the distance from the camera
    constexpr double k_min_cosine_of_normals = 0.7;  // cosine between normals that count as alike
    constexpr std::size_t k_max_surfaces = 3000;
    const int columns = (raw_.width() + k_step - 1) / k_step;
    const int rows = (raw_.height() + k_step - 1) / k_step;
    struct Found {
        SurfaceSample sample;
        double radius;  // of the surroundings that it represents [m]
    };
    Grid2D<std::vector<Found>> found(columns, rows);
    parallel_for(found.size(), [&](std::size_t at) {
        std::vector<SurfaceSample> samples;
        const RadianceEstimator::Place from =
            place(static_cast<int>(at) % columns * k_step, static_cast<int>(at) / columns * k_step);
        const Point3 camera = estimator_.find_lit_surfaces(from, k_paths, samples);
        for (const SurfaceSample& sample : samples) {
            const double radius = k_max_spacing * glm::length(sample.hit.position - camera);
            if (!visible.covers(sample.hit, radius)) found[at].push_back({sample, radius});
        }
    });
    std::vector<SurfaceSample> unseen;
    for (const std::vector<Found>& of_node : found) {
        for (const Found& candidate : of_node) {
            const SurfaceHit& hit = candidate.sample.hit;
            const bool is_known = std::ranges::any_of(unseen, [&](const SurfaceSample& other) {
                return glm::length(other.hit.position - hit.position) < candidate.radius &&
                       glm::dot(other.hit.normal, hit.normal) > k_min_cosine_of_normals;
            });
            if (is_known || unseen.size() == k_max_surfaces) continue;
            unseen.push_back(candidate.sample);
            // The random numbers of its estimate depend on its index.
            unseen.back().x = static_cast<double>(unseen.size());
            unseen.back().y = -1;
        }
    }
    return unseen;
}

void NodeLattice::light_water(const NodeWindow& window, const NodePaths& paths,
                              const IrradianceCache& indirect, const ProgressCallback& progress) {
    double light = 0;
    for (const RadianceNode& node : raw_) light += node.mean_light;
    light /= static_cast<double>(raw_.size());
    for_each(window, progress, [&](int i, int j) {
        estimator_.estimate_water(place(i, j), paths, indirect, light, raw_(i, j));
    });
}

Grid2D<SmoothNode> NodeLattice::smoothed(const NodeWindow& window,
                                         const DistanceIntervals& intervals) const {
    Grid2D<SmoothNode> nodes = smooth_;
    smooth_water(raw_, window, intervals, estimator_.groups(), estimator_.bands(), nodes);
    return nodes;
}

namespace {

double diffuse_of(const RadianceNode& node) {
    return 0.5 * (node.halves[0].diffuse_mean + node.halves[1].diffuse_mean);
}

double typical_diffuse(const Grid2D<RadianceNode>& nodes) {
    double sum = 0, surfaces = 0;
    for (const RadianceNode& node : nodes) {
        if (!node.surface) continue;
        sum += diffuse_of(node);
        ++surfaces;
    }
    return surfaces > 0 ? sum / surfaces : 0;
}

// The part of the water's light that comes from the surfaces around a node, per indirect light on
// them. In front of a dark surface much of it comes from elsewhere: the divisor is the typical
// indirect light, if that is greater than the node's own.
double halo_of_diffuse(double lit_indirect, double diffuse, double typical) {
    constexpr double k_remaining_noise = 0.5;  // fraction that the blur leaves
    const double of_surfaces = std::max(diffuse, typical);
    return of_surfaces > 0 ? k_remaining_noise * lit_indirect / of_surfaces : 0;
}

// The camera's radiance per indirect light on a node's surface: that of the surface itself, and of
// the halo of the surfaces around it, whose indirect light is as noisy.
double throughput_of_diffuse(const RadianceNode& node, double typical) {
    double lit = 0;
    for (const float light : node.lit_indirect)
        lit += static_cast<double>(light) / static_cast<double>(node.lit_indirect.size());
    return node.surface_throughput + halo_of_diffuse(lit, diffuse_of(node), typical);
}

// Adds the indirect light on the node's surface, the mean of both halves, by band.
void add_diffuse(const RadianceNode& node, std::span<double> diffuse) {
    for (const NodeRadiance& half : node.halves)
        for (std::size_t k = 0; k < half.diffuse.size(); ++k)
            diffuse[k % diffuse.size()] += 0.5 * static_cast<double>(half.diffuse[k]);
}

/// Sums over some nodes, by band: of squared errors, and of the squares that these are relative to.
struct ErrorSquares {
    std::vector<double> variances, shifts, noise, squares;

    void begin(std::size_t bands) {
        for (std::vector<double>* sums : {&variances, &shifts, &noise, &squares})
            sums->assign(bands, 0.0);
    }
    /// `shift`: of both halves; may be empty.
    void add(std::span<const float> variance, const std::array<std::vector<float>, 2>& shift) {
        for (std::size_t b = 0; b < variance.size(); ++b) {
            variances[b] += static_cast<double>(variance[b]);
            if (shift[0].empty()) continue;
            const float difference = shift[0][b] - shift[1][b];
            shifts[b] += static_cast<double>(shift[0][b] * shift[1][b]);
            noise[b] += 0.5 * static_cast<double>(difference * difference);
        }
    }
    void add_squares_of(double value) {
        for (double& sum : squares) sum += value * value;
    }
    // The product of the shifts estimates the squared bias, which both halves have in common. Its
    // noise is of either sign, and about half the variance of one half's shift, as some four of the
    // nodes around are independent.
    void store(std::vector<float>& errors) const {
        constexpr double k_noise_of_product = 0.5;
        errors.assign(variances.size(), 0.0F);
        for (std::size_t b = 0; b < errors.size(); ++b)
            if (squares[b] > 0)
                errors[b] = static_cast<float>(std::sqrt(
                    (variances[b] + std::max(0.0, shifts[b] - k_noise_of_product * noise[b])) /
                    squares[b]));
    }
};

}  // namespace

void NodeLattice::find_errors(const NodeWindow& window, Grid2D<SmoothNode>& nodes) const {
    const std::size_t bands = estimator_.bands();
    std::vector<double> typical(bands);
    double surfaces = 0;
    for (const RadianceNode& node : raw_) {
        if (!node.surface) continue;
        add_diffuse(node, typical);
        ++surfaces;
    }
    for (double& value : typical) value /= std::max(surfaces, 1.0);
    const int columns = window.i1 - window.i0;
    parallel_for(window.size(), [&](std::size_t at) {
        const int i = window.i0 + static_cast<int>(at) % columns;
        const int j = window.j0 + static_cast<int>(at) / columns;
        const RadianceNode& own = raw_(i, j);
        SmoothNode& node = nodes(i, j);
        std::vector<double> weights, diffuse;
        ErrorSquares water, of_diffuse, of_glossy, around;
        for (ErrorSquares* sums : {&water, &of_diffuse, &of_glossy, &around}) sums->begin(bands);
        for (int v = std::max(window.j0, j - k_variance_radius);
             v <= std::min(window.j1 - 1, j + k_variance_radius); ++v) {
            for (int u = std::max(window.i0, i - k_variance_radius);
                 u <= std::min(window.i1 - 1, i + k_variance_radius); ++u) {
                const SmoothNode& other = nodes(u, v);
                weights.assign(bands, 0.0);
                const std::vector<float>& of_other = raw_(u, v).weights;
                for (std::size_t k = 0; k < of_other.size(); ++k)
                    weights[k % bands] += static_cast<double>(of_other[k]);
                water.add(other.water_variance, other.water_shift);
                for (std::size_t b = 0; b < bands; ++b) water.squares[b] += weights[b] * weights[b];
                if (!other.surface) continue;
                around.add(other.diffuse_variance, other.diffuse_shift);
                around.add_squares_of(1);
                if (!see_same_surface(own, raw_(u, v))) continue;
                of_diffuse.add(other.diffuse_variance, other.diffuse_shift);
                of_diffuse.add_squares_of(1);
                of_glossy.add(other.glossy_variance, {});
                of_glossy.add_squares_of(1);
            }
        }
        water.store(node.water_error);
        of_diffuse.store(node.surface_errors.diffuse);
        of_glossy.store(node.surface_errors.glossy);
        around.store(node.halo_error);
        diffuse.assign(bands, 0.0);
        add_diffuse(own, diffuse);
        for (std::size_t b = 0; b < bands; ++b)
            node.halo_error[b] *=
                own.lit_indirect.empty()
                    ? 0.0F
                    : static_cast<float>(halo_of_diffuse(static_cast<double>(own.lit_indirect[b]),
                                                         diffuse[b], typical[b]));
    });
}

namespace {

// Bounds for the numbers of paths of each kind at a node. More paths would leave less noise than
// the light varies between the nodes of a small image.
constexpr double k_min_node_paths = 8, k_max_node_paths = 4096;
// The variance that remains after smoothing, as measured in the example scenes: 0.02 to 0.05, more
// in plumes; and the factor by which more of it remains on surfaces, where fewer nodes see the
// same.
constexpr double k_smoothed_variance = 0.03, k_more_on_surfaces = 2.5;
// The work of each node and each path in units of the effort.
constexpr double k_work_of_effort = 6;
constexpr double k_min_cost = 0.05;
// The errors of nodes darker than this, relative to the mean light, count as if they were as
// bright.
constexpr double k_min_light = 0.1;
// The numbers of paths are at least this, relative to their mean: the pilot's may have missed the
// rare light of a dark part.
constexpr double k_min_of_mean = 0.3;

/// What a pilot knows of a part of the image, as means over the parts around it.
struct PilotPart {
    double light = 0;
    PathNumbers variance;  // of a single path of each kind, relative to the squared light
    PathNumbers cost;      // of a path of each kind
};

PilotPart part_of_pilot(const Grid2D<RadianceNode>& nodes, int i, int j, double min_light,
                        double typical, int paths) {
    PilotPart part{.variance = {0, 0, 0}, .cost = {0, 0, 0}};
    double count = 0;
    visit_around(nodes, i, j, 1, [&](const RadianceNode& node) {
        ++count;
        part.light += node.mean_light;
        part.variance.lit += node.lit.variance;
        part.variance.water += node.water.variance;
        part.cost.lit += node.lit.work;
        part.cost.water += node.water.work;
        part.cost.surface += node.surface_work;
        if (!node.surface) return;
        // Each half's mean is over half the paths.
        const double of_halves =
            0.5 * (node.halves[0].diffuse_variance + node.halves[1].diffuse_variance);
        const double throughput = throughput_of_diffuse(node, typical);
        part.variance.surface +=
            k_more_on_surfaces * of_halves * paths / 2 * throughput * throughput;
    });
    part.light = std::max(part.light / count, min_light);
    for (double* variance : {&part.variance.surface, &part.variance.lit, &part.variance.water})
        *variance /= count * part.light * part.light;
    for (double* cost : {&part.cost.surface, &part.cost.lit, &part.cost.water})
        *cost = std::max(*cost / count, k_min_cost);
    return part;
}

}  // namespace

// Numbers of paths in proportion to standard deviation / sqrt(cost) minimise the error. Errors are
// relative to the light of each part of the image, so that dark water counts as much as what a lamp
// lights up.
NodePaths plan_paths(const RadianceEstimator& estimator, const NodeEffort& effort) {
    constexpr int k_paths = 64, k_min_across = 5, k_max_across = 16;
    constexpr double k_pilot_fraction = 0.05;  // of the paths
    const int across =
        std::clamp(static_cast<int>(std::sqrt(k_pilot_fraction * effort.paths / k_paths)),
                   k_min_across, k_max_across);
    const RaySource& rays = estimator.rays();
    NodeLattice pilot(estimator, NodeLattice::Positions::amid(rays, across));
    const NodePaths pilot_paths({k_paths, k_paths, k_paths});
    const ProgressCallback no_progress = [](double) {};
    const IrradianceCache indirect = pilot.light_surfaces(pilot_paths, no_progress);
    pilot.light_water(pilot.all(), pilot_paths, indirect, no_progress);
    const Grid2D<RadianceNode>& nodes = pilot.raw();
    const auto count = static_cast<double>(nodes.size());
    double light = 0;
    for (const RadianceNode& node : nodes) light += node.mean_light / count;
    const double typical = typical_diffuse(nodes);
    Grid2D<NodePaths::Part> parts;
    parts.assign(across, across);
    double work = 0;
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < across; ++i) {
            const PilotPart part =
                part_of_pilot(nodes, i, j, k_min_light * light, typical, k_paths);
            PathNumbers& numbers = parts(i, j).numbers;
            const auto weigh = [&](double variance, double cost) {
                work += std::sqrt(variance * cost) / count;
                return std::sqrt(variance / cost);
            };
            numbers.surface = weigh(part.variance.surface, part.cost.surface);
            numbers.lit = weigh(part.variance.lit, part.cost.lit);
            numbers.water = weigh(part.variance.water, part.cost.water);
            parts(i, j).estimated_water = nodes(i, j).estimated_water;
            parts(i, j).estimated_surface = nodes(i, j).estimated_surface;
        }
    }
    double scale = work > 0 ? k_work_of_effort * effort.paths / effort.nodes / work : 0;
    if (work > 0 && effort.error > 0)
        scale = std::min(scale, k_smoothed_variance * work / (effort.error * effort.error));
    for (double PathNumbers::*kind :
         {&PathNumbers::surface, &PathNumbers::lit, &PathNumbers::water}) {
        double mean = 0;
        for (const NodePaths::Part& part : parts) mean += part.numbers.*kind / count;
        for (NodePaths::Part& part : parts)
            part.numbers.*kind =
                std::clamp(scale * std::max(part.numbers.*kind, k_min_of_mean * mean),
                           k_min_node_paths, k_max_node_paths);
    }
    // The few paths that meet water close to a lamp are bright, and too few of them leave spots.
    constexpr double k_min_in_water = 8;
    for (NodePaths::Part& part : parts)
        part.numbers.water =
            std::max(part.numbers.water, std::min(k_min_in_water, effort.paths / effort.nodes));
    return {std::move(parts), static_cast<double>(rays.width()),
            static_cast<double>(rays.height())};
}

}  // namespace uw
