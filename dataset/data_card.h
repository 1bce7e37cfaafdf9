#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/json.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"
#include "dataset/pinhole_fit.h"
#include "render/light_left_out.h"

namespace uw {

/// The facts about a scene for a data card: water, lamps, cameras, contents and rendering. `first`
/// is the resolved scene of the set's first view, and `left_out` what some of its views leave out
/// (estimate_light_left_out).
Json facts_of(const SceneDesc& first, std::span<const LightLeftOut> left_out);

/// One line on the light that the images leave out, for the messages of a run; empty if it is
/// little.
std::string light_note(const DatasetFile& set);

/// The data card of a set, README.md in Markdown. `fits` are those of its first draw, and `bytes`
/// is the size of the files of all views.
std::string data_card(const DatasetFile& set, const PinholeFits& fits, std::uint64_t bytes);

}  // namespace uw
