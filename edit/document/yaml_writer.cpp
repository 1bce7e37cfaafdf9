#include "edit/document/yaml_writer.h"

#include <algorithm>

namespace uw {
namespace {

/// In the order of `like` as far as it has them, then by rank.
std::vector<const ConfigNode::Entry*> in_order(const ConfigNode& map, const ConfigNode* like) {
    const auto place = [like](const ConfigNode::Entry* entry) {
        const std::size_t rank = key_rank(entry->key);
        if (like == nullptr) return rank;
        // Next to the nearest key of lower rank that is there.
        std::size_t best = 0;
        for (std::size_t i = 0; i < like->entries.size(); ++i) {
            if (like->entries[i].key == entry->key) return 2 * i + 1;
            if (key_rank(like->entries[i].key) <= rank) best = 2 * i + 2;
        }
        return best;
    };
    std::vector<const ConfigNode::Entry*> entries;
    entries.reserve(map.entries.size());
    for (const ConfigNode::Entry& entry : map.entries) entries.push_back(&entry);
    std::ranges::stable_sort(entries, {}, [](const auto* entry) { return key_rank(entry->key); });
    std::ranges::stable_sort(entries, {}, place);
    return entries;
}

}  // namespace

std::string flow_text(const ConfigNode& value, const WriteStyle& style) {
    FlowStyle flow{.is_json = style.is_json};
    if (style.aliases != nullptr)
        flow.alias_text = [&layout = *style.aliases](const ConfigNode& alias) {
            const TextSpan span = layout.item(alias);
            return std::string(layout.text().substr(span.begin, span.size()));
        };
    return flow_text(value, flow);
}

std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style) {
    std::string text;
    const std::string new_line = std::string(line_break) + std::string(column, ' ');
    const ConfigNode* const model =
        like != nullptr && like->kind == ConfigNode::Kind::map ? like : nullptr;
    for (const ConfigNode::Entry* entry : in_order(map, model)) {
        if (!text.empty()) text += new_line;
        text += quoted_if_needed(entry->key, style.is_json) + ":";
        const ConfigNode& value = entry->value;
        const ConfigNode* const same = model != nullptr ? model->find(entry->key) : nullptr;
        const bool is_alias = value.alias.line > 0 && style.aliases != nullptr;
        const bool is_block = same != nullptr && same->alias.line == 0 && !is_alias &&
                              same->kind == ConfigNode::Kind::map && !same->entries.empty() &&
                              value.kind == ConfigNode::Kind::map && !value.entries.empty() &&
                              !source.is_flow(source.item(*same));
        if (!is_block) {
            text += " " + flow_text(value, style);
            continue;
        }
        const std::size_t own = source.column(source.offset(model->entries.front().position));
        const std::size_t theirs = source.column(source.offset(same->entries.front().position));
        const std::size_t inner = column + (theirs > own ? theirs - own : 2);
        text += std::string(line_break) + std::string(inner, ' ') +
                block_text(value, same, source, inner, line_break, style);
    }
    return text;
}

}  // namespace uw
