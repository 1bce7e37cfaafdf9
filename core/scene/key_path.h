#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/yaml_document.h"

namespace uw {

/// One step of a key path: a key of a map (or the name of a list's entry), an index into a list, or
/// * for every entry of either.
struct KeyStep {
    std::string key;
    std::optional<std::size_t> index;
    bool is_any = false;
    bool is_quoted = false;  // the key is all of a name, whatever is in it

    /// The step as written in a path: "position", "[0]", "*", or in quotes if it is not a word.
    std::string text() const;
    friend bool operator==(const KeyStep& a, const KeyStep& b) {
        return a.key == b.key && a.index == b.index && a.is_any == b.is_any;
    }
};

/// The steps of "lamps[0].position", "lamps.left.position" or "lamps.*.position". A name that has
/// dots, brackets or equals signs in it, is empty, or is an asterisk, stands in quotes, double or
/// single: volumes[0].grids."soot=1".large. Empty if `path` is not of that form, or deeper than any
/// key.
std::vector<KeyStep> parse_key_path(std::string_view path);

/// The end of the path in "key.path=value": the position of the first equals sign outside quotes,
/// npos if there is none.
std::size_t end_of_path(std::string_view override_text);

/// The paths that `path` matches: itself or, if it has * for an entry, those of all such entries of
/// the scene. Throws InputError, beginning with `origin`, if * matches nothing.
std::vector<std::string> expanded_paths(const ConfigNode& root, std::string_view path,
                                        const std::string& origin);

/// Joins the step `i` of a path with those after it if `map` has such a key: a grid may be called
/// density[1], and keys of `variations` are paths themselves. `i` is then that of the last of them.
std::string joined_key(const ConfigNode& map, const std::vector<KeyStep>& steps, std::size_t& i);

/// The name by which paths know an entry of the list at the path `list_path`: its `name`; a lamp
/// without one is named after its index. Empty if it has none.
std::string entry_name(const ConfigNode& list, std::size_t entry, std::string_view list_path);

/// Applies one "key.path=value" of --set to a scene's tree: `lamps[0].intensity=[1, 2, 3]`,
/// `lamps.left.power=20` (a list's entry by its name), `lamps.*.power=20` (of all entries),
/// `camera.pose.position=[0, 0, 1]`. The value
/// is YAML and replaces any existing one; missing maps along the path are created, so that a
/// mistyped key is caught by the same checks as in the file. Throws UsageError if `text` is not of
/// that form, InputError if the path does not exist.
void apply_override(ConfigNode& root, const std::string& text);

/// The same for a path and a value that has been parsed; messages begin with `origin`.
void set_value(ConfigNode& root, std::string_view path, ConfigNode value,
               const std::string& origin);

/// The value at such a path, null if there is none or it has *; and removing it with its key, or as
/// an entry of its list, or with * all of them, false if there is none.
const ConfigNode* find_value(const ConfigNode& root, std::string_view path);
bool remove_value(ConfigNode& root, std::string_view path);

/// Whether the path `part` leads to the value at `whole` or into it, in whatever spelling:
/// lamps.left.position[0] is part of lamps[0].position if that lamp is called left, and of
/// lamps.*.position.
bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole);

/// Two of the paths of which one is part of the other; none if there are none.
std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys);

}  // namespace uw
