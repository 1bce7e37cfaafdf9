#pragma once

#include <string>
#include <string_view>

#include "core/scene/yaml_document.h"

namespace uw {

class YamlDraft;

/// The text of a scene file, edited in place: comments, order, layout, quotes and line ends stay as
/// they are, and only what changes is replaced.
///
/// Paths are those of --set: "lamps.left.position", "lamps[0].position[2]", "water.preset". A value
/// is YAML (or JSON), and `set` has the meaning of --set: whatever is at the path is replaced, and
/// missing maps are made; but where the old value and the new one are maps or lists alike, only the
/// entries that differ are written. After each change the text is parsed again and compared with
/// the tree in which that one value was set: nothing else has changed, or the change is refused.
///
/// A value that an alias stands for is written out where it is changed; one that is shared from its
/// anchor leaves the anchor to the others. What a glTF file provides is not in the text, and
/// changing it is refused with the reason.
///
/// Every change either succeeds or throws and leaves the text as it was: InputError, one line,
/// "plume.yaml:14:7: what; hint" or "lamps.left: what; hint"; UsageError for a path that is not of
/// the form of a path.
class SceneText {
  public:
    /// `origin` names the file in messages. Throws InputError as parse_yaml.
    SceneText(std::string text, std::string origin);

    const std::string& text() const { return text_; }
    const std::string& origin() const { return origin_; }
    const ConfigNode& tree() const { return tree_; }

    /// The value at `path`; nullptr if there is none.
    const ConfigNode* find(std::string_view path) const;

    void set(std::string_view path, std::string_view value, const NumberStyle& style = {});

    /// Removes a key with its value, or an entry of a list. Comments around it stay.
    void remove(std::string_view path);

    /// Appends an entry to the list at `list_path`, which is made if it is missing, in the layout
    /// of the entry at `like` or, if that is empty, of the last one.
    void append(std::string_view list_path, std::string_view value, std::string_view like = {},
                const NumberStyle& style = {});

    /// Appends a copy of a list's entry with another name.
    void duplicate(std::string_view entry_path, std::string_view name);

    /// Sets the `name` of a list's entry: of a lamp.
    void rename(std::string_view entry_path, std::string_view name);

  private:
    /// Takes over what a draft has become if it is what was intended.
    void take(const YamlDraft& draft, const ConfigNode& intended, std::string_view path);

    std::string text_;
    std::string origin_;
    ConfigNode tree_;
};

}  // namespace uw
