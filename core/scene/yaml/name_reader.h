#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// A file name, resolved against the scene's folder. Throws InputError if no such file exists.
std::filesystem::path read_existing_file(const ConfigValue& value, const SceneContext& context);

/// The same, but a name with patterns for the frame number that is not itself a file denotes a
/// sequence; its files are not checked.
std::filesystem::path read_existing_file_or_sequence(const ConfigValue& value,
                                                     const SceneContext& context,
                                                     bool& is_sequence);

/// Fails: nothing in memory is called so.
[[noreturn]] void fail_not_in_memory(const ConfigValue& value, const std::string& name);

/// What `value` names among `known`, null: nothing is, as the scene has files alone. Throws
/// InputError if it is not there.
template <class T>
std::shared_ptr<const T> read_in_memory(
    const ConfigValue& value, const std::map<std::string, std::shared_ptr<const T>>* known) {
    const std::string name = value.text("give its name in memory");
    if (known != nullptr)
        if (const auto found = known->find(name); found != known->end()) return found->second;
    fail_not_in_memory(value, name);
}

/// A name that becomes part of `of` ("a layer's name"): up to 64 letters, digits, _ and -.
std::string read_short_name(const ConfigValue& value, std::string_view of, std::string_view mend);

}  // namespace uw
