#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/source_location.h"
#include "core/scene/variations/distribution.h"

namespace uw {

/// Some of which one is drawn. Their shares of all draws, added up: ascending, the last is 1.
struct Shares {
    std::vector<double> up_to;
};

/// Values, as YAML on one line, of which one is drawn.
struct ChoiceOfTexts {
    std::vector<std::string> texts;
    Shares shares;  // one per text
};

/// What one value, or one entry of a list, is drawn from. A text is a value that is always the
/// same.
using DrawnFrom = std::variant<std::string, NumberDistribution, ChoiceOfTexts>;

/// A key of the scene that is drawn by itself.
struct DrawnKey {
    std::string key;                    // a path as of --set
    SourceLocation where;               // of the key
    std::vector<DrawnFrom> components;  // one, or those of a list
    bool is_list = false;
    std::string text;  // as it is written in the scene, on one line
};

/// Keys that are drawn together: one row gives each of them its value.
struct DrawnRows {
    struct Row {
        SourceLocation where;
        std::vector<std::string> texts;  // YAML on one line, one per key
    };
    std::vector<std::string> keys;
    std::vector<Row> rows;
    Shares shares;  // one per row
};

/// The section `variations` of a scene (docs/scene-file.md): what its variations draw.
struct VariationsDesc {
    std::uint64_t seed = 0;
    std::vector<DrawnKey> keys;
    std::vector<DrawnRows> together;
};

}  // namespace uw
