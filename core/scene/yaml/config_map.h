#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/yaml/config_value.h"

namespace uw {

/// A map of known keys. An unknown key, and a known key that is never read, are errors: no input is
/// silently ignored. Refers to the value's node, which must outlive it.
class ConfigMap {
  public:
    /// `allowed` are all keys that this map may have; `mend` shows what it should look like. Throws
    /// InputError if `value` is not a map or has another key.
    ConfigMap(ConfigValue value, std::initializer_list<std::string_view> allowed,
              std::string_view mend);

    const ConfigValue& value() const { return value_; }
    bool has(std::string_view key) const { return value_.node().find(key) != nullptr; }

    /// The value of a key, which is marked as read; empty if the key is missing.
    std::optional<ConfigValue> find(std::string_view key);
    /// The value of a required key. Throws InputError with `mend` if it is missing.
    ConfigValue require(std::string_view key, std::string_view mend);

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
