#include "core/scene/yaml/scene_override.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/yaml/yaml_document.h"

namespace uw {
namespace {

constexpr std::size_t k_longest_origin = 80;
constexpr std::size_t k_most_steps = 32;  // deeper than any key; the tree is walked recursively

/// One step of a path: a key of a map (or name of a list's entry), or an index into a list.
struct Step {
    std::string key;
    std::optional<std::size_t> index;

    std::string text() const { return index ? fmt::format("[{}]", *index) : key; }
};

[[noreturn]] void fail_path(const std::string& origin) {
    throw UsageError(
        fmt::format("{}: not of the form key.path=value; for example --set "
                    "lamps[0].power=20",
                    origin));
}

/// Reads the indices of "[0][1]" after a key.
void append_indices(std::string_view text, const std::string& origin, std::vector<Step>& steps) {
    while (!text.empty()) {
        const std::size_t close = text.find(']');
        if (text.front() != '[' || close == std::string_view::npos) fail_path(origin);
        std::size_t index = 0;
        const char* const end = text.data() + close;
        const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
        if (error != std::errc() || stop != end) fail_path(origin);
        steps.push_back({"", index});
        text.remove_prefix(close + 1);
    }
}

std::vector<Step> parse_path(std::string_view path, const std::string& origin) {
    std::vector<Step> steps;
    std::size_t start = 0;
    while (start <= path.size()) {
        const std::size_t dot = std::min(path.find('.', start), path.size());
        const std::string_view segment = path.substr(start, dot - start);
        const std::size_t bracket = std::min(segment.find('['), segment.size());
        if (bracket == 0) fail_path(origin);
        steps.push_back({std::string(segment.substr(0, bracket)), std::nullopt});
        append_indices(segment.substr(bracket), origin, steps);
        start = dot + 1;
    }
    if (steps.size() > k_most_steps) fail_path(origin);
    return steps;
}

/// A walk down the tree along an override's path.
class Walk {
  public:
    Walk(ConfigNode& root, std::string origin)
        : node_(&root),
          origin_(std::move(origin)),
          position_{std::make_shared<const std::string>(origin_), 0, 0} {}

    void go(const std::vector<Step>& steps) {
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i].index) {
                to_index(*steps[i].index);
                path_ += steps[i].text();
                continue;
            }
            // a grid may be called density[1]
            if (i + 1 < steps.size() && steps[i + 1].index &&
                node_->kind == ConfigNode::Kind::map) {
                const std::string joined = steps[i].key + steps[i + 1].text();
                if (node_->find(joined) != nullptr) {
                    to_key(joined);
                    ++i;
                    continue;
                }
            }
            to_key(steps[i].key);
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
            const std::string item = item_name(i);
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

    /// The name of an entry; a lamp without one is named after its index.
    std::string item_name(std::size_t i) const {
        const ConfigNode* const name = node_->items[i].find("name");
        if (name != nullptr) return name->scalar;
        return path_ == "lamps" ? fmt::format("lamp{}", i + 1) : "";
    }

    void to_index(std::size_t index) {
        const bool list = node_->kind == ConfigNode::Kind::sequence;
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
};

}  // namespace

void apply_override(ConfigNode& root, const std::string& text) {
    const std::string origin = "--set " + printable(text, k_longest_origin);
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) fail_path(origin);
    const std::vector<Step> steps = parse_path(std::string_view(text).substr(0, equals), origin);
    ConfigNode value = parse_yaml_value(std::string_view(text).substr(equals + 1), origin);
    Walk walk(root, origin);
    walk.go(steps);
    walk.set(std::move(value));
}

}  // namespace uw
