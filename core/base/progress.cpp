#include "core/base/progress.h"

#include <array>

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

}  // namespace uw
