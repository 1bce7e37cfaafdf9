#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/yaml_document.h"

namespace uw {

/// One step of a key path: a key of a map (or the name of a list's entry), or an index into a list.
struct KeyStep {
    std::string key;
    std::optional<std::size_t> index;

    /// As it is written in a path: "position" or "[0]".
    std::string text() const { return index ? "[" + std::to_string(*index) + "]" : key; }
    friend bool operator==(const KeyStep&, const KeyStep&) = default;
};

/// The steps of "lamps[0].position" or "lamps.left.position". Empty if `path` is not of that form,
/// or deeper than any key.
std::vector<KeyStep> parse_key_path(std::string_view path);

/// Joins the step `i` of a path with those after it if `map` has such a key: a grid may be called
/// density[1], and keys of `variations` are paths themselves. `i` is then that of the last of them.
std::string joined_key(const ConfigNode& map, const std::vector<KeyStep>& steps, std::size_t& i);

/// The name by which paths know an entry of the list at the path `list_path`: its `name`; a lamp
/// without one is named after its index. Empty if it has none.
std::string entry_name(const ConfigNode& list, std::size_t entry, std::string_view list_path);

/// Applies one "key.path=value" of --set to a scene's tree: `lamps[0].intensity=[1, 2, 3]`,
/// `lamps.left.power=20` (a list's entry by its name), `camera.pose.position=[0, 0, 1]`. The value
/// is YAML and replaces any existing one; missing maps along the path are created, so that a
/// mistyped key is caught by the same checks as in the file. Throws UsageError if `text` is not of
/// that form, InputError if the path does not exist.
void apply_override(ConfigNode& root, const std::string& text);

/// The same for a path and a value that has been parsed; messages begin with `origin`.
void set_value(ConfigNode& root, std::string_view path, ConfigNode value,
               const std::string& origin);

/// The value at such a path, null if there is none; and removing it with its key, or as an entry of
/// its list, false if there is none.
const ConfigNode* find_value(const ConfigNode& root, std::string_view path);
bool remove_value(ConfigNode& root, std::string_view path);

/// Whether the path `part` leads to the value at `whole` or into it, however each is written:
/// lamps.left.position[0] is part of lamps[0].position if that lamp is called left.
bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole);

/// Two of the paths of which one is part of the other; none if there are none.
std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys);

}  // namespace uw
