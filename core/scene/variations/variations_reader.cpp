#include "core/scene/variations/variations_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/text/flow_text.h"
#include "core/scene/variations/distribution_reader.h"
#include "core/scene/variations/draw.h"
#include "core/scene/variations/key_overlap.h"
#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/scene_override.h"
#include "core/scene/yaml/scene_reader.h"
#include "core/tables/csv_file.h"

namespace uw {
namespace {

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
    for (const ConfigValue& one : value.list(k_distribution_mend)) {
        is_drawn = is_drawn || is_distribution(one.node());
        key.components.push_back(is_distribution(one.node()) ? read_distribution(one)
                                                             : DrawnFrom(flow_text(one.node())));
    }
    if (!is_drawn) value.fail("nothing in this list is drawn; give {choice: [...]} of values");
    return key;
}

/// Rows written in the scene: maps with the same keys.
DrawnRows read_rows(const ConfigValue& value, const std::optional<ConfigValue>& weights) {
    constexpr auto k_rows_mend = "give maps of the same keys, such as {lamps.left.power: 20}";
    DrawnRows together;
    for (const ConfigValue& row : value.list(k_rows_mend)) {
        if (row.node().kind != ConfigNode::Kind::map)
            row.fail(
                fmt::format("expected a map, found {}; {}", row.node().description(), k_rows_mend));
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
    if (together.keys.empty()) value.fail(fmt::format("holds nothing to draw; {}", k_rows_mend));
    together.shares = read_shares(together.rows.size(), weights, value);
    return together;
}

/// Rows of a CSV whose columns are named by the keys, but for `weight`.
DrawnRows read_table(const ConfigValue& value, const std::filesystem::path& folder) {
    constexpr std::string_view k_weight = "weight";
    const CsvTable table = read_csv_file(folder / value.text("name a CSV file"), value.location());
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
    together.shares = shares_of(together.rows.size(), std::move(weights), value);
    return together;
}

DrawnRows read_together(const ConfigValue& value, const std::filesystem::path& folder) {
    constexpr auto k_together_mend = "give {rows: [{key: value, ...}, ...]} or {table: FILE.csv}";
    ConfigMap map(value, {"rows", "weights", "table"}, k_together_mend);
    const std::optional<ConfigValue> table = map.find("table");
    DrawnRows together = table
                             ? read_table(*table, folder)
                             : read_rows(map.require("rows", k_together_mend), map.find("weights"));
    map.finish("'table'");
    return together;
}

}  // namespace

std::optional<VariationsDesc> read_variations(const ConfigNode& scene,
                                              const std::filesystem::path& file) {
    const ConfigNode* const section = scene.find(k_variations_key);
    if (section == nullptr) return std::nullopt;
    const ConfigValue value(*section, std::string(k_variations_key));
    constexpr auto k_section_mend = "give keys: {lamps[0].power: {uniform: [10, 30]}}";
    ConfigMap map(value, {"seed", "keys", "together"}, k_section_mend);
    VariationsDesc variations;
    if (const auto seed = map.find("seed"))
        variations.seed = static_cast<std::uint64_t>(
            seed->integer(0, std::numeric_limits<int>::max(), "give a whole number"));
    if (const auto keys = map.find("keys")) {
        if (keys->node().kind != ConfigNode::Kind::map)
            keys->fail(fmt::format("expected a map, found {}; {}", keys->node().description(),
                                   k_section_mend));
        for (const ConfigNode::Entry& entry : keys->node().entries)
            variations.keys.push_back(read_key(entry));
    }
    if (const auto together = map.find("together"))
        for (const ConfigValue& group : together->list("give a list of tables"))
            variations.together.push_back(read_together(group, file.parent_path()));
    if (variations.keys.empty() && variations.together.empty())
        value.fail(fmt::format("draws nothing; {}", k_section_mend));
    if (const auto pair = overlap(scene, drawn_keys(variations)))
        value.fail(
            fmt::format("draws both '{}' and '{}', of which one is part of the other; draw "
                        "one of them",
                        printable(pair->first), printable(pair->second)));
    return variations;
}

}  // namespace uw
