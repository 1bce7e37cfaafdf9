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
void NodeLattice::for_each(const NodeWindow& window, const ShareCallback& progress,
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

constexpr double k_share_of_seen = 0.85;  // of the time

void append(const NodeRadiance& light, std::vector<float>& radiance) {
    radiance.insert(radiance.end(), light.diffuse.begin(), light.diffuse.end());
}

}  // namespace

IrradianceCache NodeLattice::light_surfaces(const NodePaths& paths, const ShareCallback& progress) {
    for_each(
        all(), [&](double share) { progress(k_share_of_seen * share); },
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
        thread_local SurfaceErrors errors;
        estimator_.estimate_surface(unseen[at], paths.surface, lights[at], errors);
        progress(k_share_of_seen + (1 - k_share_of_seen) * static_cast<double>(++done) /
                                       static_cast<double>(unseen.size()));
    });
    for (std::size_t at = 0; at < unseen.size(); ++at) {
        points.push_back({unseen[at].hit.position, unseen[at].hit.normal});
        append(lights[at], radiance);
    }
    return {std::move(points), std::move(radiance), values};
}

// A few paths from some of the nodes tell where. Where they meet a surface, and no point is near
// that tells of it, there will be one.
std::vector<SurfaceSample> NodeLattice::find_unseen_surfaces(const IrradianceCache& seen) const {
    constexpr int k_step = 3, k_paths = 4;
    constexpr double k_near = 0.1;   // relative to the distance from the camera
    constexpr double k_alike = 0.7;  // cosine between the normals
    constexpr std::size_t k_most = 3000;
    const int columns = (raw_.width() + k_step - 1) / k_step;
    const int rows = (raw_.height() + k_step - 1) / k_step;
    struct Found {
        SurfaceSample sample;
        double reach;  // of what it tells about [m]
    };
    Grid2D<std::vector<Found>> found(columns, rows);
    parallel_for(found.size(), [&](std::size_t at) {
        thread_local std::vector<SurfaceSample> samples;
        const RadianceEstimator::Place from =
            place(static_cast<int>(at) % columns * k_step, static_cast<int>(at) / columns * k_step);
        const Point3 camera = estimator_.find_lit_surfaces(from, k_paths, samples);
        for (const SurfaceSample& sample : samples) {
            const double reach = k_near * glm::length(sample.hit.position - camera);
            if (!seen.covers(sample.hit, reach)) found[at].push_back({sample, reach});
        }
    });
    std::vector<SurfaceSample> unseen;
    for (const std::vector<Found>& of_node : found) {
        for (const Found& candidate : of_node) {
            const SurfaceHit& hit = candidate.sample.hit;
            const bool is_known = std::ranges::any_of(unseen, [&](const SurfaceSample& other) {
                return glm::length(other.hit.position - hit.position) < candidate.reach &&
                       glm::dot(other.hit.normal, hit.normal) > k_alike;
            });
            if (is_known || unseen.size() == k_most) continue;
            unseen.push_back(candidate.sample);
            // Its random numbers depend on its place in the list.
            unseen.back().x = static_cast<double>(unseen.size());
            unseen.back().y = -1;
        }
    }
    return unseen;
}

void NodeLattice::light_water(const NodeWindow& window, const NodePaths& paths,
                              const IrradianceCache& indirect, const ShareCallback& progress) {
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

// What the water shows of the surfaces around a node, by the indirect light on them. Much of what
// it shows in front of a dark one comes from elsewhere: the light is divided by what is typical, if
// that is more than the node's own.
double halo_of_diffuse(double lit_indirect, double diffuse, double typical) {
    constexpr double k_left = 0.5;  // of the noise by blurring
    const double of_surfaces = std::max(diffuse, typical);
    return of_surfaces > 0 ? k_left * lit_indirect / of_surfaces : 0;
}

// The camera's radiance per indirect light on a node's surface: of the surface itself, and of what
// water shows of the surfaces around it, on which light is as noisy.
double light_of_diffuse(const RadianceNode& node, double typical) {
    double lit = 0;
    for (const float light : node.lit_indirect)
        lit += static_cast<double>(light) / static_cast<double>(node.lit_indirect.size());
    return node.surface_seen + halo_of_diffuse(lit, diffuse_of(node), typical);
}

// The indirect light that either half of a node finds on its surface, by band.
void add_diffuse(const RadianceNode& node, std::span<double> diffuse) {
    for (const NodeRadiance& half : node.halves)
        for (std::size_t k = 0; k < half.diffuse.size(); ++k)
            diffuse[k % diffuse.size()] += 0.5 * static_cast<double>(half.diffuse[k]);
}

/// By band, sums over some nodes of the squares of errors, and of what these are relative to.
struct ErrorSquares {
    std::vector<double> variances, shifts, noise, squares;

    void begin(std::size_t bands) {
        for (std::vector<double>* sums : {&variances, &shifts, &noise, &squares})
            sums->assign(bands, 0.0);
    }
    /// `shift`: of either half, or of none.
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
    // The product of the shifts is the square of what is alike in both halves, and of noise, which
    // is of either sign: half the variance of a half's shift, as some four of the nodes around are
    // independent.
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
        thread_local std::vector<double> weights, diffuse;
        thread_local ErrorSquares water, of_diffuse, of_glossy, around;
        for (ErrorSquares* sums : {&water, &of_diffuse, &of_glossy, &around}) sums->begin(bands);
        for (int v = std::max(window.j0, j - k_variance_reach);
             v <= std::min(window.j1 - 1, j + k_variance_reach); ++v) {
            for (int u = std::max(window.i0, i - k_variance_reach);
                 u <= std::min(window.i1 - 1, i + k_variance_reach); ++u) {
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

// The paths of each kind at a node: more would leave less noise than there is light between the
// nodes of a small image.
constexpr double k_fewest_node_paths = 8, k_max_node_paths = 4096;
// What smoothing leaves of the variance of nodes, in the example scenes: 0.02 to 0.05, in plumes
// more, and how much more it is of that on surfaces, where fewer nodes see the same.
constexpr double k_smoothed_variance = 0.03, k_more_on_surfaces = 2.5;
// The work of each node and each path that the effort names.
constexpr double k_work_of_effort = 6;
constexpr double k_min_cost = 0.05;

}  // namespace

// Numbers in proportion to the deviation of a path over the root of its cost leave the least error.
NodePaths plan_paths(const RadianceEstimator& estimator, const NodeEffort& effort) {
    constexpr int k_paths = 64, k_fewest_across = 5, k_max_across = 16;
    constexpr double k_share = 0.05;  // of the paths
    const int across = std::clamp(static_cast<int>(std::sqrt(k_share * effort.paths / k_paths)),
                                  k_fewest_across, k_max_across);
    NodeLattice pilot(estimator, NodeLattice::Positions::amid(estimator.rays(), across));
    const NodePaths few{k_paths, k_paths, k_paths};
    const ShareCallback untold = [](double) {};
    const IrradianceCache indirect = pilot.light_surfaces(few, untold);
    pilot.light_water(pilot.all(), few, indirect, untold);
    NodePaths paths;
    const auto count = static_cast<double>(pilot.all().size());
    for (const RadianceNode& node : pilot.raw()) {
        paths.typical_water += node.estimated_water / count;
        paths.typical_surface += node.estimated_surface / count;
    }
    const double typical = typical_diffuse(pilot.raw());
    double light = 0;
    double of_surface = 0, of_lit = 0, of_water = 0;  // variances of a path
    struct {
        double surface, lit, water;
    } cost{0, 0, 0};  // of all paths of a kind
    for (const RadianceNode& node : pilot.raw()) {
        const double share = paths.water_share(node), of_its_surface = paths.surface_share(node);
        light += node.mean_light;
        of_lit += node.lit.variance / share;
        of_water += node.water.variance / share;
        cost.lit += share * node.lit.work;
        cost.water += share * node.water.work;
        cost.surface += of_its_surface * node.surface_work;
        if (!node.surface) continue;
        // That of either half's mean was of half the paths.
        const double of_halves =
            0.5 * (node.halves[0].diffuse_variance + node.halves[1].diffuse_variance);
        const double variance = of_halves * k_paths / 2 / of_its_surface;
        const double seen = light_of_diffuse(node, typical);
        of_surface += k_more_on_surfaces * variance * seen * seen;
    }
    for (double* of_kind : {&cost.surface, &cost.lit, &cost.water})
        *of_kind = std::max(*of_kind / count, k_min_cost);
    const double surface = std::sqrt(of_surface / cost.surface);
    const double seen = std::sqrt(of_lit / cost.lit), water = std::sqrt(of_water / cost.water);
    const double work = surface * cost.surface + seen * cost.lit + water * cost.water;
    double scale = work > 0 ? k_work_of_effort * effort.paths / effort.nodes / work : 0;
    if (work > 0 && effort.error > 0) {
        const double error = effort.error * light / count;
        scale = std::min(scale, k_smoothed_variance * work / count / (error * error));
    }
    const auto number = [&](double of_kind) {
        return static_cast<int>(std::clamp(scale * of_kind, k_fewest_node_paths, k_max_node_paths));
    };
    // The few that find water close to a lamp are bright, and rare: some show as spots.
    constexpr double k_fewest_in_water = 8;
    const int fewest_water =
        static_cast<int>(std::min(k_fewest_in_water, effort.paths / effort.nodes));
    paths.surface = number(surface);
    paths.lit = number(seen);
    paths.water = std::max(number(water), fewest_water);
    return paths;
}

}  // namespace uw
