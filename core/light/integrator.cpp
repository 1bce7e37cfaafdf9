#include "core/light/integrator.h"

namespace uw {

void Integrator::in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                                 InScatter& result) const {
    std::vector<double> all{begin};
    all.insert(all.end(), distances.begin(), distances.end());
    InScatter whole;
    in_scatter(ray, all, whole);
    result.reset(distances.size(), whole.lamp_count());
    for (std::size_t i = 0; i < distances.size(); ++i)
        for (std::size_t j = 0; j < whole.lamp_count(); ++j)
            result.at(i, j) = whole.at(i + 1, j) - whole.at(0, j);
}

}  // namespace uw
