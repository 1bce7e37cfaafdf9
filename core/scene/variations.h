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

/// Uniform from `low` to `high`.
struct UniformDistribution {
    double low = 0, high = 1;
};

/// Log-uniform between 0 < `low` and `high`: the logarithm is uniform.
struct LogUniformDistribution {
    double low = 1, high = 10;
};

/// Normal, truncated to [low, high].
struct NormalDistribution {
    double mean = 0, deviation = 1;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// Uniform over the whole numbers from `low` to `high`, both included.
struct IntegerDistribution {
    int low = 0, high = 1;
};

/// How a number is distributed.
using NumberDistribution = std::variant<UniformDistribution, LogUniformDistribution,
                                        NormalDistribution, IntegerDistribution>;

/// The quantile of a distribution at `u`, in (0, 1), by which a uniform `u` is transformed to that
/// distribution. Normal numbers are exact to 1e-12 standard deviations.
double quantile(const NumberDistribution& distribution, double u);

/// The cumulative probabilities of things of which one is drawn: ascending, the last is 1.
struct CumulativeProbabilities {
    std::vector<double> up_to;
};

/// Values, as YAML on one line, of which one is drawn.
struct ChoiceOfTexts {
    std::vector<std::string> texts;
    CumulativeProbabilities probabilities;  // one per text
};

/// The distribution of one value, or of one entry of a list. A text is a constant value.
using DrawnFrom = std::variant<std::string, NumberDistribution, ChoiceOfTexts>;

/// A key of the scene that is drawn independently.
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
    CumulativeProbabilities probabilities;  // one per row
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
/// folder the names of tables are relative. The keys that are drawn are checked when they are set.
/// Throws InputError "file:line:column: key path: what; hint", and as read_csv_file.
std::optional<VariationsDesc> read_variations(const ConfigNode& scene,
                                              const std::filesystem::path& file);
}  // namespace uw
