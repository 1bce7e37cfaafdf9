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

NodeLattice::NodeLattice(const MultipleNodes& estimator, const Positions& positions)
    : estimator_(estimator), positions_(positions) {
    raw_.assign(positions.columns, positions.rows);
}

MultipleNodes::Place NodeLattice::place(int i, int j) const {
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

void append(const NodeLight& light, std::vector<float>& radiance) {
    radiance.insert(radiance.end(), light.diffuse.begin(), light.diffuse.end());
}

}  // namespace

IndirectLight NodeLattice::light_surfaces(const NodePaths& paths, const ShareCallback& progress) {
    for_each(
        all(), [&](double share) { progress(k_share_of_seen * share); },
        [&](int i, int j) { estimator_.estimate_surface(place(i, j), paths, raw_(i, j)); });
    smooth_ = smoothed_surfaces(raw_, estimator_.groups(), estimator_.bands());
    const std::size_t values = estimator_.groups() * estimator_.bands();
    std::vector<SurfacePoint> points;
    std::vector<float> radiance;
    for (const SmoothNode& node : smooth_) {
        if (!node.surface) continue;
        points.push_back({node.surface->position, node.surface->normal});
        append(node.light, radiance);
    }
    const std::vector<SurfaceSample> unseen =
        find_unseen_surfaces(IndirectLight(points, radiance, values));
    std::vector<NodeLight> lights(unseen.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(unseen.size(), [&](std::size_t at) {
        estimator_.estimate_surface(unseen[at], paths.surface, lights[at]);
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
std::vector<SurfaceSample> NodeLattice::find_unseen_surfaces(const IndirectLight& seen) const {
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
        const MultipleNodes::Place from =
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
                              const IndirectLight& indirect, const ShareCallback& progress) {
    double light = 0;
    for (const MultipleNode& node : raw_) light += node.mean_light;
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

// What smoothing takes from features, too, which it is as wide as the noise hides them.
constexpr double k_of_features = 2;

double diffuse_of(const MultipleNode& node) {
    return 0.5 * (node.halves[0].diffuse_mean + node.halves[1].diffuse_mean);
}

double typical_diffuse(const Grid2D<MultipleNode>& nodes) {
    double sum = 0, surfaces = 0;
    for (const MultipleNode& node : nodes) {
        if (!node.surface) continue;
        sum += diffuse_of(node);
        ++surfaces;
    }
    return surfaces > 0 ? sum / surfaces : 0;
}

// The camera's radiance per indirect light on a node's surface: of the surface itself, and of what
// water shows of the surfaces around it, on which light is as noisy. Much of what it shows in front
// of a dark one comes from elsewhere.
double light_of_diffuse(const MultipleNode& node, double typical) {
    constexpr double k_left = 0.5;  // of the noise by blurring
    const double diffuse = std::max(diffuse_of(node), typical);
    return node.surface_seen + (diffuse > 0 ? k_left * node.lit.mean / diffuse : 0);
}

}  // namespace

double NodeLattice::error(const Grid2D<SmoothNode>& nodes, const NodeWindow& window) const {
    const double diffuse = typical_diffuse(raw_);
    double variance = 0, light = 0;
    for (int j = window.j0; j < window.j1; ++j) {
        for (int i = window.i0; i < window.i1; ++i) {
            const double seen = light_of_diffuse(raw_(i, j), diffuse);
            light += raw_(i, j).mean_light;
            for (const float deviation : nodes(i, j).water_deviation)
                variance += static_cast<double>(deviation * deviation);
            for (const float deviation : nodes(i, j).diffuse_deviation)
                variance += seen * seen * static_cast<double>(deviation * deviation);
        }
    }
    if (!(light > 0)) return 0;
    const double nodes_of_bands =
        static_cast<double>(window.size()) / static_cast<double>(estimator_.bands());
    return std::sqrt(k_of_features * variance * nodes_of_bands) / light;
}

namespace {

// The paths of each kind at a node: more would leave less noise than there is light between the
// nodes of a small image.
constexpr double k_fewest_node_paths = 8, k_most_node_paths = 4096;
// What smoothing leaves of the variance of nodes, in the example scenes: 0.02 to 0.05, in plumes
// more, and how much more it is of that on surfaces, where fewer nodes see the same.
constexpr double k_smoothed_variance = 0.03, k_more_on_surfaces = 2.5;
// The work of each node and each path that the effort names.
constexpr double k_work_of_effort = 6;
constexpr double k_least_cost = 0.05;

}  // namespace

// Numbers in proportion to the deviation of a path over the root of its cost leave the least error.
NodePaths plan_paths(const MultipleNodes& estimator, const NodeEffort& effort) {
    constexpr int k_paths = 64, k_fewest_across = 5, k_most_across = 16;
    constexpr double k_share = 0.05;  // of the paths
    const int across = std::clamp(static_cast<int>(std::sqrt(k_share * effort.paths / k_paths)),
                                  k_fewest_across, k_most_across);
    NodeLattice pilot(estimator, NodeLattice::Positions::amid(estimator.rays(), across));
    const NodePaths few{k_paths, k_paths, k_paths};
    const ShareCallback untold = [](double) {};
    const IndirectLight indirect = pilot.light_surfaces(few, untold);
    pilot.light_water(pilot.all(), few, indirect, untold);
    NodePaths paths;
    const auto count = static_cast<double>(pilot.all().size());
    for (const MultipleNode& node : pilot.raw()) {
        paths.typical_water += node.guessed_water / count;
        paths.typical_surface += node.guessed_surface / count;
    }
    const double typical = typical_diffuse(pilot.raw());
    double light = 0;
    double of_surface = 0, of_lit = 0, of_water = 0;  // variances of a path
    struct {
        double surface, lit, water;
    } cost{0, 0, 0};  // of all paths of a kind
    for (const MultipleNode& node : pilot.raw()) {
        const double share = paths.water_share(node), of_its_surface = paths.surface_share(node);
        light += node.mean_light;
        of_lit += node.lit.variance / share;
        of_water += node.water.variance / share;
        cost.lit += share * node.lit.work;
        cost.water += share * node.water.work;
        cost.surface += of_its_surface * node.surface_work;
        if (!node.surface) continue;
        // That of either half's mean was of half the paths.
        const double variance = node.diffuse_variance * k_paths / 2 / of_its_surface;
        const double seen = light_of_diffuse(node, typical);
        of_surface += k_more_on_surfaces * variance * seen * seen;
    }
    for (double* of_kind : {&cost.surface, &cost.lit, &cost.water})
        *of_kind = std::max(*of_kind / count, k_least_cost);
    const double surface = std::sqrt(of_surface / cost.surface);
    const double seen = std::sqrt(of_lit / cost.lit), water = std::sqrt(of_water / cost.water);
    const double work = surface * cost.surface + seen * cost.lit + water * cost.water;
    double scale = work > 0 ? k_work_of_effort * effort.paths / effort.nodes / work : 0;
    if (work > 0 && effort.error > 0) {
        const double error = effort.error * light / count;
        scale = std::min(scale, k_smoothed_variance * work / count / (error * error));
    }
    const auto number = [&](double of_kind) {
        return static_cast<int>(
            std::clamp(scale * of_kind, k_fewest_node_paths, k_most_node_paths));
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
