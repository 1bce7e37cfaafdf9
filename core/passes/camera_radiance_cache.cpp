#include "core/passes/camera_radiance_cache.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/geometry/surface_reflection.h"
#include "core/paths/node_lattice.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

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

// Returns the smallest spacing that gives no more than `nodes`, not counting those at the edges.
int spacing_for(const RaySource& rays, int nodes) {
    const double area = static_cast<double>(rays.width()) * rays.height();
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(area / nodes))));
}

}  // namespace

CameraRadianceCache::CameraRadianceCache(const PixelRenderer& pixels,
                                         const RadianceCacheOptions& options,
                                         const PixelWindow& window,
                                         const ProgressCallback& progress)
    : bands_(static_cast<std::size_t>(pixels.band_count())),
      groups_(options.lamps ? static_cast<std::size_t>(pixels.lamp_count()) + 1 : 1),
      cells_(options.cells),
      spacing_(spacing_for(pixels.rays(), options.nodes)),
      intervals_(pixels.rays(), pixels.scene()) {
    const IntervalWeights weights(pixels.scene(), intervals_);
    const RadianceEstimator estimator(pixels.rays(), pixels.scene(), pixels.transport(), weights,
                                      groups_);
    NodeLattice lattice(estimator, NodeLattice::Positions::over(pixels.rays(), spacing_));
    // Include the corners of all cells in the window, and the nodes to which these are fitted.
    constexpr int k_margin = k_smoothing_radius + k_search_radius + 1;
    const NodeWindow nodes{std::max(0, window.x0 / spacing_ - k_margin),
                           std::max(0, window.y0 / spacing_ - k_margin),
                           std::min(lattice.all().i1, (window.x1 - 1) / spacing_ + 2 + k_margin),
                           std::min(lattice.all().j1, (window.y1 - 1) / spacing_ + 2 + k_margin)};
    require_room_for_nodes(nodes.size(), intervals_.count(), groups_, pixels.scene());
    const NodePaths paths =
        plan_paths(estimator, {static_cast<double>(options.paths),
                               static_cast<int>(lattice.all().size()), options.error});
    constexpr double k_surface_fraction = 0.4;  // of the work: the cache of light on surfaces
    indirect_.emplace(lattice.light_surfaces(
        paths, [&](double fraction) { progress(k_surface_fraction * fraction); }));
    lattice.light_water(nodes, paths, *indirect_, [&](double fraction) {
        progress(k_surface_fraction + (1 - k_surface_fraction) * fraction);
    });
    subtract_halo(pixels, lattice);
    nodes_ = lattice.smoothed(nodes, intervals_);
    lattice.find_errors(nodes, nodes_);
}

SurfaceHalo CameraRadianceCache::make_halo(const PixelRenderer& pixels,
                                           std::span<const SurfaceHalo::Position> nodes) const {
    const HaloSource source(pixels, *indirect_);
    const auto radiance = [&](const SurfaceSample& sample, const SurfaceLight& light,
                              std::size_t index, std::span<double> channels) {
        source.find_radiance(sample, light, index, channels);
    };
    return {pixels.rays(),
            pixels.scene(),
            *pixels.transport().surfaces,
            intervals_,
            groups_ * bands_,
            cells_,
            radiance,
            nodes};
}

SurfaceHalo CameraRadianceCache::halo_at(const PixelRenderer& pixels) const {
    return make_halo(pixels, {});
}

// Computes the halo and subtracts it from the light of the nodes.
void CameraRadianceCache::subtract_halo(const PixelRenderer& pixels, NodeLattice& lattice) {
    Grid2D<RadianceNode>& raw = lattice.raw();
    std::vector<SurfaceHalo::Position> positions;
    for (int j = 0; j < raw.height(); ++j)
        for (int i = 0; i < raw.width(); ++i)
            positions.push_back({lattice.place(i, j).x, lattice.place(i, j).y});
    halo_.emplace(make_halo(pixels, positions));
    const std::size_t values = groups_ * bands_;
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

// Scales the halo, which is that of mean water, to that of the node's ray, and distributes it over
// the intervals in proportion to the scattering there: an interval without scattering has no light
// to subtract it from.
void CameraRadianceCache::distribute_halo(const RadianceNode& node, std::span<float> halo) const {
    const std::size_t values = groups_ * bands_;
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
        if (scattered > 0) all *= halo_->fraction(scattered, node.max_distance, band) / scattered;
        for_each([&](float& light, double weight) { light = static_cast<float>(all * weight); });
    }
}

}  // namespace uw
