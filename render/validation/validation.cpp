#include "render/validation/validation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace uw {

bool SceneValidation::passed() const {
    return std::ranges::all_of(checks, [](const Check& check) { return check.passed(); });
}

double LightCheck::deviation_in_errors() const {
    if (deviation == 0) return 0;
    return error > 0 ? std::abs(deviation) / error : std::numeric_limits<double>::infinity();
}

// Written so that NaN fails.
bool LightCheck::passed() const {
    return deviation_in_errors() <= k_max_errors && error <= max_error &&
           (!spread || spread->rms_in_errors <= k_max_noise);
}

double LightParts::all() const {
    return std::accumulate(means.begin(), means.end(), 0.0);
}

double LightParts::fraction(std::size_t part) const {
    return all() > 0 ? means[part] / all() : 0;
}

double LightParts::ratio() const {
    const double single = means[0] + means[1];
    return single > 0 ? all() / single : 0;
}

bool LightValidation::passed() const {
    return std::ranges::all_of(checks, [](const LightCheck& check) { return check.passed(); });
}

}  // namespace uw
