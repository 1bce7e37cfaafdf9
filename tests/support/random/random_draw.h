#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>

namespace uw::test {

/// Draws numbers, and their texts in a scene file, from a seed: the same on every machine, as the
/// library's distributions are not.
class RandomDraw {
  public:
    explicit RandomDraw(std::uint64_t seed) : bits_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11U) * 0x1p-53);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    bool chance(double share) { return uniform(0, 1) < share; }
    int whole(int low, int high) { return static_cast<int>(uniform(low, high + 1)); }
    std::string one_of(std::initializer_list<const char*> choices) {
        return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
    }
    /// Three numbers from -size to size.
    std::string vector(double size);
    /// A direction whose z is positive, at any angle to it.
    std::string normal();
    /// A list of one number per band, or a single one.
    std::string per_band(int bands, double low, double high);
    /// A trajectory of two or three poses around the frame's moment, in a scene of `size` metres;
    /// with `looks`, each looks somewhere, as cameras' do.
    std::string trajectory(double size, bool looks);

  private:
    std::mt19937_64 bits_;
};

/// What different sections of a random scene have to agree on.
struct SceneKinds {
    explicit SceneKinds(RandomDraw& draw);

    int bands;
    double size;             // of the scene [m]
    std::string integrator;  // as the scene file names it
    bool is_fisheye, has_volume, has_surface, is_multiple;
    bool has_forward_scatter, has_snow, has_lens, has_sensor, is_in_focus, moves;
    int width, height;  // [pixels]
};

/// The section `camera` of a scene.
std::string random_camera(RandomDraw& draw, const SceneKinds& kinds);

}  // namespace uw::test
