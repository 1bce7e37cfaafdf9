#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml_document.h"

namespace uw {

/// One unknown number of a scene, or of the pictures that show it.
struct SceneUnknown {
    enum class Of : std::uint8_t {
        scene,
        exposure,  // of a picture: its light is so many times the scene's
        response,  // of all pictures: their light is the scene's to this power
    };
    std::string name;  // "water.absorption[0]", "camera.port.normal (tilt 1)"
    std::string unit;  // "deg" of tilts; else empty: the scene's own
    double start = 0;
    double scale = 1;  // a change that matters, > 0
    /// The range that scenes permit.
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    Of of = Of::scene;
    std::size_t picture = 0;  // whose exposure it is
};

/// Numbers of a scene that are to be found, and the scenes that have given ones in their place.
class SceneUnknowns {
  public:
    /// `keys` are paths as of --set, "water.absorption" or "camera.port.distance", where * stands
    /// for every entry: "lamps.*.position". A list of numbers is an unknown for each; a `normal` or
    /// `direction` is two, by which it is tilted [deg]. The natural limits of numbers, such as 0,
    /// are found by trying values with the scene's reader. `file` is the scene's. Two keys are no
    /// scene's: "exposure", one of each of the `pictures`, and "response"; both begin at 1. Throws
    /// UsageError for keys that the scene does not have or that hold no numbers, for these two
    /// without pictures, and as load_scene_tree.
    SceneUnknowns(ConfigNode tree, std::filesystem::path file, std::span<const std::string> keys,
                  std::span<const std::string> pictures = {});

    const std::vector<SceneUnknown>& all() const { return unknowns_; }
    std::size_t size() const { return unknowns_.size(); }

    /// Sets the initial value of an exposure, > 0.
    void begin_at(std::size_t unknown, double exposure);

    /// The scene with these values, one per unknown. Throws InputError if none may have them.
    SceneDesc scene(std::span<const double> values) const;

    /// The paths that `values` belong to, with what is written there, as SceneText::set takes it.
    std::vector<std::pair<std::string, std::string>> settings(std::span<const double> values) const;

    /// The unknowns whose key, as it was given or as it is, is or lies within `key`: for priors and
    /// bounds. Throws UsageError if there are none.
    std::vector<std::size_t> within(const std::string& key) const;

  private:
    /// A place in the scene with one unknown, or of a direction two.
    struct Place {
        std::string path;
        std::size_t first = 0;
        bool is_direction = false;
        Vector3 direction{};  // unit, as the scene has it
        Vector3 tilts[2]{};   // unit, across it and each other
    };
    void add_of_pictures(const std::string& key, std::span<const std::string> pictures);
    void add(const ConfigNode& node, const std::string& path);
    void add_number(const ConfigNode& node, const std::string& path, double scale);
    void limit();

    ConfigNode tree_;
    std::filesystem::path file_;
    std::vector<SceneUnknown> unknowns_;
    std::vector<Place> places_;
};

}  // namespace uw
