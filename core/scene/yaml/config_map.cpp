#include "core/scene/yaml/config_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

ConfigMap::ConfigMap(ConfigValue value, std::initializer_list<std::string_view> allowed,
                     std::string_view mend)
    : value_(std::move(value)), allowed_(allowed) {
    const ConfigNode& node = value_.node();
    if (node.kind == ConfigNode::Kind::null) {
        value_.fail(fmt::format("has no value; {}, or remove the key", mend));
    }
    if (node.kind != ConfigNode::Kind::map) {
        value_.fail(fmt::format("expected a map, found {}; {}", node.description(), mend));
    }
    read_.resize(node.entries.size(), false);
    for (const ConfigNode::Entry& entry : node.entries) {
        if (std::find(allowed_.begin(), allowed_.end(), entry.key) != allowed_.end()) continue;
        throw InputError(fmt::format("{}: {}: unknown key; {}", entry.position.text(),
                                     path_of(printable(entry.key)),
                                     suggestion(entry.key, allowed_)));
    }
}

std::string ConfigMap::path_of(std::string_view key) const {
    return value_.path().empty() ? std::string(key) : fmt::format("{}.{}", value_.path(), key);
}

std::optional<ConfigValue> ConfigMap::find(std::string_view key) {
    if (std::find(allowed_.begin(), allowed_.end(), key) == allowed_.end()) {
        throw std::logic_error("scene key read but not allowed: " + path_of(key));
    }
    const ConfigNode& node = value_.node();
    for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (node.entries[i].key != key) continue;
        read_[i] = true;
        return ConfigValue(node.entries[i].value, path_of(key));
    }
    return std::nullopt;
}

ConfigValue ConfigMap::require(std::string_view key, std::string_view mend) {
    if (std::optional<ConfigValue> found = find(key)) return *std::move(found);
    value_.fail(fmt::format("'{}' is missing; {}", key, mend));
}

void ConfigMap::finish(std::string_view by) const {
    const ConfigNode& node = value_.node();
    for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (read_[i]) continue;
        throw InputError(fmt::format("{}: {}: is not used by {}; remove it",
                                     node.entries[i].position.text(), path_of(node.entries[i].key),
                                     by));
    }
}

}  // namespace uw
