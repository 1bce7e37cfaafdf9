#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "core/scene/yaml_document.h"

namespace uw {

/// A node with its key path, read as a typed value. Invalid input throws InputError
/// "file:line:column: key.path: what; hint". Refers to the node, which must outlive it.
class ConfigValue {
  public:
    ConfigValue(const ConfigNode& node, std::string path) : node_(&node), path_(std::move(path)) {}

    const ConfigNode& node() const { return *node_; }
    const std::string& path() const { return path_; }
    /// "plume.yaml:14:7: lamps[0].position"; without the path for the whole file.
    std::string location() const;
    /// Throws the InputError "<location>: <what>"; `what` includes the hint.
    [[noreturn]] void fail(std::string_view what) const;

    /// A finite number of at most 1e12. `hint` tells the user what to give ("give the distance in
    /// metres").
    double number(std::string_view hint) const;
    double positive(std::string_view hint) const;
    double non_negative(std::string_view hint) const;
    /// A number with low <= x <= high.
    double within(double low, double high, std::string_view hint) const;
    /// A number with low < x < high.
    double between(double low, double high, std::string_view hint) const;
    /// A whole number with low <= x <= high.
    int integer(int low, int high, std::string_view hint) const;
    /// Text that is not empty.
    std::string text(std::string_view hint) const;

    /// The entries of a list, each with its path.
    std::vector<ConfigValue> list(std::string_view hint) const;
    /// A list of exactly `count` entries.
    std::vector<ConfigValue> list_of(std::size_t count, std::string_view hint) const;
    /// One entry per band: a list of `band_count`, or one scalar for all of them.
    std::vector<ConfigValue> per_band(std::size_t band_count, std::string_view hint) const;
    /// One number >= 0 per band.
    std::vector<double> non_negative_per_band(std::size_t band_count, std::string_view hint) const;
    /// Three numbers.
    Vector3 vector(std::string_view hint) const;
    /// Three numbers, not all zero, scaled to length 1.
    Vector3 direction(std::string_view hint) const;

    /// One of a few words, as its associated value.
    template <class T, std::size_t N>
    T choice(const std::array<std::pair<std::string_view, T>, N>& choices) const {
        std::array<std::string_view, N> words{};
        for (std::size_t i = 0; i < N; ++i) words[i] = choices[i].first;
        return choices[word_index(words)].second;
    }

    /// The index of this word in `words`.
    std::size_t word_index(std::span<const std::string_view> words) const;

  private:
    [[noreturn]] void fail_expected(std::string_view expected, std::string_view hint) const;
    [[noreturn]] void fail_number(NumberText outcome, std::string_view hint) const;

    const ConfigNode* node_;
    std::string path_;
};

/// A map of known keys. An unknown key, and a known key that is never read, are errors: no input is
/// silently ignored. Refers to the value's node, which must outlive it.
class ConfigMap {
  public:
    /// `allowed` are all keys that this map may have; `hint` shows what the map should look like.
    /// Throws InputError if `value` is not a map or has another key.
    ConfigMap(ConfigValue value, std::initializer_list<std::string_view> allowed,
              std::string_view hint)
        : ConfigMap(std::move(value), std::vector<std::string_view>(allowed), hint) {}
    /// The same, for keys that the scene names itself, which must outlive the map.
    ConfigMap(ConfigValue value, std::vector<std::string_view> allowed, std::string_view hint);

    const ConfigValue& value() const { return value_; }
    bool has(std::string_view key) const { return value_.node().find(key) != nullptr; }

    /// The value of a key, which is marked as read; empty if the key is missing.
    std::optional<ConfigValue> find(std::string_view key);
    /// The value of a required key. Throws InputError with `hint` if it is missing.
    ConfigValue require(std::string_view key, std::string_view hint);

    /// Throws InputError at a key that was not read. `by` names what does not use it ("type
    /// 'box'").
    void finish(std::string_view by) const;

  private:
    std::string path_of(std::string_view key) const;

    ConfigValue value_;
    std::vector<std::string_view> allowed_;
    std::vector<bool> read_;  // per entry of the node
};

}  // namespace uw
