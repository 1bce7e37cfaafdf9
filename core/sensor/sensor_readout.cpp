#include "core/sensor/sensor_readout.h"

#include <algorithm>
#include <cmath>

#include "core/paths/path_random.h"
#include "core/sensor/random_counts.h"

namespace uw {
namespace {

// What a random number is for.
enum Purpose : std::uint64_t { k_of_pixels = 1, k_of_images = 2 };

std::uint64_t seed_of_camera(std::uint64_t seed, std::string_view camera) {
    for (const char c : camera) seed = PathRandom::seed_of(seed, static_cast<unsigned char>(c));
    return seed;
}

PathRandom random_of(std::uint64_t seed, int x, int y, std::size_t colour) {
    const auto pixel = static_cast<std::uint64_t>(y) << 32U | static_cast<std::uint64_t>(x);
    return {PathRandom::seed_of(seed, pixel, colour), 0};
}

}  // namespace

SensorReadout::SensorReadout(const SensorDesc& desc, const ImageIdentity& image)
    : desc_(desc),
      gain_(desc.system_gain()),
      dark_electrons_(desc.dark_current * desc.exposure.value()) {
    const std::uint64_t camera = seed_of_camera(PathRandom::seed_of(desc.seed), image.camera);
    fixed_seed_ = PathRandom::seed_of(camera, k_of_pixels);
    image_seed_ = PathRandom::seed_of(camera, k_of_images, static_cast<std::uint64_t>(image.frame));
}

double SensorReadout::number(double photoelectrons, int x, int y, std::size_t colour) const {
    NormalPair fixed{0, 0};
    if (desc_.prnu > 0 || desc_.dsnu > 0) {
        PathRandom random = random_of(fixed_seed_, x, y, colour);
        fixed = standard_normals(random);
    }
    PathRandom random = random_of(image_seed_, x, y, colour);
    const double response = std::max(0.0, 1 + desc_.prnu * fixed.first);
    double electrons = response * std::max(0.0, photoelectrons) + dark_electrons_;
    if (desc_.shot_noise) electrons = poisson(electrons, random);
    if (desc_.full_well) electrons = std::min(electrons, *desc_.full_well);
    electrons += desc_.dsnu * fixed.second;
    if (desc_.read_noise > 0) electrons += desc_.read_noise * standard_normals(random).first;
    const double number = std::floor(gain_ * electrons + desc_.black_level + 0.5);
    return std::clamp(number, 0.0, desc_.white_level());
}

std::size_t colour_at(SensorMosaic mosaic, int x, int y) {
    // Of (0, 0), (1, 0), (0, 1), (1, 1).
    constexpr std::size_t r = 0, g = 1, b = 2;
    using Pattern = std::array<std::size_t, 4>;
    constexpr Pattern rggb{r, g, g, b}, bggr{b, g, g, r}, grbg{g, r, b, g}, gbrg{g, b, r, g};
    const std::size_t place = static_cast<std::size_t>(x & 1) + 2 * static_cast<std::size_t>(y & 1);
    switch (mosaic) {
        case SensorMosaic::rggb:
            return rggb[place];
        case SensorMosaic::bggr:
            return bggr[place];
        case SensorMosaic::grbg:
            return grbg[place];
        case SensorMosaic::gbrg:
            return gbrg[place];
        case SensorMosaic::mono:
        case SensorMosaic::three:
            break;
    }
    return 0;
}

}  // namespace uw
