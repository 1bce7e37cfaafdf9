#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/measures/light_numbers.h"
#include "render/renderer.h"

namespace uw {

/// Some pixels of an image, by their index within its window.
struct PicturePart {
    std::string name;
    std::vector<std::size_t> pixels;
};

/// The numbers of one part of an image, of all its light or of one lamp's.
struct PartNumbers {
    std::string part;
    std::string lamp;  // empty: all light
    LightNumbers numbers;
};

/// Those of all light in an image that has the layers to measure.
std::vector<PartNumbers> part_numbers(const MeasuredImage& image,
                                      const std::vector<PicturePart>& parts,
                                      const std::string& lamp = {});

/// Those of each lamp: `scene`, whose image the parts are of, is rendered again for each of its
/// lamps alone, and once without any for what surfaces emit. `options` are those of the image; the
/// layers in them do not matter. `begin` is called before each with its index, 0 to the number of
/// lamps. Throws as Renderer.
std::vector<PartNumbers> lamp_numbers(Renderer& renderer, const ResolvedScene& scene,
                                      const RenderOptions& options,
                                      const std::vector<PicturePart>& parts,
                                      const std::function<void(std::size_t image)>& begin = {});

}  // namespace uw
