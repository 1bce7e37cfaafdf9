#include "core/passes/multiple_scattering_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/geometry/surface_reflection.h"
#include "core/passes/in_scatter_lattice.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/node_lattice.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/radiance_nodes.h"
#include "core/paths/surface_halo.h"

namespace uw {

namespace {

// Pixels between rays: as many as leave rays enough to tell where particles begin, and no more
// numbers to be kept for the whole image than these.
constexpr int k_enough_spacing = 4;
constexpr double k_enough_rays = 8000;
constexpr double k_max_numbers = 1e7;
constexpr double k_middle = 0.5;  // of pixels, where their rays in the water are

}  // namespace

WeightLattice::WeightLattice(const RaySource& rays, const IntervalWeights& weights,
                             const PixelWindow& window)
    : uniform_(weights.of_uniform_water()) {
    if (!weights.vary()) return;
    const double pixels = static_cast<double>(rays.width()) * rays.height();
    const double numbers = pixels * static_cast<double>(uniform_.size());
    spacing_ = std::max(
        std::clamp(static_cast<int>(std::sqrt(pixels / k_enough_rays)), 1, k_enough_spacing),
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
            rays.refracted_ray(k_middle + (column_ + i) * static_cast<double>(spacing_),
                               k_middle + (row_ + j) * static_cast<double>(spacing_));
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
    const double u = (x - k_middle) / spacing_ - column_, v = (y - k_middle) / spacing_ - row_;
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

/// The radiance of surfaces that SurfaceHalo blurs: by direct light and emission, which are exact,
/// and by the indirect light.
class HaloSource {
  public:
    /// The references must outlive this object.
    HaloSource(const PixelRenderer& pixels, const IrradianceCache& indirect)
        : pixels_(pixels),
          indirect_(indirect),
          bands_(static_cast<std::size_t>(pixels.band_count())) {}

    /// The radiance at the camera of `sample`, number `index` of `light`, by group and band. Thread
    /// safe.
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
    if (sample.hit.is_water_surface) {  // whose light is that of lamps, too
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

/// How much is spent on the light that was scattered or reflected more than once.
struct MultipleLightOptions {
    int paths = 0;       // in the whole image, of each kind, at its nodes, at most
    double error = 0;    // standard error for which fewer will do, relative to the image's mean
    int nodes = 0;       // about as many
    int cells = 0;       // of the surfaces' halo, at most
    bool lamps = false;  // each lamp's light by itself
};

namespace {

// Nodes see the same surface as a pixel if its normal agrees with theirs (k_min_node_cosine) and
// it lies no farther from their tangent plane than this, relative to its distance.
constexpr double k_max_slope = 0.35;
constexpr double k_min_cosine_of_match = 0.7;  // of normals, where no node agrees better
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

}  // namespace

/// The light of MultipleScatteringPass in one image.
class MultipleScattering {
  public:
    /// `pixels` must outlive this object; its transport has paths.
    MultipleScattering(const PixelRenderer& pixels, const MultipleLightOptions& options);

    /// Estimates the light of the pixels of `window`. Throws Interrupted if the work is to stop,
    /// InputError if the nodes do not fit into free memory.
    void prepare(const PixelWindow& window, const ProgressCallback& progress);

    /// Adds a pixel's light to multiple_volume, multiple_surface and the lamps of `result`. The
    /// samples of `view` begin at `first_sample` of `light`. Sets the error. Thread safe.
    void add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
             PixelResult& result) const;

  private:
    struct Corner {
        const SmoothNode* node;
        double weight;
    };

    void take_away_halo(NodeLattice& lattice, const IrradianceCache& indirect);
    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_matches(double x, double y, const SurfaceHit& hit,
                      std::vector<Corner>& matches) const;
    void find_matches(double x, double y, const SurfaceHit& hit, double min_cosine,
                      std::vector<Corner>& matches) const;
    struct Errors;

    double share_of_halo(double scattered, double distance, std::size_t band) const;
    void spread_halo(const RadianceNode& node, std::span<float> halo) const;
    void add_water(const PixelView& view, std::span<double> light, Errors& errors) const;
    void add_volume(const PixelView& view, PixelResult& result, Errors& errors) const;
    void add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                     PixelResult& result, Errors& errors) const;
    void give(std::size_t group, std::size_t band, double radiance, PixelResult& result) const;

    const PixelRenderer& pixels_;
    MultipleLightOptions options_;
    std::size_t bands_;
    int spacing_ = 1;  // of the nodes [pixels]
    DistanceIntervals intervals_;
    IntervalWeights weights_;
    RadianceEstimator estimator_;
    WeightLattice weight_lattice_;  // from prepare on, as the following
    Grid2D<SmoothNode> nodes_;
    std::optional<SurfaceHalo> halo_;
};

/// Standard errors of a pixel's light, by band.
struct MultipleScattering::Errors {
    Spectrum water;     // of what nodes tell of the water
    Spectrum surfaces;  // of the indirect light on surfaces, seen directly or through scattering
    // Sums of the light that glossy surfaces mirror, and of its squares, by paths of the pixel's
    // own.
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
    // The corners of all cells in the window, and what these are fitted to.
    constexpr int k_margin = k_smoothing_radius + k_search + 1;
    const NodeWindow nodes{std::max(0, window.x0 / spacing_ - k_margin),
                           std::max(0, window.y0 / spacing_ - k_margin),
                           std::min(lattice.all().i1, (window.x1 - 1) / spacing_ + 2 + k_margin),
                           std::min(lattice.all().j1, (window.y1 - 1) / spacing_ + 2 + k_margin)};
    require_room_for_nodes(nodes.size(), intervals_.count(), estimator_.groups(), pixels_.scene());
    const NodePaths paths =
        plan_paths(estimator_, {static_cast<double>(options_.paths),
                                static_cast<int>(lattice.all().size()), options_.error});
    constexpr double k_share_of_surfaces = 0.4;  // of the time
    const IrradianceCache indirect =
        lattice.light_surfaces(paths, [&](double share) { progress(k_share_of_surfaces * share); });
    lattice.light_water(nodes, paths, indirect, [&](double share) {
        progress(k_share_of_surfaces + (1 - k_share_of_surfaces) * share);
    });
    take_away_halo(lattice, indirect);
    weight_lattice_ = WeightLattice(rays, weights_, window);
    nodes_ = lattice.smoothed(nodes, intervals_);
    lattice.find_errors(nodes, nodes_);
}

// Computes the halo, and leaves in the nodes what they hold beside it.
void MultipleScattering::take_away_halo(NodeLattice& lattice, const IrradianceCache& indirect) {
    const std::size_t groups = estimator_.groups();
    const HaloSource source(pixels_, indirect);
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
        if (halo_->is_of_mean_water()) spread_halo(node, halo);
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

// How much of the halo of water as it is in the mean belongs to a ray, whose water scatters
// `scattered` of even light up to `distance`.
double MultipleScattering::share_of_halo(double scattered, double distance,
                                         std::size_t band) const {
    if (!halo_->is_of_mean_water()) return 1;
    const double mean = halo_->scattered_by_mean_water(distance, band);
    return mean > 0 ? std::min(1.0, scattered / mean) : 1;
}

// Reduces halo, which is that of mean water, to what pixels along the node's ray have of it: none
// where that ray scatters no light, since nodes cannot hold any there.
void MultipleScattering::spread_halo(const RadianceNode& node, std::span<float> halo) const {
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
        if (scattered > 0) all *= share_of_halo(scattered, node.max_distance, band) / scattered;
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

void MultipleScattering::give(std::size_t group, std::size_t band, double radiance,
                              PixelResult& result) const {
    if (group < result.lamps.size()) result.lamps[group][band] += radiance;
}

void MultipleScattering::add_water(const PixelView& view, std::span<double> light,
                                   Errors& errors) const {
    thread_local std::vector<Corner> corners;
    thread_local std::vector<float> weights;
    thread_local std::vector<double> halo;
    Spectrum scattered{};  // of even light by the water that is known
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
                const double share = view.weights[d] * weight / total;
                up_to_distance[b] += weight;
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
        halo.assign(light.size(), 0.0);
        halo_->add(view.x, view.y, view.distances[d], view.weights[d], halo);
        for (std::size_t k = 0; k < light.size(); ++k)
            light[k] +=
                halo[k] * share_of_halo(up_to_distance[k % bands_], view.distances[d], k % bands_);
        for (std::size_t b = 0; b < bands_; ++b)
            scattered[b] += view.weights[d] * up_to_distance[b];
    }
    // Errors of neighbouring nodes, which were smoothed together, are alike.
    for (std::size_t b = 0; b < bands_; ++b) {
        for (const Corner& corner : corners) {
            errors.water[b] +=
                corner.weight * scattered[b] * static_cast<double>(corner.node->water_error[b]);
            errors.surfaces[b] += corner.weight * static_cast<double>(corner.node->halo_error[b]);
        }
    }
}

// What nodes hold beside the halo is a difference, and so noisy; light is not below zero.
void MultipleScattering::add_volume(const PixelView& view, PixelResult& result,
                                    Errors& errors) const {
    thread_local std::vector<double> light;
    const std::size_t groups = estimator_.groups();
    light.assign(groups * bands_, 0.0);
    add_water(view, light, errors);
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

void MultipleScattering::add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                                     PixelResult& result, Errors& errors) const {
    thread_local std::vector<Corner> matches;
    thread_local SmoothNode own;
    find_matches(sample.x, sample.y, sample.hit, matches);
    if (matches.empty()) {
        // Too small for the lattice.
        estimator_.estimate_surface(sample, k_paths_of_sample, own.light, own.surface_errors);
        matches.push_back({&own, 1});
    }
    double total = 0;
    for (const Corner& match : matches) total += match.weight;
    const SurfaceReflection reflection(*pixels_.scene().surfaces, sample, static_cast<int>(bands_));
    thread_local std::vector<double> mirrored, squares;
    const int mirrored_paths = std::max(1, k_mirrored_paths / pixels_.samples());
    if (reflection.is_glossy())
        estimator_.estimate_mirrored(sample, mirrored_paths, mirrored, squares);
    const double weight = 1.0 / pixels_.samples();
    for (std::size_t b = 0; b < bands_; ++b) {
        double of_matches = 0;
        for (const Corner& match : matches) {
            const SurfaceErrors& of_node = match.node->surface_errors;
            of_matches +=
                match.weight * sample.hit.reflectance[b] * static_cast<double>(of_node.diffuse[b]);
            if (b < of_node.glossy.size())
                of_matches += match.weight * static_cast<double>(of_node.glossy[b]);
        }
        errors.surfaces[b] += weight * to_camera[b] * of_matches / total;
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
            // What nodes give is smoothed by fits, which may fall below zero where it is dark.
            const double radiance = weight * to_camera[b] * std::max(0.0, reflected);
            result.multiple_surface[b] += radiance;
            give(group, b, radiance, result);
        }
    }
}

void MultipleScattering::add(const PixelView& view, const SurfaceLight& light,
                             std::size_t first_sample, PixelResult& result) const {
    if (!view.ray) return;
    Errors errors;
    add_volume(view, result, errors);
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        if (!view.samples[i].hit.is_water_surface)
            add_surface(view.samples[i], light.to_camera(first_sample + i), result, errors);
    for (std::size_t b = 0; b < bands_; ++b)
        result.error[b] = result.pixel_factor * errors.of_band(b);
}

/// Sums over the pixels of an image of all light and of the squares of its errors, by band: tile by
/// tile, each of which one thread renders, so that they are the same to the bit for any number of
/// threads. Thread safe for pixels of different tiles.
class ErrorSums {
  public:
    ErrorSums(const PixelWindow& window, std::size_t bands) : window_(window), bands_(bands) {
        tiles_.assign(1 + (window.x1 - 1) / k_tile - window.x0 / k_tile,
                      1 + (window.y1 - 1) / k_tile - window.y0 / k_tile);
        for (Tile& tile : tiles_) {
            tile.light.assign(bands, 0.0);
            tile.squares.assign(bands, 0.0);
        }
    }

    void add(const RenderedPixel& pixel) {
        Tile& tile =
            tiles_(pixel.x / k_tile - window_.x0 / k_tile, pixel.y / k_tile - window_.y0 / k_tile);
        const PixelResult& result = pixel.result;
        for (std::size_t b = 0; b < bands_; ++b) {
            tile.light[b] +=
                result.pixel_factor * (result.direct[b] + result.backscatter[b] +
                                       result.multiple_volume[b] + result.multiple_surface[b]);
            tile.squares[b] += result.error[b] * result.error[b];
        }
    }

    void tell(ImageProgress& reached) const {
        const double pixels = static_cast<double>(window_.width()) * window_.height();
        const auto relative = [](double light, double squares, double count) {
            return light > 0 ? std::sqrt(squares * count) / light : 0;
        };
        double all_light = 0, all_squares = 0;
        reached.multiple_error_of_bands.clear();
        for (std::size_t b = 0; b < bands_; ++b) {
            double light = 0, squares = 0;
            for (const Tile& tile : tiles_) {
                light += tile.light[b];
                squares += tile.squares[b];
            }
            reached.multiple_error_of_bands.push_back(relative(light, squares, pixels));
            all_light += light;
            all_squares += squares;
        }
        reached.multiple_error =
            relative(all_light, all_squares, pixels * static_cast<double>(bands_));
    }

  private:
    static constexpr int k_tile = InScatterLattice::k_tile;  // of render_tiles
    struct Tile {
        std::vector<double> light, squares;
    };

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<Tile> tiles_;
};

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

// Whether there is any light to be scattered.
bool has_light(const PixelRenderer& pixels) {
    return !pixels.scene().emitters->empty() || pixels.scene().surfaces->may_emit();
}

}  // namespace

MultipleScatteringPass::MultipleScatteringPass(double share)
    : Pass("multiple scattering"), share_(share) {}
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
}

void MultipleScatteringPass::run(Rendering& rendering) {
    if (!rendering.pixels.transport().paths || !has_light(rendering.pixels)) return;
    MultipleLightOptions options = options_of(rendering.desc.render.quality);
    options.paths = static_cast<int>(options.paths * share_);
    options.error /= std::sqrt(share_);
    options.lamps = rendering.plan.has_lamps();
    light_ = std::make_unique<MultipleScattering>(rendering.pixels, options);
    light_->prepare(rendering.film.window(), rendering.progress_of(stage()));
    sums_ = std::make_unique<ErrorSums>(rendering.film.window(),
                                        static_cast<std::size_t>(rendering.pixels.band_count()));
}

void MultipleScatteringPass::end(Rendering& rendering) {
    if (sums_) sums_->tell(rendering.reached);
}

}  // namespace uw
