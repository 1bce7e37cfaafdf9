#pragma once

#include <vector>

#include "core/scene/scene_desc.h"
#include "core/surfaces/surfaces.h"
#include "dataset/definition.h"
#include "dataset/view_images.h"

namespace uw {

/// How many surface points a draw has at most.
inline constexpr std::size_t k_most_points = 4096;

/// Points on the surfaces that never move, evenly over the images of up to 64 views of a draw, as
/// they are seen past the surfaces of its first frame. `scene`: the draw's, as it was read;
/// `surfaces`: of its first frame.
std::vector<SurfacePoint> point_seeds(const DatasetDefinition& definition, std::size_t draw,
                                      const SceneDesc& scene, const Surfaces& surfaces);

/// The image of a view in the scene of its draw.
ImageChoice choice_of(const DatasetDefinition& definition, const SceneDesc& scene,
                      const View& view);

}  // namespace uw
