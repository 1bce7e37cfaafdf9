#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"

namespace uw {

/// Light meters of a scene: at one point, or at several on a line.
struct MeterDesc {
    std::string name;            ///< unique in the scene
    std::vector<Point3> points;  ///< world [m]
    Vector3 up{0, 1, 0};         ///< world, unit: plane irradiance is on a plane across it
    SourceLocation where;
};

/// An entry of `sensors` that is a light meter, the `number`th sensor. Without `up` that is out of
/// the water, where the scene has a surface, else y.
MeterDesc read_meter(const ConfigValue& value, std::size_t number, const SceneContext& context);

}  // namespace uw
