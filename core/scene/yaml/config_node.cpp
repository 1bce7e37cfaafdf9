#include "core/scene/yaml/config_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/text.h"

namespace uw {
namespace {

/// FNV-1a, 64 bit (Fowler, Noll, Vo; draft-eastlake-fnv).
class Fnv1a {
  public:
    void add(std::string_view bytes) {
        for (const char c : bytes) {
            state_ ^= static_cast<unsigned char>(c);
            state_ *= 0x100000001b3ULL;
        }
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

void add_text(Fnv1a& hash, char mark, std::string_view text) {
    hash.add(fmt::format("{}{}:", mark, text.size()));
    hash.add(text);
}

void add_node(Fnv1a& hash, const ConfigNode& node) {
    switch (node.kind) {
        case ConfigNode::Kind::null:
            hash.add("0");
            return;
        case ConfigNode::Kind::scalar: {
            double number = 0;
            if (!node.quoted && parse_number(node.scalar, number) == NumberText::number) {
                add_text(hash, 'n', fmt::format("{}", number));
            } else {
                add_text(hash, 't', node.scalar);
            }
            return;
        }
        case ConfigNode::Kind::sequence:
            hash.add(fmt::format("s{}:", node.items.size()));
            for (const ConfigNode& item : node.items) add_node(hash, item);
            return;
        case ConfigNode::Kind::map: {
            std::vector<const ConfigNode::Entry*> sorted;
            sorted.reserve(node.entries.size());
            for (const ConfigNode::Entry& entry : node.entries) sorted.push_back(&entry);
            std::sort(sorted.begin(), sorted.end(),
                      [](const auto* a, const auto* b) { return a->key < b->key; });
            hash.add(fmt::format("m{}:", sorted.size()));
            for (const ConfigNode::Entry* entry : sorted) {
                add_text(hash, 'k', entry->key);
                add_node(hash, entry->value);
            }
            return;
        }
    }
}

}  // namespace

std::string ConfigPosition::text() const {
    const std::string& name = *origin;
    return line > 0 ? fmt::format("{}:{}:{}", name, line, column) : name;
}

const ConfigNode* ConfigNode::find(std::string_view key) const {
    for (const Entry& entry : entries) {
        if (entry.key == key) return &entry.value;
    }
    return nullptr;
}

ConfigNode* ConfigNode::find(std::string_view key) {
    for (Entry& entry : entries) {
        if (entry.key == key) return &entry.value;
    }
    return nullptr;
}

std::string ConfigNode::description() const {
    switch (kind) {
        case Kind::null:
            return "nothing";
        case Kind::sequence:
            return fmt::format("a list of {}", items.size());
        case Kind::map:
            return "a map";
        case Kind::scalar:
            break;
    }
    double number = 0;
    if (quoted) return fmt::format("the quoted text '{}'", printable(scalar));
    if (parse_number(scalar, number) == NumberText::number) return "the number " + scalar;
    return fmt::format("the text '{}'", printable(scalar));
}

std::string config_hash(const ConfigNode& root) {
    Fnv1a hash;
    add_node(hash, root);
    return fmt::format("{:016x}", hash.value());
}

std::string text_hash(std::string text) {
    ConfigNode content;
    content.kind = ConfigNode::Kind::scalar;
    content.quoted = true;
    content.scalar = std::move(text);
    return config_hash(content);
}

}  // namespace uw
