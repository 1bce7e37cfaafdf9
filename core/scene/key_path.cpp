#include "core/scene/key_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

constexpr std::size_t k_longest_origin = 80;
constexpr std::size_t k_most_steps = 32;  // deeper than any key; the tree is walked recursively

/// Reads the indices of "[0][1]" after a key; false if they are not of that form.
bool append_indices(std::string_view text, std::vector<KeyStep>& steps) {
    while (!text.empty()) {
        const std::size_t close = text.find(']');
        if (text.front() != '[' || close == std::string_view::npos) return false;
        std::size_t index = 0;
        const char* const end = text.data() + close;
        const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
        if (error != std::errc() || stop != end) return false;
        steps.push_back({"", index});
        text.remove_prefix(close + 1);
    }
    return true;
}

[[noreturn]] void fail_path(const std::string& origin) {
    throw UsageError(
        fmt::format("{}: not of the form key.path=value; for example --set "
                    "lamps[0].power=20",
                    origin));
}

/// A walk down the tree along an override's path.
class Walk {
  public:
    Walk(ConfigNode& root, std::string origin)
        : node_(&root),
          origin_(std::move(origin)),
          position_{std::make_shared<const std::string>(origin_), 0, 0} {}

    void go(const std::vector<KeyStep>& steps) {
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i].index) {
                to_index(*steps[i].index);
                path_ += steps[i].text();
            } else {
                to_key(joined_key(*node_, steps, i));
            }
        }
    }
    void set(ConfigNode value) { *node_ = std::move(value); }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        throw InputError(fmt::format("{}: {}: {}", origin_, path_.empty() ? "scene" : path_, what));
    }

    void to_key(const std::string& key) {
        if (node_->kind == ConfigNode::Kind::null) {
            *node_ = ConfigNode{};
            node_->kind = ConfigNode::Kind::map;
            node_->position = position_;
        }
        if (node_->kind == ConfigNode::Kind::sequence) {
            to_named_item(key);
        } else if (node_->kind == ConfigNode::Kind::scalar) {
            fail(fmt::format("is {}, so it has no key '{}'; set {} itself", node_->description(),
                             printable(key), path_));
        } else if (ConfigNode* const found = node_->find(key)) {
            node_ = found;
        } else {
            std::vector<std::string_view> neighbours;
            for (const ConfigNode::Entry& entry : node_->entries) neighbours.push_back(entry.key);
            nearest_key_ = std::string(nearest_word(key, neighbours));
            node_->entries.push_back({key, position_, ConfigNode{}});
            node_ = &node_->entries.back().value;
            node_->position = position_;
        }
        if (!path_.empty()) path_ += '.';
        path_ += printable(key);
    }

    void to_named_item(const std::string& name) {
        std::string names;
        for (std::size_t i = 0; i < node_->items.size(); ++i) {
            const std::string item = entry_name(*node_, i, path_);
            if (item == name) {
                node_ = &node_->items[i];
                return;
            }
            if (!item.empty()) names += (names.empty() ? "" : ", ") + printable(item);
        }
        fail(fmt::format("is a list, and none of its {} entries is called '{}'; {}",
                         node_->items.size(), printable(name),
                         names.empty() ? fmt::format("write {}[0] for the first", path_)
                                       : "there are: " + names));
    }

    void to_index(std::size_t index) {
        const bool list = node_->kind == ConfigNode::Kind::sequence;
        if (node_->kind == ConfigNode::Kind::null && !nearest_key_.empty()) {
            fail(fmt::format("is not in the scene, so there is no [{}]; did you mean '{}'?", index,
                             printable(nearest_key_)));
        }
        if (!list && node_->kind != ConfigNode::Kind::null) {
            fail(fmt::format("is {}, not a list; leave out [{}]", node_->description(), index));
        }
        const std::size_t count = node_->items.size();
        if (index >= count) {
            fail(fmt::format("has {} {}, so there is no [{}]; {}", count,
                             count == 1 ? "entry" : "entries", index,
                             count == 0 ? "set the whole list" : "count from [0]"));
        }
        node_ = &node_->items[index];
    }

    ConfigNode* node_;
    std::string origin_;
    ConfigPosition position_;
    std::string path_;
    std::string nearest_key_;  // of those beside the last key, if that was missing
};

/// One of the nodes in another: at an index of its items, or of its entries.
struct Child {
    std::size_t index = 0;
    bool is_item = false;
};

template <class Node>  // const or not
Node& child_of(Node& node, const Child& child) {
    return child.is_item ? node.items[child.index] : node.entries[child.index].value;
}

/// What the step `i` of a path leads to from `node`, whose own path is `path`; `i` becomes that of
/// the last of joined steps.
std::optional<Child> child_at(const ConfigNode& node, const std::vector<KeyStep>& steps,
                              std::size_t& i, std::string_view path) {
    if (steps[i].index) {
        if (*steps[i].index >= node.items.size()) return std::nullopt;
        return Child{*steps[i].index, true};
    }
    for (std::size_t item = 0; item < node.items.size(); ++item)
        if (entry_name(node, item, path) == steps[i].key) return Child{item, true};
    const std::string key = joined_key(node, steps, i);
    for (std::size_t entry = 0; entry < node.entries.size(); ++entry)
        if (node.entries[entry].key == key) return Child{entry, false};
    return std::nullopt;
}

/// The way from `root` along a path; none if it does not exist.
std::optional<std::vector<Child>> way_to(const ConfigNode& root, std::string_view path) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (steps.empty()) return std::nullopt;
    std::vector<Child> way;
    const ConfigNode* node = &root;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::string_view before = i == 1 ? std::string_view(steps[0].key) : "";
        const auto child = child_at(*node, steps, i, before);
        if (!child) return std::nullopt;
        way.push_back(*child);
        node = &child_of(*node, *child);
    }
    return way;
}

}  // namespace

std::vector<KeyStep> parse_key_path(std::string_view path) {
    std::vector<KeyStep> steps;
    std::size_t start = 0;
    while (start <= path.size()) {
        const std::size_t dot = std::min(path.find('.', start), path.size());
        const std::string_view segment = path.substr(start, dot - start);
        const std::size_t bracket = std::min(segment.find('['), segment.size());
        if (bracket == 0) return {};
        steps.push_back({std::string(segment.substr(0, bracket)), std::nullopt});
        if (!append_indices(segment.substr(bracket), steps)) return {};
        start = dot + 1;
    }
    if (steps.size() > k_most_steps) return {};
    return steps;
}

std::string joined_key(const ConfigNode& map, const std::vector<KeyStep>& steps, std::size_t& i) {
    std::string found = steps[i].key;
    if (map.kind != ConfigNode::Kind::map) return found;
    std::string joined = found;
    for (std::size_t next = i + 1; next < steps.size(); ++next) {
        joined += (steps[next].index ? "" : ".") + steps[next].text();
        if (map.find(joined) == nullptr) continue;
        found = joined;
        i = next;
    }
    return found;
}

std::string entry_name(const ConfigNode& list, std::size_t entry, std::string_view list_path) {
    const ConfigNode* const name = list.items[entry].find("name");
    if (name != nullptr) return name->scalar;
    return list_path == "lamps" ? fmt::format("lamp{}", entry + 1) : "";
}

void apply_override(ConfigNode& root, const std::string& text) {
    const std::string origin = "--set " + printable(text, k_longest_origin);
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) fail_path(origin);
    set_value(root, std::string_view(text).substr(0, equals),
              parse_yaml_value(std::string_view(text).substr(equals + 1), origin), origin);
}

void set_value(ConfigNode& root, std::string_view path, ConfigNode value,
               const std::string& origin) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (steps.empty()) fail_path(origin);
    Walk walk(root, origin);
    walk.go(steps);
    walk.set(std::move(value));
}

const ConfigNode* find_value(const ConfigNode& root, std::string_view path) {
    const auto way = way_to(root, path);
    if (!way) return nullptr;
    const ConfigNode* node = &root;
    for (const Child& child : *way) node = &child_of(*node, child);
    return node;
}

bool remove_value(ConfigNode& root, std::string_view path) {
    const auto way = way_to(root, path);
    if (!way) return false;
    ConfigNode* node = &root;
    for (std::size_t i = 0; i + 1 < way->size(); ++i) node = &child_of(*node, (*way)[i]);
    const auto at = static_cast<std::ptrdiff_t>(way->back().index);
    if (way->back().is_item)
        node->items.erase(node->items.begin() + at);
    else
        node->entries.erase(node->entries.begin() + at);
    return true;
}

namespace {

/// The steps of a path, names of list entries replaced by their indices as far as the scene goes.
std::vector<KeyStep> resolved(const ConfigNode& scene, const std::string& key) {
    std::vector<KeyStep> steps = parse_key_path(key);
    const ConfigNode* node = &scene;
    std::string path;
    for (std::size_t i = 0; i < steps.size() && node != nullptr; ++i) {
        KeyStep& step = steps[i];
        if (node->kind == ConfigNode::Kind::sequence) {
            for (std::size_t item = 0; item < node->items.size() && !step.index; ++item)
                if (entry_name(*node, item, path) == step.key) step = {"", item};
            const bool is_there = step.index && *step.index < node->items.size();
            node = is_there ? &node->items[*step.index] : nullptr;
        } else {
            node = step.index ? nullptr : node->find(step.key);
        }
        path += (path.empty() || step.index ? "" : ".") + step.text();
    }
    return steps;
}

bool begins_with(const std::vector<KeyStep>& part, const std::vector<KeyStep>& whole) {
    return part.size() >= whole.size() && std::equal(whole.begin(), whole.end(), part.begin());
}

}  // namespace

bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole) {
    return begins_with(resolved(scene, part), resolved(scene, whole));
}

std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys) {
    std::vector<std::vector<KeyStep>> paths;
    for (const std::string& key : keys) paths.push_back(resolved(scene, key));
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (begins_with(paths[i], paths[j]) || begins_with(paths[j], paths[i]))
                return std::pair(keys[j], keys[i]);
    return std::nullopt;
}

}  // namespace uw
