#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/json/json.h"
#include "edit/document/scene_text.h"
#include "edit/session/edited_scene.h"

namespace uw {

/// A scene while the changes of one request are made to it, one after the other: all of them or
/// none.
class SceneChanges {
  public:
    SceneChanges(SceneText text, std::filesystem::path file,
                 std::shared_ptr<const EditedScene> scene, std::vector<std::string> off);

    /// Makes one change, {"op": ...} as docs/edit-api.md says. Throws InputError and UsageError of
    /// one line, IoError; then this is of no further use.
    void apply(const Json& change);

    const SceneText& text() const { return text_; }
    const std::shared_ptr<const EditedScene>& scene() const { return scene_; }
    const std::vector<std::string>& off() const { return off_; }
    /// What was changed: "lamps.left.position", or a lamp as a whole: "lamps.left".
    const std::set<std::string>& touched() const { return touched_; }

  private:
    const LampDesc& lamp(std::size_t index) const { return scene_->scene.desc().lamps[index]; }
    std::size_t lamp_of(const Json& change) const;
    std::string entry_of(std::size_t lamp) const;
    std::string free_name(const std::string& like) const;
    void set_vector(const std::string& path, const Vector3& value);
    void place(std::size_t lamp, const Point3& world);
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
