#include "cli/validate/plane_sums.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "cli/validate/image_differences.h"
#include "core/integrators/planes_integrator.h"

namespace uw {

namespace {

constexpr int k_fewest_planes = 8;
// No more shadow rays than this for a sum that is refined beyond the requested number of slabs.
constexpr std::size_t k_most_shadow_rays = 20'000'000;

// The largest relative difference of the backscatter over smooth pixels and bands.
double largest_change(const MethodImage& from, const MethodImage& to,
                      const std::vector<char>& smooth, std::size_t bands) {
    double largest = 0;
    for (std::size_t band = 0; band < bands; ++band)
        largest = std::max(
            largest, largest_difference(from.backscatter, to.backscatter, smooth, band, k_dark));
    return largest;
}

MethodImage sum_over(const TrialScene& uniform, int count, const std::function<bool()>& proceed) {
    const LightTransport transport{
        std::make_unique<PlanesIntegrator>(uniform.scene().lit(),
                                           uniform.scene().camera->world_from_camera(),
                                           planes_of(uniform, count)),
        std::make_unique<DirectLighting>(uniform.scene().lit())};
    return render_method(uniform, transport, proceed);
}

}  // namespace

PlaneSums sum_planes_to_limit(const TrialScene& uniform, const std::vector<char>& smooth,
                              const PlaneSumOptions& options) {
    const std::size_t bands = uniform.scene().desc.water.bands_nm.size();
    const auto rays_of = [&](int count) {
        return static_cast<std::size_t>(count) * uniform.scene().emitters.size() * smooth.size();
    };
    std::vector<MethodImage> sums;
    const auto rough = [&] {
        return largest_change(sums.back(), sums[sums.size() - 2], smooth, bands) >
               options.tolerance;
    };
    for (int count = k_fewest_planes;
         count <= options.most_planes || (rays_of(count) <= k_most_shadow_rays && rough());
         count *= 2) {
        options.say(planes_name(count));
        sums.push_back(sum_over(uniform, count, options.proceed));
    }
    PlaneSums result{sums.back(), sums.back(), sums[sums.size() - 2], {}};
    for (std::size_t i = 0; i < result.limit.backscatter.size(); ++i)
        result.limit.backscatter[i] +=
            (result.limit.backscatter[i] - result.coarser.backscatter[i]) / 3;
    for (std::size_t n = 0; n < sums.size(); ++n) {
        PlanesStep step{k_fewest_planes << n, largest_change(sums[n], result.limit, smooth, bands),
                        0};
        if (n > 0 && step.error > 0) step.order = std::log2(result.steps.back().error / step.error);
        result.steps.push_back(step);
    }
    return result;
}

std::string planes_name(int count) {
    return "planes, " + std::to_string(count);
}

}  // namespace uw
