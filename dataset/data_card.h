#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/json.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// A number of things, in words: "1 frame", "3 frames".
std::string counted(std::size_t number, std::string_view thing);

/// What a data card says of a scene: water, lamps, cameras, what is in it and how it is rendered.
/// `first` is the resolved
/// scene of the set's first view.
Json facts_of(const SceneDesc& first);

/// The data card of a set, README.md in Markdown. `bytes` is the size of the files of
/// all views.
std::string data_card(const DatasetFile& set, std::uint64_t bytes);

}  // namespace uw
