#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "core/base/json.h"
#include "core/base/spectrum.h"
#include "core/image/colour_view.h"
#include "core/scene/yaml_document.h"
#include "edit/document/scene_text.h"
#include "render/image_scene.h"

namespace uw {

/// The folder of a file: "." for a name alone.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// The editor's data on a lamp besides its description.
struct EditedLamp {
    /// The index of its entry in the file's list; none: a glTF file provides it.
    std::optional<std::size_t> entry;
    /// Identifies its light apart from its brightness: if it and EditedScene::surrounding are
    /// equal, the images of the lamp are multiples of each other.
    std::string key;
    Spectrum brightness;  // Lamp::axis_intensity: per band on the axis [W/sr]
    bool on = true;
};

/// A scene after a change; immutable.
struct EditedScene {
    explicit EditedScene(ImageScene resolved) : scene(std::move(resolved)) {}

    std::int64_t revision = 0;
    ImageScene scene;
    std::vector<EditedLamp> lamps;  // of `scene`, in their order
    std::string surrounding;        // identifies all but the lamps
    bool has_plain_colour = true;   // R, G and B are the three bands
    std::shared_ptr<const Camera> camera;
    std::shared_ptr<const ColourView> view;  // of pictures; null: sRGB
    std::vector<std::string> warnings;

    std::size_t bands() const { return scene.desc().water.bands_nm.size(); }
    /// The lamp of this name; none if there is none.
    std::optional<std::size_t> find_lamp(std::string_view name) const;
    /// The factors on the three planes of a lamp's image if its brightness per band is `brightness`
    /// instead of 1: the bands where colour is plain, else the brightest band thrice.
    std::array<double, 3> colour_scale(const Spectrum& brightness) const;
};

/// Reads a scene from the text of its file, as parsed; `off` are the names of lamps that are off,
/// `choice` is what is shown of it: the first camera of a rig that has no such one. Throws as
/// load_scene_text, ImageScene and make_lamp.
std::shared_ptr<const EditedScene> make_edited_scene(std::string_view text, const ConfigNode& tree,
                                                     const std::filesystem::path& file,
                                                     const std::vector<std::string>& off,
                                                     std::int64_t revision,
                                                     ImageChoice choice = {});

/// The scene without the lamps that are off.
ImageScene lit_scene(const EditedScene& edited);

/// Throws UsageError if `after` is read from a file outside of the scene's folder, after symbolic
/// links, from which `before` is not: also one that a mesh names.
void refuse_files_elsewhere(const EditedScene& before, const EditedScene& after);

/// A scene while the changes of one request are made to it, one after the other: all of them or
/// none. A request is
///
///     {"revision": 12, "label": "move left", "group": "drag-17", "changes": [{"op": ...}, ...]}
///
/// Successive requests of one group are one step of undo. It is in conflict if the same was changed
/// in another group since `revision`, or if undo, redo or reload came between.
class SceneChanges {
  public:
    SceneChanges(SceneText text, std::filesystem::path file,
                 std::shared_ptr<const EditedScene> scene, std::vector<std::string> off);

    /// Makes these changes. `lamp` is a lamp's name.
    ///
    ///     {"op": "set", "path", "value"}     path as for --set; null removes the key
    ///     {"op": "add_lamp", "lamp", "like"} `lamp` as in a scene file; `like`: a lamp whose
    ///                                        layout in the text is followed
    ///     {"op": "remove_lamp", "lamp"}
    ///     {"op": "duplicate_lamp", "lamp", "name"}   without `name` a free one is chosen
    ///     {"op": "mirror_lamp", "lamp", "copy"}      left for right of the camera
    ///     {"op": "rename_lamp", "lamp", "name"}
    ///     {"op": "move_lamp", "lamp", ...}   `pixel` with `keep`: "distance" (from the camera's
    ///                                        centre) or "z"; or `distance` [m] along its line of
    ///                                        sight; or `world`, a point
    ///     {"op": "aim_lamp", "lamp", ...}    `pixel`, where the handle of its axis is to be, or
    ///                                        `world`, a point to shine at
    ///     {"op": "lamp_on", "lamp", "on"}
    ///
    /// Successive `set`s are read together: a lamp cannot be given a kind and then its size. Throws
    /// InputError and UsageError of one line, IoError; then this is of no further use. A text that
    /// is new to the scene and, as a file's name, leads out of its folder is refused, whatever its
    /// key, before anything is read.
    void apply(const Json& changes);

    const SceneText& text() const { return text_; }
    const std::shared_ptr<const EditedScene>& scene() const { return scene_; }
    const std::vector<std::string>& off() const { return off_; }
    /// The paths that were changed: "lamps.left.position", or a lamp as a whole: "lamps.left".
    const std::set<std::string>& touched() const { return touched_; }

  private:
    void apply_one(const Json& change);
    const LampDesc& lamp(std::size_t index) const { return scene_->scene.desc().lamps[index]; }
    std::size_t lamp_of(const Json& change) const;
    std::string entry_of(std::size_t lamp) const;
    std::string placed_entry_of(std::size_t lamp) const;
    std::string free_name(const std::string& like) const;
    void set_vector(const std::string& path, const Vector3& value);
    void place(std::size_t lamp, const Point3& world);
    void check_texts(const std::set<std::string>& before) const;
    void read_again();

    void set(const Json& change);
    void add_lamp(const Json& change);
    void remove_lamp(const Json& change);
    void duplicate_lamp(const Json& change);
    void mirror_lamp(const Json& change);
    void rename_lamp(const Json& change);
    void move_lamp(const Json& change);
    void aim_lamp(const Json& change);
    void turn_lamp_on(const Json& change);

    SceneText text_;
    std::filesystem::path file_;
    std::shared_ptr<const EditedScene> scene_;
    std::vector<std::string> off_;
    std::set<std::string> touched_;
};

}  // namespace uw
