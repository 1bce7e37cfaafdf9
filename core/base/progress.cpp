#include "core/base/progress.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace uw {

namespace {

/// In the order of the stages.
constexpr auto k_names = std::to_array<std::string_view>(
    {"particles", "volumes", "geometry", "splat", "multiple scattering", "snow", "render",
     "forward scatter", "reflection", "derivatives"});
static_assert(k_names.size() == static_cast<std::size_t>(Stage::derivatives) + 1);

}  // namespace

std::string_view name_of(Stage stage) {
    return k_names[static_cast<std::size_t>(stage)];
}

Stage stage_named(std::string_view name) {
    const auto found = std::ranges::find(k_names, name);
    if (found == k_names.end())
        throw std::invalid_argument("no stage is named " + std::string(name));
    return static_cast<Stage>(found - k_names.begin());
}

}  // namespace uw
