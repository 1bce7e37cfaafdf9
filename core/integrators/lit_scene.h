#pragma once

#include <cstddef>
#include <vector>

#include "core/integrators/path_weight.h"
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
    /// The points that emit light, in the order of the scene's lamps: one for each lamp, several
    /// for a lamp with an extent (Lamp::index).
    const std::vector<Lamp>* emitters = nullptr;
    /// For derivatives, of integrators that have them (VolumeIntegrator).
    PathWeight path_weight{};

    /// How many lamps the scene has.
    std::size_t lamp_count() const { return emitters->empty() ? 0 : emitters->back().index() + 1; }
};

}  // namespace uw
