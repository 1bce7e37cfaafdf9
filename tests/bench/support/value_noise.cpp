#include "tests/bench/support/value_noise.h"

#include <cmath>

namespace uw::bench {
namespace {

double one_octave(const Vector3& x) {
    const Vector3 f = x - glm::floor(x);
    const Vector3 t = f * f * (3.0 - 2.0 * f);
    const auto i = static_cast<std::int32_t>(std::floor(x.x));
    const auto j = static_cast<std::int32_t>(std::floor(x.y));
    const auto k = static_cast<std::int32_t>(std::floor(x.z));
    const auto edge = [&](int di, int dj) {
        return std::lerp(hashed(i + di, j + dj, k), hashed(i + di, j + dj, k + 1), t.z);
    };
    return std::lerp(std::lerp(edge(0, 0), edge(0, 1), t.y), std::lerp(edge(1, 0), edge(1, 1), t.y),
                     t.x);
}

}  // namespace

double hashed(std::int32_t i, std::int32_t j, std::int32_t k) {
    auto h = static_cast<std::uint32_t>(i) * 0x8da6b343U ^
             static_cast<std::uint32_t>(j) * 0xd8163841U ^
             static_cast<std::uint32_t>(k) * 0xcb1ab31fU;
    h = (h ^ (h >> 16)) * 0x7feb352dU;
    h = (h ^ (h >> 15)) * 0x846ca68bU;
    return static_cast<double>(h ^ (h >> 16)) / 4294967296.0;
}

double value_noise(const Vector3& x, int octaves) {
    double sum = 0, weight = 1, weights = 0, frequency = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += weight * one_octave(frequency * x);
        weights += weight;
        weight *= 0.5;
        frequency *= 2;
    }
    return sum / weights;
}

}  // namespace uw::bench
