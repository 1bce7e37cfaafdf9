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
constexpr std::size_t k_max_steps = 32;  // deeper than any key; the tree is walked recursively

/// Takes an index, "[0]" or "[*]", from the beginning of `text`; false if it has none.
bool take_index(std::string_view& text, std::vector<KeyStep>& steps) {
    const std::size_t close = text.find(']');
    if (!text.starts_with('[') || close == std::string_view::npos) return false;
    std::size_t index = 0;
    const char* const end = text.data() + close;
    const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
    if (text.substr(0, close) == "[*")
        steps.push_back({"", std::nullopt, true});
    else if (error == std::errc() && stop == end)
        steps.push_back({"", index});
    else
        return false;
    text.remove_prefix(close + 1);
    return true;
}

/// Takes a name from the beginning of `text`, in quotes or up to a dot or a bracket; false if it
/// has none.
bool take_name(std::string_view& text, std::vector<KeyStep>& steps) {
    if (text.starts_with('"') || text.starts_with('\'')) {
        const std::size_t end = text.find(text.front(), 1);
        if (end == std::string_view::npos) return false;
        steps.push_back({std::string(text.substr(1, end - 1)), std::nullopt, false, true});
        text.remove_prefix(end + 1);
        return true;
    }
    const std::size_t end = std::min(text.find_first_of(".["), text.size());
    if (end == 0) return false;
    const std::string_view name = text.substr(0, end);
    steps.push_back({name == "*" ? "" : std::string(name), std::nullopt, name == "*"});
    text.remove_prefix(end);
    return true;
}

bool has_any(const std::vector<KeyStep>& steps) {
    return std::ranges::any_of(steps, &KeyStep::is_any);
}

/// `path` and a step below it.
std::string below(const std::string& path, const KeyStep& step) {
    const std::string text = step.text();
    return path + (path.empty() || text.starts_with('[') ? "" : ".") + text;
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
            if (item == name && !name.empty()) {
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
        // A grid without a name is called [0].
        if (ConfigNode* const found = node_->find(KeyStep{"", index}.text())) {
            node_ = found;
            return;
        }
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

/// The child of `node`, whose own path is `path`, to which the step `i` of a path leads; `i`
/// becomes the index of the last joined step.
std::optional<Child> child_at(const ConfigNode& node, const std::vector<KeyStep>& steps,
                              std::size_t& i, std::string_view path) {
    if (steps[i].is_any) return std::nullopt;
    if (steps[i].index && node.kind != ConfigNode::Kind::map) {
        if (*steps[i].index >= node.items.size()) return std::nullopt;
        return Child{*steps[i].index, true};
    }
    // Entries may have no name.
    for (std::size_t item = 0; item < node.items.size() && !steps[i].key.empty(); ++item)
        if (entry_name(node, item, path) == steps[i].key) return Child{item, true};
    const std::string key = joined_key(node, steps, i);
    for (std::size_t entry = 0; entry < node.entries.size(); ++entry)
        if (node.entries[entry].key == key) return Child{entry, false};
    return std::nullopt;
}

/// The children from `root` along a path; none if it does not exist.
std::optional<std::vector<Child>> children_to(const ConfigNode& root, std::string_view path) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (steps.empty()) return std::nullopt;
    std::vector<Child> children;
    const ConfigNode* node = &root;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::string_view before = i == 1 ? std::string_view(steps[0].key) : "";
        const auto child = child_at(*node, steps, i, before);
        if (!child) return std::nullopt;
        children.push_back(*child);
        node = &child_of(*node, *child);
    }
    return children;
}

}  // namespace

std::string KeyStep::text() const {
    if (is_any) return "*";
    if (index) return "[" + std::to_string(*index) + "]";
    const bool is_word = !key.empty() && key != "*" &&
                         key.find_first_of("\"'.=") == std::string::npos && key.front() != '[';
    if (is_word) return key;
    const char quote = key.find('"') == std::string::npos ? '"' : '\'';
    return quote + key + quote;
}

std::vector<KeyStep> parse_key_path(std::string_view path) {
    std::vector<KeyStep> steps;
    while (true) {
        // grids.[0] is grids[0]: a grid without a name.
        const bool is_index = !steps.empty() && path.starts_with('[');
        if (!is_index && !take_name(path, steps)) return {};
        while (path.starts_with('['))
            if (!take_index(path, steps)) return {};
        if (path.empty()) break;
        if (path.front() != '.') return {};
        path.remove_prefix(1);
    }
    if (steps.size() > k_max_steps) return {};
    return steps;
}

std::size_t end_of_path(std::string_view override_text) {
    char quote = 0;
    for (std::size_t i = 0; i < override_text.size(); ++i) {
        const char c = override_text[i];
        const bool begins = i == 0 || override_text[i - 1] == '.';
        if (quote != 0)
            quote = c == quote ? 0 : quote;
        else if (begins && (c == '"' || c == '\''))
            quote = c;
        else if (c == '=')
            return i;
    }
    return std::string_view::npos;
}

std::string joined_key(const ConfigNode& map, const std::vector<KeyStep>& steps, std::size_t& i) {
    std::string found = steps[i].index ? steps[i].text() : steps[i].key;
    if (map.kind != ConfigNode::Kind::map || steps[i].is_quoted) return found;
    std::string joined = found;
    for (std::size_t next = i + 1; next < steps.size() && !steps[next].is_quoted; ++next) {
        joined += (steps[next].index ? "" : ".") + steps[next].text();
        if (map.find(joined) == nullptr) continue;
        found = joined;
        i = next;
    }
    return found;
}

namespace {

/// Appends the paths of all nodes below `node`, which is at `path`, to which `steps` from `i` on
/// lead.
void expand(const ConfigNode& node, const std::vector<KeyStep>& steps, std::size_t i,
            std::string path, std::vector<std::string>& paths) {
    if (std::none_of(steps.begin() + static_cast<std::ptrdiff_t>(i), steps.end(),
                     [](const KeyStep& step) { return step.is_any; })) {
        // Of these the last may be missing: they are created.
        for (; i < steps.size(); ++i) path = below(path, steps[i]);
        paths.push_back(std::move(path));
        return;
    }
    if (!steps[i].is_any) {
        const std::size_t first = i;
        const auto child = child_at(node, steps, i, path);
        if (!child) return;
        for (std::size_t step = first; step <= i; ++step) path = below(path, steps[step]);
        expand(child_of(node, *child), steps, i + 1, std::move(path), paths);
        return;
    }
    for (std::size_t item = 0; item < node.items.size(); ++item) {
        std::vector<KeyStep> name{{entry_name(node, item, path), std::nullopt}};
        std::size_t at = 0;
        const auto named = child_at(node, name, at, path);
        const bool is_known = !name[0].key.empty() && named && named->index == item;
        expand(node.items[item], steps, i + 1, below(path, is_known ? name[0] : KeyStep{"", item}),
               paths);
    }
    for (const ConfigNode::Entry& entry : node.entries)
        expand(entry.value, steps, i + 1, below(path, {entry.key, std::nullopt}), paths);
}

}  // namespace

std::vector<std::string> expanded_paths(const ConfigNode& root, std::string_view path,
                                        const std::string& origin) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (!has_any(steps)) return {std::string(path)};
    std::vector<std::string> paths;
    expand(root, steps, 0, "", paths);
    if (paths.empty())
        throw InputError(fmt::format(
            "{}: {}: the scene has nothing of that kind; * stands for every entry of a list or map",
            origin, printable(path)));
    return paths;
}

std::string entry_name(const ConfigNode& list, std::size_t entry, std::string_view list_path) {
    const ConfigNode* const name = list.items[entry].find("name");
    if (name != nullptr) return name->scalar;
    return list_path == "lamps" ? fmt::format("lamp{}", entry + 1) : "";
}

void apply_override(ConfigNode& root, const std::string& text) {
    const std::string origin = "--set " + printable(text, k_longest_origin);
    const std::size_t equals = end_of_path(text);
    if (equals == std::string::npos || equals == 0) fail_path(origin);
    set_value(root, std::string_view(text).substr(0, equals),
              parse_yaml_value(std::string_view(text).substr(equals + 1), origin), origin);
}

void set_value(ConfigNode& root, std::string_view path, ConfigNode value,
               const std::string& origin) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (steps.empty()) fail_path(origin);
    if (has_any(steps)) {
        for (const std::string& one : expanded_paths(root, path, origin))
            set_value(root, one, value, origin);
        return;
    }
    Walk walk(root, origin);
    walk.go(steps);
    walk.set(std::move(value));
}

namespace {

/// The same; the path itself if * matches nothing.
std::vector<std::string> paths_for(const ConfigNode& root, std::string_view path) {
    std::vector<std::string> paths;
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (has_any(steps)) expand(root, steps, 0, "", paths);
    if (paths.empty()) paths.emplace_back(path);
    return paths;
}

}  // namespace

const ConfigNode* find_value(const ConfigNode& root, std::string_view path) {
    const auto children = children_to(root, path);
    if (!children) return nullptr;
    const ConfigNode* node = &root;
    for (const Child& child : *children) node = &child_of(*node, child);
    return node;
}

bool remove_value(ConfigNode& root, std::string_view path) {
    if (has_any(parse_key_path(path))) {
        // From the last on, so that indices of those before stay.
        bool is_there = false;
        std::vector<std::string> paths;
        expand(root, parse_key_path(path), 0, "", paths);
        for (auto one = paths.rbegin(); one != paths.rend(); ++one)
            is_there = remove_value(root, *one) || is_there;
        return is_there;
    }
    const auto children = children_to(root, path);
    if (!children) return false;
    ConfigNode* node = &root;
    for (std::size_t i = 0; i + 1 < children->size(); ++i) node = &child_of(*node, (*children)[i]);
    const auto at = static_cast<std::ptrdiff_t>(children->back().index);
    if (children->back().is_item)
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
        const std::size_t first = i;
        if (steps[i].is_any) break;  // it matches nothing
        if (node->kind == ConfigNode::Kind::sequence) {
            KeyStep& step = steps[i];
            for (std::size_t item = 0;
                 item < node->items.size() && !step.index && !step.key.empty(); ++item)
                if (entry_name(*node, item, path) == step.key) step = {"", item};
            const bool is_there = step.index && *step.index < node->items.size();
            node = is_there ? &node->items[*step.index] : nullptr;
        } else {
            const std::string found = joined_key(*node, steps, i);
            node = node->find(found);
            if (node != nullptr && i > first) {
                // One step for all that are joined.
                steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(first),
                            steps.begin() + static_cast<std::ptrdiff_t>(i));
                i = first;
            }
            steps[i] = {found, std::nullopt};
        }
        path = below(path, steps[i]);
    }
    return steps;
}

bool begins_with(const std::vector<KeyStep>& part, const std::vector<KeyStep>& whole) {
    return part.size() >= whole.size() && std::equal(whole.begin(), whole.end(), part.begin());
}

}  // namespace

bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole) {
    for (const std::string& of_part : paths_for(scene, part))
        for (const std::string& of_whole : paths_for(scene, whole))
            if (begins_with(resolved(scene, of_part), resolved(scene, of_whole))) return true;
    return false;
}

std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys) {
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (is_part_of(scene, keys[i], keys[j]) || is_part_of(scene, keys[j], keys[i]))
                return std::pair(keys[j], keys[i]);
    return std::nullopt;
}

}  // namespace uw
