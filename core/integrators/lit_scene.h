#pragma once

#include <vector>

#include "core/lamps/lamp.h"
#include "core/optics/concentration_field.h"
#include "core/optics/medium.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// Everything that integrators operate on; all of it must outlive them.
struct LitScene {
    const Medium* medium = nullptr;
    const ConcentrationField* field = nullptr;
    const Surfaces* surfaces = nullptr;
    const std::vector<Lamp>* lamps = nullptr;
};

}  // namespace uw
