#pragma once

#include <variant>

#include "camera/lens/distortion.h"
#include "camera/lens/fisheye.h"

namespace uw {

/// How a lens maps directions to the image. All have `direction`, `image` and `falloff`.
using LensModel = std::variant<Distortion, Fisheye>;

inline LensModel make_lens_model(const DistortionDesc& desc) {
    if (desc.model == DistortionDesc::Model::fisheye) return Fisheye(desc);
    return Distortion(desc);
}

}  // namespace uw
