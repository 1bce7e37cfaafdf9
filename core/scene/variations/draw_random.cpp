#include "core/scene/variations/draw_random.h"

#include "core/base/bit_mixing.h"

namespace uw {

double draw_random(std::uint64_t seed, std::string_view key, std::size_t component, int variation) {
    std::uint64_t state = mixed_bits(seed);
    for (const char c : key) state = mixed_bits(state ^ static_cast<unsigned char>(c));
    state = mixed_bits(mixed_bits(state ^ component) ^ static_cast<std::uint64_t>(variation));
    return (static_cast<double>(state >> 12U) + 0.5) * 0x1p-52;
}

}  // namespace uw
