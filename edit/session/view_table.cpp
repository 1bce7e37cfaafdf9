#include "edit/session/view_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace uw {

std::string ViewTable::bytes_of(const ColourView& view) {
    constexpr std::size_t k_steps = k_side;
    std::array<float, k_steps> light{};
    for (std::size_t i = 0; i < k_steps; ++i) {
        const double octaves = static_cast<double>(i) * k_octaves / (k_steps - 1);
        light[i] = static_cast<float>(k_least * (std::exp2(octaves) - 1));
    }
    std::vector<float> values;
    values.reserve(3 * k_steps * k_steps * k_steps);
    for (const float blue : light)
        for (const float green : light)
            for (const float red : light) values.insert(values.end(), {red, green, blue});
    view.apply(values);
    std::string bytes;
    bytes.reserve(values.size());
    for (const float value : values) {
        const float byte = value > 0 ? std::min(255 * value, 255.0F) : 0.0F;  // NaN is black
        bytes += static_cast<char>(static_cast<unsigned char>(byte + 0.5F));
    }
    return bytes;
}

}  // namespace uw
