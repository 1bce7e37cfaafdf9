#pragma once

#include <cstdint>
#include <string_view>

namespace uw {

/// The random number, uniform in (0, 1), of which a value is made: that of the key `key`, of a list
/// the `component`th, in the variation `variation`. It depends on these and the seed alone, so that
/// other keys and other variations change nothing.
double draw_random(std::uint64_t seed, std::string_view key, std::size_t component, int variation);

}  // namespace uw
