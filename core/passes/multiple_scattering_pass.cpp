#include "core/passes/multiple_scattering_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/passes/error_sums.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/node_lattice.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/radiance_nodes.h"
#include "core/paths/surface_halo.h"

namespace uw {

namespace {

// The spacing of the rays of WeightLattice [pixels] leaves enough of them to show where particles
// begin, but stores no more than k_max_numbers weights for the whole image.
constexpr int k_max_spacing_of_weights = 4;
constexpr double k_min_rays = 8000;
constexpr double k_max_numbers = 1e7;
constexpr double k_pixel_centre = 0.5;  // offset of a pixel's centre from its corner [pixels]

}  // namespace

WeightLattice::WeightLattice(const RaySource& rays, const IntervalWeights& weights,
                             const PixelWindow& window)
    : uniform_(weights.of_uniform_water()) {
    if (!weights.vary()) return;
    const double pixels = static_cast<double>(rays.width()) * rays.height();
    const double numbers = pixels * static_cast<double>(uniform_.size());
    spacing_ = std::max(
        std::clamp(static_cast<int>(std::sqrt(pixels / k_min_rays)), 1, k_max_spacing_of_weights),
        static_cast<int>(std::ceil(std::sqrt(numbers / k_max_numbers))));
    column_ = window.x0 / spacing_;
    row_ = window.y0 / spacing_;
    const auto steps = [&](int first, int end) {
        return std::max(2, (end - 1 + spacing_ - 1) / spacing_ - first + 1);
    };
    const int columns = steps(column_, window.x1), rows = steps(row_, window.y1);
    rays_.assign(columns, rows);
    parallel_for(rays_.size(), [&](std::size_t at) {
        const int i = static_cast<int>(at) % columns, j = static_cast<int>(at) / columns;
        const auto ray =
            rays.refracted_ray(k_pixel_centre + (column_ + i) * static_cast<double>(spacing_),
                               k_pixel_centre + (row_ + j) * static_cast<double>(spacing_));
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
    const double u = (x - k_pixel_centre) / spacing_ - column_,
                 v = (y - k_pixel_centre) / spacing_ - row_;
    const int i = std::clamp(static_cast<int>(u), 0, rays_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, rays_.height() - 2);
    weights.assign(uniform_.size(), 0.0F);
    const auto add = [&](int column, int row, double weight) {
        const std::vector<float>& corner = rays_(column, row);
        for (std::size_t k = 0; k < weights.size(); ++k)
            weights[k] += static_cast<float>(weight) * corner[k];
    };
    add(i, j, (1 - u + i) * (1 - v + j));
    add(i + 1, j, (u - i) * (1 - v + j));
    add(i, j + 1, (1 - u + i) * (v - j));
    add(i + 1, j + 1, (u - i) * (v - j));
}

namespace {

/// Evaluates the radiance of surfaces that SurfaceHalo blurs: direct light and emission, which are
/// exact, and indirect light from the irradiance cache.
class HaloSource {
  public:
    /// The references must outlive this object.
    HaloSource(const PixelRenderer& pixels, const IrradianceCache& indirect)
        : pixels_(pixels),
          indirect_(indirect),
          bands_(static_cast<std::size_t>(pixels.band_count())) {}

    /// Sets `radiance` to what arrives at the camera from `sample`, which is number `index` of
    /// `light`: [group * bands + band]. Thread safe.
    void find_radiance(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                       std::span<double> radiance) const;

  private:
    const PixelRenderer& pixels_;
    const IrradianceCache& indirect_;
    std::size_t bands_;
};

void HaloSource::find_radiance(const SurfaceSample& sample, const SurfaceLight& light,
                               std::size_t index, std::span<double> radiance) const {
    const std::size_t groups = radiance.size() / bands_;
    const LitScene& scene = pixels_.scene();
    if (is_specular(sample.hit)) {  // the light that it mirrors counts as that of lamps
        std::ranges::fill(radiance, 0.0);
        return;
    }
    const std::span<const double> to_camera = light.to_camera(index);
    indirect_.find(sample.hit, radiance);
    for (std::size_t k = 0; k < radiance.size(); ++k)
        radiance[k] *= sample.hit.reflectance[k % bands_] * to_camera[k % bands_];
    const SurfaceReflection reflection(*scene.surfaces, sample, static_cast<int>(bands_));
    if (reflection.emits())
        for (std::size_t b = 0; b < bands_; ++b)
            radiance[(groups - 1) * bands_ + b] += reflection.emission()[b] * to_camera[b];
    Spectrum brdf;
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(index, j)) continue;
        const Lamp& emitter = light.emitters()[j];
        brdf_for(emitter, reflection, sample, brdf);
        double* sum = &radiance[std::min(emitter.index(), groups - 1) * bands_];
        for (std::size_t b = 0; b < bands_; ++b)
            sum[b] += light.irradiance(index, j, b) * brdf[b] * to_camera[b];
    }
}

}  // namespace

/// Options of MultipleScattering.
struct MultipleLightOptions {
    int paths = 0;       // maximum of each kind, over all nodes of the image
    double error = 0;    // target, relative to the image's mean; 0: none, all paths are traced
    int nodes = 0;       // approximate number in the whole image
    int cells = 0;       // maximum number of cells of SurfaceHalo
    bool lamps = false;  // whether to separate the light by lamp
};

namespace {

// A node sees the same surface as a pixel if their normals agree (k_min_node_cosine) and the
// pixel's point lies within this distance of the node's tangent plane, relative to the distance of
// the two points.
constexpr double k_max_slope = 0.35;
constexpr double k_min_cosine_of_match = 0.7;  // of normals, if no node reaches k_min_node_cosine
constexpr int k_search_radius = 3;             // radius of the search if no corner matches [cells]
constexpr int k_paths_of_sample = 32;          // of a sample that no node matches
// Records of the cache within this distance serve for it, relative to the distance of the camera.
constexpr double k_max_distance_in_cache = 0.05;
constexpr int k_mirrored_paths = 8;  // of a pixel with glossy surfaces

double lerp_weight(double t, int side) {
    return side == 0 ? 1 - t : t;
}

// Returns the smallest spacing that gives no more than `nodes`, not counting those at the edges.
int spacing_for(const RaySource& rays, int nodes) {
    const double area = static_cast<double>(rays.width()) * rays.height();
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(area / nodes))));
}

}  // namespace

/// Estimates and interpolates the light of MultipleScatteringPass for one image.
class MultipleScattering {
  public:
    /// `pixels` must outlive this object; its light transport must have paths.
    MultipleScattering(const PixelRenderer& pixels, const MultipleLightOptions& options);

    /// Computes the nodes that the pixels of `window` need. Throws Interrupted if the work is to
    /// stop, InputError if the nodes do not fit into free memory.
    void prepare(const PixelWindow& window, const ProgressCallback& progress);

    /// Adds a pixel's light to multiple_volume, multiple_surface and the lamps of `result`, and
    /// sets its error. The samples of `view` begin at `first_sample` of `light`. Thread safe.
    void add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
             PixelResult& result) const;

    /// Rendering::multiple_up_to. Thread safe.
    Spectrum light_of_water(const PixelView& view, double distance) const;

  private:
    struct Corner {
        const SmoothNode* node;
        double weight;
    };

    void subtract_halo(NodeLattice& lattice);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_matches(double x, double y, const SurfaceHit& hit,
                      std::vector<Corner>& matches) const;
    void find_matches(double x, double y, const SurfaceHit& hit, double min_cosine,
                      std::vector<Corner>& matches) const;
    struct Errors;

    double halo_fraction(double scattered, double distance, std::size_t band) const;
    void distribute_halo(const RadianceNode& node, std::span<float> halo) const;
    void add_water(const PixelView& view, std::span<double> light, Errors& errors) const;
    void add_volume(const PixelView& view, PixelResult& result, Errors& errors) const;
    void estimate_unmatched(const SurfaceSample& sample, SmoothNode& node) const;
    void add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                     PixelResult& result, Errors& errors) const;
    void add_to_lamp(std::size_t group, std::size_t band, double radiance,
                     PixelResult& result) const;

    const PixelRenderer& pixels_;
    MultipleLightOptions options_;
    std::size_t bands_;
    int spacing_ = 1;  // of the nodes [pixels]
    DistanceIntervals intervals_;
    IntervalWeights weights_;
    RadianceEstimator estimator_;
    WeightLattice weight_lattice_;  // this and the following: from prepare on
    std::optional<IrradianceCache> indirect_;
    Grid2D<SmoothNode> nodes_;
    std::optional<SurfaceHalo> halo_;
};

/// Standard errors of the light of a pixel, by band.
struct MultipleScattering::Errors {
    Spectrum water;     // of in-scattered light from the nodes
    Spectrum surfaces;  // of indirect light on surfaces, visible directly or as halo
    // Sums, over the pixel's own paths, of the light that glossy surfaces mirror, and of its
    // squares.
    Spectrum mirrored, mirrored_squares;
    double mirrored_paths = 0;

    double of_band(std::size_t b) const {
        const double sum = mirrored[b];
        const double spread =
            mirrored_paths > 1 ? std::max(0.0, mirrored_squares[b] - sum * sum / mirrored_paths) *
                                     mirrored_paths / (mirrored_paths - 1)
                               : 0;
        return std::sqrt(water[b] * water[b] + surfaces[b] * surfaces[b] + spread);
    }
};

MultipleScattering::MultipleScattering(const PixelRenderer& pixels,
                                       const MultipleLightOptions& options)
    : pixels_(pixels),
      options_(options),
      bands_(static_cast<std::size_t>(pixels.band_count())),
      spacing_(spacing_for(pixels.rays(), options.nodes)),
      intervals_(pixels.rays(), pixels.scene()),
      weights_(pixels.scene(), intervals_),
      estimator_(pixels.rays(), pixels.scene(), pixels.transport(), weights_,
                 options.lamps ? static_cast<std::size_t>(pixels.lamp_count()) + 1 : 1) {}

void MultipleScattering::prepare(const PixelWindow& window, const ProgressCallback& progress) {
    const RaySource& rays = pixels_.rays();
    NodeLattice lattice(estimator_, NodeLattice::Positions::over(rays, spacing_));
    // Include the corners of all cells in the window, and the nodes to which these are fitted.
    constexpr int k_margin = k_smoothing_radius + k_search_radius + 1;
    const NodeWindow nodes{std::max(0, window.x0 / spacing_ - k_margin),
                           std::max(0, window.y0 / spacing_ - k_margin),
                           std::min(lattice.all().i1, (window.x1 - 1) / spacing_ + 2 + k_margin),
                           std::min(lattice.all().j1, (window.y1 - 1) / spacing_ + 2 + k_margin)};
    require_room_for_nodes(nodes.size(), intervals_.count(), estimator_.groups(), pixels_.scene());
    const NodePaths paths =
        plan_paths(estimator_, {static_cast<double>(options_.paths),
                                static_cast<int>(lattice.all().size()), options_.error});
    constexpr double k_surface_fraction = 0.4;  // of the work: the cache of light on surfaces
    indirect_.emplace(lattice.light_surfaces(
        paths, [&](double fraction) { progress(k_surface_fraction * fraction); }));
    lattice.light_water(nodes, paths, *indirect_, [&](double fraction) {
        progress(k_surface_fraction + (1 - k_surface_fraction) * fraction);
    });
    subtract_halo(lattice);
    weight_lattice_ = WeightLattice(rays, weights_, window);
    nodes_ = lattice.smoothed(nodes, intervals_);
    lattice.find_errors(nodes, nodes_);
}

// Computes the halo and subtracts it from the light of the nodes.
void MultipleScattering::subtract_halo(NodeLattice& lattice) {
    const std::size_t groups = estimator_.groups();
    const HaloSource source(pixels_, *indirect_);
    const auto radiance = [&](const SurfaceSample& sample, const SurfaceLight& light,
                              std::size_t index, std::span<double> channels) {
        source.find_radiance(sample, light, index, channels);
    };
    Grid2D<RadianceNode>& raw = lattice.raw();
    std::vector<SurfaceHalo::Position> positions;
    for (int j = 0; j < raw.height(); ++j)
        for (int i = 0; i < raw.width(); ++i)
            positions.push_back({lattice.place(i, j).x, lattice.place(i, j).y});
    halo_.emplace(pixels_.rays(), pixels_.scene(), *pixels_.transport().surfaces, intervals_,
                  groups * bands_, options_.cells, radiance, positions);
    const std::size_t values = groups * bands_;
    std::vector<float> halo;
    for (std::size_t n = 0; n < raw.size(); ++n) {
        RadianceNode& node = raw[n];
        if (node.weights.empty()) continue;  // no ray, or outside the window
        const std::span<const float> of_node = halo_->of_node(n);
        halo.assign(of_node.begin(), of_node.end());
        if (halo_->is_of_mean_water()) distribute_halo(node, halo);
        for (std::size_t i = 0; i < halo_->interval_count(); ++i) {
            if (intervals_.begin(i) >= node.max_distance) break;
            for (NodeRadiance& half : node.halves) {
                float mean = 0;
                for (std::size_t k = 0; k < values; ++k) {
                    half.water[i * values + k] -= halo[i * values + k];
                    mean += halo[i * values + k];
                }
                half.water_mean[i] -= mean / static_cast<float>(bands_);
            }
        }
    }
}

// Returns the fraction of the halo, which is that of mean water, that a ray has whose water
// scatters `scattered` of uniform light up to `distance`.
double MultipleScattering::halo_fraction(double scattered, double distance,
                                         std::size_t band) const {
    if (!halo_->is_of_mean_water()) return 1;
    const double mean = halo_->scattered_by_mean_water(distance, band);
    return mean > 0 ? std::min(1.0, scattered / mean) : 1;
}

// Scales the halo, which is that of mean water, to that of the node's ray, and distributes it over
// the intervals in proportion to the scattering there: an interval without scattering has no light
// to subtract it from.
void MultipleScattering::distribute_halo(const RadianceNode& node, std::span<float> halo) const {
    const std::size_t values = estimator_.groups() * bands_;
    for (std::size_t k = 0; k < values; ++k) {
        const std::size_t band = k % bands_;
        double all = 0, scattered = 0;
        const auto for_each = [&](const auto& visit) {
            for (std::size_t i = 0; i < halo_->interval_count(); ++i)
                if (intervals_.begin(i) < node.max_distance)
                    visit(halo[i * values + k],
                          static_cast<double>(node.weights[i * bands_ + band]));
        };
        for_each([&](float& light, double weight) {
            all += static_cast<double>(light);
            scattered += weight;
        });
        if (scattered > 0) all *= halo_fraction(scattered, node.max_distance, band) / scattered;
        for_each([&](float& light, double weight) { light = static_cast<float>(all * weight); });
    }
}

void MultipleScattering::find_corners(double x, double y, std::vector<Corner>& corners) const {
    corners.clear();
    const double u = x / spacing_, v = y / spacing_;
    const int i = std::clamp(static_cast<int>(u), 0, nodes_.width() - 2);
    const int j = std::clamp(static_cast<int>(v), 0, nodes_.height() - 2);
    for (const int below : {0, 1})
        for (const int right : {0, 1})
            corners.push_back({&nodes_(i + right, j + below),
                               lerp_weight(u - i, right) * lerp_weight(v - j, below)});
}

void MultipleScattering::add_to_lamp(std::size_t group, std::size_t band, double radiance,
                                     PixelResult& result) const {
    if (group < result.lamps.size()) result.lamps[group][band] += radiance;
}

void MultipleScattering::add_water(const PixelView& view, std::span<double> light,
                                   Errors& errors) const {
    std::vector<Corner> corners;
    std::vector<float> weights;
    std::vector<double> halo;
    Spectrum scattered{};  // of uniform light, by the water up to each distance
    weight_lattice_.find(view.x, view.y, weights);
    find_corners(view.x, view.y, corners);
    const std::size_t intervals = intervals_.count();
    const std::size_t groups = estimator_.groups();
    for (std::size_t d = 0; d < view.distances.size(); ++d) {
        Spectrum up_to_distance{};
        for (std::size_t interval = 0; interval < intervals; ++interval) {
            const double begin = intervals_.begin(interval);
            if (begin >= view.distances[d]) break;
            double total = 0;
            for (const Corner& corner : corners)
                if (corner.node->known_to > begin) total += corner.weight;
            if (!(total > 0)) break;
            for (std::size_t b = 0; b < bands_; ++b) {
                const double weight = static_cast<double>(weights[interval * bands_ + b]) *
                                      intervals_.fraction_before(interval, b, view.distances[d]);
                const double scale = view.weights[d] * weight / total;
                up_to_distance[b] += weight;
                for (std::size_t group = 0; group < groups; ++group) {
                    double sum = 0;
                    for (const Corner& corner : corners)
                        if (corner.node->known_to > begin)
                            sum +=
                                corner.weight *
                                corner.node->light.water[(interval * groups + group) * bands_ + b];
                    light[group * bands_ + b] += scale * sum;
                }
            }
        }
        halo.assign(light.size(), 0.0);
        halo_->add(view.x, view.y, view.distances[d], view.weights[d], halo);
        for (std::size_t k = 0; k < light.size(); ++k)
            light[k] +=
                halo[k] * halo_fraction(up_to_distance[k % bands_], view.distances[d], k % bands_);
        for (std::size_t b = 0; b < bands_; ++b)
            scattered[b] += view.weights[d] * up_to_distance[b];
    }
    // Neighbouring nodes were smoothed together, so their errors are correlated and add up
    // linearly.
    for (std::size_t b = 0; b < bands_; ++b) {
        for (const Corner& corner : corners) {
            errors.water[b] +=
                corner.weight * scattered[b] * static_cast<double>(corner.node->water_error[b]);
            errors.surfaces[b] += corner.weight * static_cast<double>(corner.node->halo_error[b]);
        }
    }
}

// The nodes store light minus halo, a noisy difference, so that the sum may come out negative:
// clamp it.
void MultipleScattering::add_volume(const PixelView& view, PixelResult& result,
                                    Errors& errors) const {
    const std::size_t groups = estimator_.groups();
    std::vector<double> light(groups * bands_, 0.0);
    add_water(view, light, errors);
    for (std::size_t group = 0; group < groups; ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            const double radiance = std::max(0.0, light[group * bands_ + b]);
            result.multiple_volume[b] += radiance;
            add_to_lamp(group, b, radiance, result);
        }
    }
}

// Finds the corners that see the surface or, if none does, nodes around them, weighted by 1 /
// distance^4. If no node has a similar normal, larger differences are accepted: on rough ground the
// nodes do not cover all normals.
void MultipleScattering::find_matches(double x, double y, const SurfaceHit& hit,
                                      std::vector<Corner>& matches) const {
    for (const double min_cosine : {k_min_node_cosine, k_min_cosine_of_match}) {
        find_matches(x, y, hit, min_cosine, matches);
        if (!matches.empty()) return;
    }
}

void MultipleScattering::find_matches(double x, double y, const SurfaceHit& hit, double min_cosine,
                                      std::vector<Corner>& matches) const {
    const auto sees = [&](const SmoothNode& node) {
        if (!node.surface || node.surface->object_id != hit.object_id) return false;
        const NodeSurface& surface = *node.surface;
        if (glm::dot(surface.normal, hit.normal) < min_cosine) return false;
        const Vector3 between = hit.position - surface.position;
        return std::abs(glm::dot(between, surface.normal)) <= k_max_slope * glm::length(between);
    };
    find_corners(x, y, matches);
    std::erase_if(matches,
                  [&](const Corner& corner) { return corner.weight <= 0 || !sees(*corner.node); });
    if (!matches.empty()) return;
    const double u = x / spacing_, v = y / spacing_;
    for (int radius = 1; radius <= k_search_radius && matches.empty(); ++radius) {
        for (int j = std::max(0, static_cast<int>(v) - radius);
             j <= std::min(nodes_.height() - 1, static_cast<int>(v) + 1 + radius); ++j) {
            for (int i = std::max(0, static_cast<int>(u) - radius);
                 i <= std::min(nodes_.width() - 1, static_cast<int>(u) + 1 + radius); ++i) {
                if (!sees(nodes_(i, j))) continue;
                const double square = (i - u) * (i - u) + (j - v) * (j - v);
                matches.push_back({&nodes_(i, j), 1 / (square * square + 1e-6)});
            }
        }
    }
}

// The surface is too small or too rough for the lattice in the image. Places near by in the world
// serve as well, with the errors of the nodes around; if there are none of either, paths are traced
// for this sample.
void MultipleScattering::estimate_unmatched(const SurfaceSample& sample, SmoothNode& node) const {
    const SurfaceHit& hit = sample.hit;
    std::vector<float>& errors = node.surface_errors.diffuse;
    std::vector<Corner> corners;
    find_corners(sample.x, sample.y, corners);
    for (const Corner& corner : corners) {
        const std::vector<float>& of_corner = corner.node->surface_errors.diffuse;
        if (corner.node->surface && errors.empty()) errors.assign(bands_, 0.0F);
        for (std::size_t b = 0; corner.node->surface && b < of_corner.size(); ++b)
            errors[b] = std::max(errors[b], of_corner[b]);
    }
    const bool is_glossy = hit.has_material && pixels_.scene().surfaces->material(hit).is_glossy;
    if (is_glossy || errors.empty() ||
        !indirect_->covers(hit, k_max_distance_in_cache * hit.distance)) {
        estimator_.estimate_surface(sample, k_paths_of_sample, node.light, node.surface_errors);
        return;
    }
    std::vector<double> diffuse(indirect_->values());
    indirect_->find(hit, diffuse);
    node.light.diffuse.assign(diffuse.begin(), diffuse.end());
}

void MultipleScattering::add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                                     PixelResult& result, Errors& errors) const {
    std::vector<Corner> matches;
    SmoothNode own;
    find_matches(sample.x, sample.y, sample.hit, matches);
    if (matches.empty()) {
        estimate_unmatched(sample, own);
        matches.push_back({&own, 1});
    }
    double total = 0;
    for (const Corner& match : matches) total += match.weight;
    const SurfaceReflection reflection(*pixels_.scene().surfaces, sample, static_cast<int>(bands_));
    std::vector<double> mirrored, squares;
    const int mirrored_paths = std::max(1, k_mirrored_paths / pixels_.samples());
    if (reflection.is_glossy())
        estimator_.estimate_mirrored(sample, mirrored_paths, mirrored, squares);
    const double weight = 1.0 / pixels_.samples();
    for (std::size_t b = 0; b < bands_; ++b) {
        double error_of_matches = 0;
        for (const Corner& match : matches) {
            const SurfaceErrors& of_node = match.node->surface_errors;
            error_of_matches +=
                match.weight * sample.hit.reflectance[b] * static_cast<double>(of_node.diffuse[b]);
            if (b < of_node.glossy.size())
                error_of_matches += match.weight * static_cast<double>(of_node.glossy[b]);
        }
        errors.surfaces[b] += weight * to_camera[b] * error_of_matches / total;
        if (!reflection.is_glossy()) continue;
        const double of_path = weight * to_camera[b] / mirrored_paths;
        errors.mirrored_squares[b] += of_path * of_path * squares[b];
        for (std::size_t k = b; k < mirrored.size(); k += bands_)
            errors.mirrored[b] += weight * to_camera[b] * mirrored[k];
    }
    if (reflection.is_glossy()) errors.mirrored_paths += mirrored_paths;
    for (std::size_t group = 0; group < estimator_.groups(); ++group) {
        for (std::size_t b = 0; b < bands_; ++b) {
            double diffuse = 0, glossy = 0;
            for (const Corner& match : matches) {
                diffuse += match.weight * match.node->light.diffuse[group * bands_ + b];
                if (!match.node->light.glossy.empty())
                    glossy += match.weight * match.node->light.glossy[group * bands_ + b];
            }
            double reflected = sample.hit.reflectance[b] * diffuse / total;
            if (reflection.is_glossy()) reflected += glossy / total + mirrored[group * bands_ + b];
            // The light of nodes comes from a fit, which may be negative in dark places.
            const double radiance = weight * to_camera[b] * std::max(0.0, reflected);
            result.multiple_surface[b] += radiance;
            add_to_lamp(group, b, radiance, result);
        }
    }
}

void MultipleScattering::add(const PixelView& view, const SurfaceLight& light,
                             std::size_t first_sample, PixelResult& result) const {
    if (!view.ray) return;
    Errors errors;
    add_volume(view, result, errors);
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        if (!is_specular(view.samples[i].hit))
            add_surface(view.samples[i], light.to_camera(first_sample + i), result, errors);
    for (std::size_t b = 0; b < bands_; ++b)
        result.error[b] = result.pixel_factor * errors.of_band(b);
}

Spectrum MultipleScattering::light_of_water(const PixelView& view, double distance) const {
    PixelView up_to;
    up_to.x = view.x;
    up_to.y = view.y;
    up_to.distances = {distance};
    up_to.weights = {1};
    std::vector<double> light(estimator_.groups() * bands_, 0.0);
    Errors errors;
    add_water(up_to, light, errors);
    Spectrum sum;
    for (std::size_t k = 0; k < light.size(); ++k) sum[k % bands_] += light[k];
    return sum;
}

namespace {

// These give a standard error of less than 1 % where light crosses an optical depth of about one,
// and of 5 % for drafts. Small images need fewer nodes.
MultipleLightOptions options_of(RenderDesc::Quality quality, double pixels) {
    constexpr double k_pixels_of_node = 4, k_paths_of_node = 120;
    MultipleLightOptions options;
    options.nodes = static_cast<int>(std::clamp(pixels / k_pixels_of_node, 1000.0, 5000.0));
    options.cells = 1'000'000;
    options.paths = static_cast<int>(k_paths_of_node * options.nodes);
    options.error = 0.012;
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

// Whether there is any light to be scattered.
bool has_light(const PixelRenderer& pixels) {
    return !pixels.scene().emitters->empty() || pixels.scene().surfaces->may_emit();
}

}  // namespace

MultipleScatteringPass::MultipleScatteringPass(double path_factor)
    : Pass(Stage::multiple_scattering), path_factor_(path_factor) {}
MultipleScatteringPass::~MultipleScatteringPass() = default;

PassNeeds MultipleScatteringPass::needs(const LayerPlan& /*plan*/) const {
    return {.paths = true};
}

void MultipleScatteringPass::provide(LayerSupply& supply) const {
    supply.layers |=
        {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface, Layer::error};
}

void MultipleScatteringPass::begin(Rendering& rendering) {
    light_.reset();
    sums_.reset();
    if (!rendering.pixels.transport().paths || !has_light(rendering.pixels)) return;
    rendering.steps.emplace_back([this](const RenderedPixel& pixel) {
        light_->add(pixel.view, pixel.light, pixel.first_sample, pixel.result);
        sums_->add(pixel);
    });
    rendering.multiple_up_to = [this](const PixelView& view, double distance) {
        return light_->light_of_water(view, distance);
    };
}

void MultipleScatteringPass::run(Rendering& rendering) {
    if (!rendering.pixels.transport().paths || !has_light(rendering.pixels)) return;
    const RaySource& rays = rendering.pixels.rays();
    MultipleLightOptions options = options_of(rendering.desc.render.quality,
                                              static_cast<double>(rays.width()) * rays.height());
    options.paths = static_cast<int>(options.paths * path_factor_);
    options.error /= std::sqrt(path_factor_);
    options.lamps = rendering.plan.has_lamps();
    light_ = std::make_unique<MultipleScattering>(rendering.pixels, options);
    light_->prepare(rendering.film.window(), rendering.progress_of(*stage()));
    sums_ = std::make_unique<ErrorSums>(rendering.film.window(), rays.height(),
                                        static_cast<std::size_t>(rendering.pixels.band_count()));
}

void MultipleScatteringPass::end(Rendering& rendering) {
    if (sums_) sums_->report(rendering.reached);
}

}  // namespace uw
