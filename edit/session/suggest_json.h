#pragma once

#include "core/json/json.h"
#include "edit/measures/suggest.h"
#include "render/resolved_scene.h"

namespace uw {

/// What a window asks of the search for a lamp's place (docs/edit-api.md). Throws UsageError where
/// the request is not one, or names lamps that are not in `scene`.
SuggestRequest suggest_request(const Json& request, const ResolvedScene& scene);

/// What the search found: the map of the objective, the places before and best, and the lamps
/// there.
Json suggestion_json(const Suggestion& found);

/// A place that was tried: where, what it is worth, and its numbers.
Json suggest_point_json(const SuggestPoint& point);

}  // namespace uw
