#pragma once

#include <cstddef>
#include <vector>

#include "core/lamps/lamp.h"

namespace uw {

/// A scene's lamps as a light path sees them: each as one point, whatever its extent. The mean over
/// all views is the light of the lamps, so that a path that chooses one at random costs what it
/// does among point lamps.
struct LampView {
    std::vector<Lamp> lamps;            // one per lamp
    std::vector<std::size_t> emitters;  // which of the scene's each of them is
};

/// As many views as the lamp with most emitters has, and one without lamps. `emitters`: as
/// LitScene::emitters.
std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters);

}  // namespace uw
