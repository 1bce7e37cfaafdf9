#pragma once

#include <string>
#include <vector>

#include "core/scene/variations/variations_desc.h"

namespace uw {

/// One value of a variation, as --set takes it.
struct DrawnValue {
    std::string key;
    std::string text;      // YAML on one line; numbers are the shortest that read back the same
    SourceLocation where;  // of what it was drawn from

    /// "lamps.left.power=21.5".
    std::string override_text() const { return key + "=" + text; }
};

/// The keys that are drawn, in the order of `draw`.
std::vector<std::string> drawn_keys(const VariationsDesc& variations);

/// The values of the variation `variation`, counted from 0. Each depends on the seed, its own key
/// and the number of the variation alone (draw_random); keys drawn together on the first of them.
std::vector<DrawnValue> draw(const VariationsDesc& variations, int variation);

/// "lamps.left.power=21.5, water.preset=jerlov-II", for messages.
std::string values_text(const std::vector<DrawnValue>& values);

}  // namespace uw
