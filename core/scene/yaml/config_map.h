#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/yaml/config_value.h"

namespace uw {

/// A map of known keys. A key that is not known, and a known key that nothing reads, are errors:
/// no input is silently ignored. Refers to the value's node: do not outlive it.
class ConfigMap {
  public:
    /// `allowed` are all keys this map may have; `mend` shows how it should look. Throws InputError
    /// where `value` is no map or has another key.
    ConfigMap(ConfigValue value, std::initializer_list<std::string_view> allowed,
              std::string_view mend);

    const ConfigValue& value() const { return value_; }
    bool has(std::string_view key) const { return value_.node().find(key) != nullptr; }

    /// The value of a key, which counts as read; none where the key is left out.
    std::optional<ConfigValue> find(std::string_view key);
    /// The value of a key that must be there. Throws InputError with `mend` where it is left out.
    ConfigValue require(std::string_view key, std::string_view mend);

    /// Throws InputError at a key that nothing read. `by` says who had no use for it ("type
    /// 'box'").
    void finish(std::string_view by) const;

  private:
    std::string path_of(std::string_view key) const;

    ConfigValue value_;
    std::vector<std::string_view> allowed_;
    std::vector<bool> read_;  // per entry of the node
};

}  // namespace uw
