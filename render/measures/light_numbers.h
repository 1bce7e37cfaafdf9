#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "core/scene/scene_desc.h"
#include "render/measures/picture_numbers.h"

namespace uw {

/// How the light of some pixels, the mean of each one's bands, is spread [W m^-2 sr^-1].
struct Distribution {
    double mean = 0, percentile5 = 0, median = 0, percentile95 = 0;
};

/// The light of some pixels of an image, or of one lamp in it, by where it comes from; definitions
/// in docs/edit-numbers.md.
struct LightNumbers {
    std::size_t pixels = 0;
    Distribution direct, forward, backscatter;
    std::optional<Distribution> multiple;  // with multiple scattering
    PictureNumbers picture;
};

/// An image that has the layers to measure.
struct MeasuredImage {
    const Film& film;
    const LayerPlan& plan;
    /// What surfaces emit, to be taken away: the same scene without lamps, with the same layers.
    const Film* emitted = nullptr;
};

/// The layers that light_numbers reads, of an image of `scene`: an argument of --layers.
std::string layers_to_measure(const SceneDesc& scene);

/// Precondition: there are pixels, and all lie within the film's window, by whose rows they are
/// counted.
LightNumbers light_numbers(const MeasuredImage& image, std::span<const std::size_t> pixels);

}  // namespace uw
