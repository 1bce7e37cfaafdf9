#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/yaml_document.h"

namespace uw {

/// Every number from `low` to `high` is as likely.
struct UniformDistribution {
    double low = 0, high = 1;
};

/// The logarithm is uniform: every ratio between 0 < `low` and `high` is as likely.
struct LogUniformDistribution {
    double low = 1, high = 10;
};

/// Normal, of which only what lies within [low, high] is drawn.
struct NormalDistribution {
    double mean = 0, deviation = 1;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Every whole number from `low` to `high`, both included, is as likely.
struct IntegerDistribution {
    int low = 0, high = 1;
};

/// How a number is distributed.
using NumberDistribution = std::variant<UniformDistribution, LogUniformDistribution,
                                        NormalDistribution, IntegerDistribution>;

/// The number below which the part `u`, in (0, 1), of the distribution lies: of a `u` that is
/// uniform the result is distributed so. Normal numbers are exact to 1e-12 standard deviations.
double quantile(const NumberDistribution& distribution, double u);

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

/// The section `variations` of a scene's tree; none if it has none. `file` is the scene's, to whose
/// folder the names of tables are relative. Whether the scene has the keys that are drawn shows
/// when they are set. Throws InputError "file:line:column: key path: what; mend", and as
/// read_csv_file.
std::optional<VariationsDesc> read_variations(const ConfigNode& scene,
                                              const std::filesystem::path& file);
}  // namespace uw
