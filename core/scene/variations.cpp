#include "core/scene/variations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/scene/config_value.h"
#include "core/scene/key_path.h"
#include "core/scene/scene_context.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

/// What messages advise where a distribution is missing.
constexpr std::string_view k_distribution_hint = "give a distribution, such as {uniform: [0, 1]}";

// The probability of a normal number beyond this is less than 1e-33.
constexpr double k_farthest = 12;

/// The probability of a standard normal number above x.
double above(double x) {
    return 0.5 * std::erfc(x / std::numbers::sqrt2);
}

/// The probability of a standard normal number within [low, high], to full relative precision
/// wherever the interval lies.
double normal_probability(double low, double high) {
    if (low + high < 0) return normal_probability(-high, -low);
    return above(low) - above(high);
}

/// The quantile `u` of the standard normal distribution cut off at [low, high].
double normal_quantile(double low, double high, double u) {
    if (low + high > 0) return -normal_quantile(-high, -low, 1 - u);  // the left tail is precise
    low = std::clamp(low, -k_farthest, k_farthest);
    high = std::clamp(high, -k_farthest, k_farthest);
    const double below = above(-low) + u * normal_probability(low, high);
    // Halving an interval of 24 this often leaves 1e-12. That is coarser than the last digits of
    // erfc, which differ between systems, so that the draws are the same everywhere.
    constexpr int k_halvings = 44;
    for (int i = 0; i < k_halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (above(-middle) < below ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double quantile_of(const UniformDistribution& d, double u) {
    return std::clamp(d.low + u * (d.high - d.low), d.low, d.high);
}

double quantile_of(const LogUniformDistribution& d, double u) {
    return std::clamp(d.low * std::exp(u * std::log(d.high / d.low)), d.low, d.high);
}

double quantile_of(const NormalDistribution& d, double u) {
    const double x =
        normal_quantile((d.low - d.mean) / d.deviation, (d.high - d.mean) / d.deviation, u);
    return std::clamp(d.mean + d.deviation * x, d.low, d.high);
}

double quantile_of(const IntegerDistribution& d, double u) {
    const double count = static_cast<double>(d.high) - d.low + 1;
    return std::min(d.low + std::floor(u * count), static_cast<double>(d.high));
}

}  // namespace

double quantile(const NumberDistribution& distribution, double u) {
    return std::visit([u](const auto& d) { return quantile_of(d, u); }, distribution);
}

namespace {

std::size_t index_of(const CumulativeProbabilities& probabilities, double u) {
    const auto found = std::ranges::upper_bound(probabilities.up_to, u);
    return static_cast<std::size_t>(found - probabilities.up_to.begin());
}

struct TextOf {
    double u;  // uniform in (0, 1)

    std::string operator()(const std::string& constant) const { return constant; }
    std::string operator()(const NumberDistribution& distribution) const {
        return number_text(quantile(distribution, u));
    }
    std::string operator()(const ChoiceOfTexts& choice) const {
        return choice.texts[index_of(choice.probabilities, u)];
    }
};

std::string text_of(const DrawnKey& key, std::uint64_t seed, int variation) {
    std::string text;
    for (std::size_t i = 0; i < key.components.size(); ++i)
        text += (i > 0 ? ", " : "") +
                std::visit(TextOf{draw_random(seed, key.key, i, variation)}, key.components[i]);
    return key.is_list ? "[" + text + "]" : text;
}

}  // namespace

std::vector<std::string> drawn_keys(const VariationsDesc& variations) {
    std::vector<std::string> keys;
    for (const DrawnKey& key : variations.keys) keys.push_back(key.key);
    for (const DrawnRows& rows : variations.together)
        keys.insert(keys.end(), rows.keys.begin(), rows.keys.end());
    return keys;
}

std::vector<DrawnValue> draw(const VariationsDesc& variations, int variation) {
    std::vector<DrawnValue> values;
    for (const DrawnKey& key : variations.keys)
        values.push_back({key.key, text_of(key, variations.seed, variation), key.where});
    for (const DrawnRows& together : variations.together) {
        const double u = draw_random(variations.seed, together.keys.front(), 0, variation);
        const DrawnRows::Row& row = together.rows[index_of(together.probabilities, u)];
        for (std::size_t i = 0; i < row.texts.size(); ++i)
            values.push_back({together.keys[i], row.texts[i], row.where});
    }
    return values;
}

std::string values_text(const std::vector<DrawnValue>& values) {
    std::string text;
    for (const DrawnValue& value : values)
        text += (text.empty() ? "" : ", ") + value.override_text();
    return text;
}

namespace {

constexpr auto k_kinds =
    std::to_array<std::string_view>({"uniform", "log-uniform", "normal", "integer", "choice"});

/// Two numbers, the first below the second.
std::array<double, 2> interval(const ConfigValue& value) {
    constexpr auto k_interval_hint = "give [lowest, highest]";
    const std::vector<ConfigValue> ends = value.list_of(2, k_interval_hint);
    const std::array<double, 2> numbers{ends[0].number(k_interval_hint),
                                        ends[1].number(k_interval_hint)};
    if (numbers[0] >= numbers[1])
        value.fail(fmt::format("{} is not below {}; {}", numbers[0], numbers[1], k_interval_hint));
    return numbers;
}

LogUniformDistribution log_uniform(const ConfigValue& value) {
    const auto [low, high] = interval(value);
    if (low <= 0) value.fail("logarithms need numbers above 0; give [lowest, highest]");
    return {low, high};
}

IntegerDistribution integer(const ConfigValue& value) {
    constexpr auto k_integer_hint = "give two whole numbers, [lowest, highest]";
    interval(value);
    const std::vector<ConfigValue> ends = value.list_of(2, k_integer_hint);
    constexpr int k_max_integer = std::numeric_limits<int>::max();
    return {ends[0].integer(-k_max_integer, k_max_integer, k_integer_hint),
            ends[1].integer(-k_max_integer, k_max_integer, k_integer_hint)};
}

NormalDistribution normal(const ConfigValue& value, const std::optional<ConfigValue>& within) {
    const std::vector<ConfigValue> numbers = value.list_of(2, "give [mean, standard deviation]");
    NormalDistribution d{numbers[0].number("give the mean"),
                         numbers[1].positive("give the standard deviation")};
    if (!within) return d;
    const std::array<double, 2> ends = interval(*within);
    d.low = ends[0];
    d.high = ends[1];
    constexpr double k_min_probability = 1e-6;  // a mistake rather than a wish
    if (normal_probability((d.low - d.mean) / d.deviation, (d.high - d.mean) / d.deviation) <
        k_min_probability)
        within->fail("less than a millionth of the distribution lies within; widen it");
    return d;
}

/// The probabilities of `count` > 0 things with these weights >= 0; equal without weights. Throws
/// InputError at `where` if no weight is above 0.
CumulativeProbabilities probabilities_of(std::size_t count, std::vector<double> weights,
                                         const ConfigValue& where) {
    if (weights.empty()) weights.assign(count, 1);
    CumulativeProbabilities probabilities;
    std::partial_sum(weights.begin(), weights.end(), std::back_inserter(probabilities.up_to));
    const double sum = probabilities.up_to.back();
    if (sum <= 0) where.fail("no weight is above 0; give one that is");
    for (double& probability : probabilities.up_to) probability /= sum;
    // Things without weight at the end must not be drawn due to rounding.
    const double last = probabilities.up_to.back();
    for (double& probability : probabilities.up_to)
        if (probability == last) probability = 1;
    return probabilities;
}

/// Reads the probabilities of `count` things from the weights that the scene gives them, or makes
/// them equal if it gives none. `of` is the list of the things, for messages.
CumulativeProbabilities read_probabilities(std::size_t count,
                                           const std::optional<ConfigValue>& weights,
                                           const ConfigValue& of) {
    if (!weights) return probabilities_of(count, {}, of);
    std::vector<double> numbers;
    for (const ConfigValue& weight : weights->list_of(count, "give a weight for each"))
        numbers.push_back(weight.non_negative("give a weight, such as 1"));
    return probabilities_of(count, std::move(numbers), *weights);
}

ChoiceOfTexts choice(const ConfigValue& value, const std::optional<ConfigValue>& weights) {
    ChoiceOfTexts result;
    for (const ConfigValue& one : value.list("give a list of values"))
        result.texts.push_back(flow_text(one.node()));
    if (result.texts.empty()) value.fail("is an empty list; give values to choose from");
    result.probabilities = read_probabilities(result.texts.size(), weights, value);
    return result;
}

/// Whether a value names a distribution, rather than being one that stays as it is.
bool is_distribution(const ConfigNode& node) {
    return std::ranges::any_of(k_kinds, [&](auto kind) { return node.find(kind) != nullptr; });
}

/// Reads a distribution (docs/scene-file.md). Throws InputError.
DrawnFrom read_distribution(const ConfigValue& value) {
    ConfigMap map(value,
                  {"uniform", "log-uniform", "normal", "integer", "choice", "within", "weights"},
                  k_distribution_hint);
    const auto is_given = [&](std::string_view kind) { return map.has(kind); };
    const auto kind = std::ranges::find_if(k_kinds, is_given);
    if (kind == k_kinds.end())
        value.fail(fmt::format("names no distribution; use one of {}", alternatives(k_kinds)));
    const ConfigValue numbers = *map.find(*kind);
    DrawnFrom result;
    if (*kind == "uniform") {
        const auto [low, high] = interval(numbers);
        result = UniformDistribution{low, high};
    } else if (*kind == "log-uniform") {
        result = log_uniform(numbers);
    } else if (*kind == "normal") {
        result = normal(numbers, map.find("within"));
    } else if (*kind == "integer") {
        result = integer(numbers);
    } else {
        result = choice(numbers, map.find("weights"));
    }
    map.finish(fmt::format("'{}'", *kind));
    return result;
}

void check_path(const std::string& key, const ConfigPosition& position) {
    if (parse_key_path(key).empty())
        throw InputError(fmt::format(
            "{}: variations: '{}' is not the path of a key; write it as for --set, such as "
            "lamps[0].power",
            position.text(), printable(key)));
}

DrawnKey read_key(const ConfigNode::Entry& entry) {
    check_path(entry.key, entry.position);
    const ConfigValue value(entry.value, "variations.keys." + printable(entry.key));
    DrawnKey key{entry.key, entry.position.text(), {}, false, flow_text(entry.value)};
    if (entry.value.kind != ConfigNode::Kind::sequence) {
        key.components.push_back(read_distribution(value));
        return key;
    }
    key.is_list = true;
    bool is_drawn = false;
    for (const ConfigValue& one : value.list(k_distribution_hint)) {
        is_drawn = is_drawn || is_distribution(one.node());
        key.components.push_back(is_distribution(one.node()) ? read_distribution(one)
                                                             : DrawnFrom(flow_text(one.node())));
    }
    if (!is_drawn) value.fail("nothing in this list is drawn; give {choice: [...]} of values");
    return key;
}

/// Rows written in the scene: maps with the same keys.
DrawnRows read_rows(const ConfigValue& value, const std::optional<ConfigValue>& weights) {
    constexpr auto k_rows_hint = "give maps of the same keys, such as {lamps.left.power: 20}";
    DrawnRows together;
    for (const ConfigValue& row : value.list(k_rows_hint)) {
        if (row.node().kind != ConfigNode::Kind::map)
            row.fail(
                fmt::format("expected a map, found {}; {}", row.node().description(), k_rows_hint));
        if (together.rows.empty())
            for (const ConfigNode::Entry& entry : row.node().entries) {
                check_path(entry.key, entry.position);
                together.keys.push_back(entry.key);
            }
        DrawnRows::Row& drawn = together.rows.emplace_back();
        drawn.where = row.node().position.text();
        for (const std::string& key : together.keys) {
            const ConfigNode* const found = row.node().find(key);
            if (found == nullptr)
                row.fail(
                    fmt::format("'{}' is missing; all rows have the same keys", printable(key)));
            drawn.texts.push_back(flow_text(*found));
        }
        if (row.node().entries.size() > together.keys.size())
            row.fail("has keys that the first row has not; all rows have the same keys");
    }
    if (together.keys.empty()) value.fail(fmt::format("holds nothing to draw; {}", k_rows_hint));
    together.probabilities = read_probabilities(together.rows.size(), weights, value);
    return together;
}

/// Rows of a CSV whose columns are named by the keys, but for `weight`.
DrawnRows read_table(const ConfigValue& value, const std::filesystem::path& folder) {
    constexpr std::string_view k_weight = "weight";
    std::vector<std::string> warnings;
    const SceneContext context{folder, 0, &warnings};
    const CsvTable table = read_csv_file(read_existing_file(value, context), value.location());
    DrawnRows together;
    together.rows.assign(table.row_count(), {value.node().position.text(), {}});
    std::vector<double> weights;
    for (const std::string& column : table.columns()) {
        if (column == k_weight) {
            weights = table.numbers(column);
            continue;
        }
        check_path(column, value.node().position);
        together.keys.push_back(column);
        const std::vector<std::string> cells = table.text(column);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (cells[i].empty())
                value.fail(fmt::format("{}: row {} has no '{}'; fill in the blank", table.name(),
                                       i + 1, printable(column)));
            together.rows[i].texts.push_back(cells[i]);
        }
    }
    if (together.keys.empty() || together.rows.empty())
        value.fail(
            fmt::format("{}: holds nothing to draw; name its columns by keys of the scene, "
                        "such as lamps.left.power",
                        table.name()));
    if (std::ranges::any_of(weights, [](double weight) { return weight < 0; }))
        value.fail(fmt::format("{}: a weight is negative; give 0 or more", table.name()));
    together.probabilities = probabilities_of(together.rows.size(), std::move(weights), value);
    return together;
}

DrawnRows read_together(const ConfigValue& value, const std::filesystem::path& folder) {
    constexpr auto k_together_hint = "give {rows: [{key: value, ...}, ...]} or {table: FILE.csv}";
    ConfigMap map(value, {"rows", "weights", "table"}, k_together_hint);
    const std::optional<ConfigValue> table = map.find("table");
    DrawnRows together = table
                             ? read_table(*table, folder)
                             : read_rows(map.require("rows", k_together_hint), map.find("weights"));
    map.finish("'table'");
    return together;
}

}  // namespace

std::optional<VariationsDesc> read_variations(const ConfigNode& scene,
                                              const std::filesystem::path& file) {
    const ConfigNode* const section = scene.find(k_variations_key);
    if (section == nullptr) return std::nullopt;
    const ConfigValue value(*section, std::string(k_variations_key));
    constexpr auto k_section_hint = "give keys: {lamps[0].power: {uniform: [10, 30]}}";
    ConfigMap map(value, {"seed", "keys", "together"}, k_section_hint);
    VariationsDesc variations;
    if (const auto seed = map.find("seed"))
        variations.seed = static_cast<std::uint64_t>(
            seed->integer(0, std::numeric_limits<int>::max(), "give a whole number"));
    if (const auto keys = map.find("keys")) {
        if (keys->node().kind != ConfigNode::Kind::map)
            keys->fail(fmt::format("expected a map, found {}; {}", keys->node().description(),
                                   k_section_hint));
        for (const ConfigNode::Entry& entry : keys->node().entries)
            variations.keys.push_back(read_key(entry));
    }
    if (const auto together = map.find("together"))
        for (const ConfigValue& group : together->list("give a list of tables"))
            variations.together.push_back(read_together(group, file.parent_path()));
    if (variations.keys.empty() && variations.together.empty())
        value.fail(fmt::format("draws nothing; {}", k_section_hint));
    if (const auto pair = overlap(scene, drawn_keys(variations)))
        value.fail(
            fmt::format("draws both '{}' and '{}', of which one is part of the other; draw "
                        "one of them",
                        printable(pair->first), printable(pair->second)));
    return variations;
}
}  // namespace uw
