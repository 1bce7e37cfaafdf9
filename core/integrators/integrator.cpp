#include "core/integrators/integrator.h"

namespace uw {

void Integrator::in_scatter_from(const Ray& ray, double begin, std::span<const double> ends,
                                 InScatter& result) const {
    std::vector<double> all{begin};
    all.insert(all.end(), ends.begin(), ends.end());
    InScatter whole;
    in_scatter(ray, all, whole);
    result.reset(ends.size(), whole.lamp_count());
    for (std::size_t end = 0; end < ends.size(); ++end)
        for (std::size_t j = 0; j < whole.lamp_count(); ++j)
            for (std::size_t b = 0; b < k_max_bands; ++b)
                result.at(end, j)[b] = whole.at(end + 1, j)[b] - whole.at(0, j)[b];
}

}  // namespace uw
