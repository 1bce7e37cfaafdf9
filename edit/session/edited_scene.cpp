#include "edit/session/edited_scene.h"

#include <fmt/format.h>
#include <limits.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/image/colour.h"
#include "core/light/lamp_factory.h"
#include "edit/session/request_members.h"
#include "edit/session/suggest.h"
#include "edit/session/view_geometry.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr std::array<std::string_view, 7> k_brightness_keys{
    "name", "spectrum", "intensity", "power", "lumens", "irradiance", "lux"};

void remove_keys(ConfigNode& map, std::span<const std::string_view> keys) {
    std::erase_if(map.entries, [&](const ConfigNode::Entry& entry) {
        return std::ranges::find(keys, entry.key) != keys.end();
    });
}

std::string hash_without(ConfigNode map, std::span<const std::string_view> keys) {
    remove_keys(map, keys);
    return config_hash(map);
}

// The proportions of the bands, which remain in an image whose colours are not the bands.
std::string proportions(const Spectrum& brightness, std::size_t bands) {
    double most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, brightness[b]);
    std::string text;
    for (std::size_t b = 0; b < bands; ++b)
        text += fmt::format(" {:.9g}", most > 0 ? brightness[b] / most : 1);
    return text;
}

bool is_plain(const BandColour& colour, std::size_t bands) {
    if (bands != 3) return false;
    for (std::size_t b = 0; b < bands; ++b) {
        Spectrum one{};
        one[b] = 1;
        const LinearRgb rgb = colour(one);
        for (std::size_t c = 0; c < 3; ++c)
            if (rgb[c] != (b == c ? 1 : 0)) return false;
    }
    return true;
}

EditedLamp make_edited_lamp(EditedScene& edited, const ConfigNode* entries, std::size_t index) {
    const SceneDesc& desc = edited.scene.desc();
    const LampDesc& lamp = desc.lamps[index];
    EditedLamp made;
    if (lamp.is_of_scene()) {
        made.brightness = per_band(edited.bands(), [](std::size_t) { return 1.0; });
        made.key = "of the scene " + lamp.name;
        return made;
    }
    made.brightness =
        make_lamp(lamp, desc.camera.world_from_camera, desc.water.bands_nm, edited.warnings)
            .axis_intensity();
    // The lamps of glTF files follow those of the scene file.
    if (entries && index < entries->items.size()) {
        made.entry = index;
        made.key = hash_without(entries->items[index], k_brightness_keys);
    } else {
        made.key = "gltf " + lamp.name;
    }
    if (!edited.has_plain_colour) made.key += proportions(made.brightness, edited.bands());
    return made;
}

}  // namespace

std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

std::optional<std::size_t> EditedScene::find_lamp(std::string_view name) const {
    const auto& all = scene.desc().lamps;
    const auto found = std::ranges::find(all, name, &LampDesc::name);
    if (found == all.end()) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
}

std::array<double, 3> EditedScene::colour_scale(const Spectrum& brightness) const {
    if (has_plain_colour) return {brightness[0], brightness[1], brightness[2]};
    double most = 0;
    for (std::size_t b = 0; b < bands(); ++b) most = std::max(most, brightness[b]);
    return {most, most, most};
}

std::shared_ptr<const EditedScene> make_edited_scene(std::string_view text, const ConfigNode& tree,
                                                     const std::filesystem::path& file,
                                                     const std::vector<std::string>& off,
                                                     std::int64_t revision, ImageChoice choice) {
    SceneDesc whole = load_scene_text(text, file);
    if (choice.camera >= whole.cameras.size()) choice.camera = 0;
    auto edited = std::make_shared<EditedScene>(ImageScene(std::move(whole), choice));
    edited->revision = revision;
    const SceneDesc& desc = edited->scene.desc();
    edited->warnings = desc.warnings;
    edited->camera = std::make_shared<Camera>(desc.camera);
    try {
        edited->view = colour_view(desc.render.view);
    } catch (const std::runtime_error& fault) {  // InputError or IoError
        edited->warnings.push_back(std::string(fault.what()) +
                                   "; until then the picture is shown as sRGB");
    }
    edited->has_plain_colour =
        is_plain(make_band_colour(desc.render.colour, desc.water.bands_nm), edited->bands());
    edited->surrounding =
        fmt::format("{} {} {}", hash_without(tree, std::array<std::string_view, 1>{"lamps"}),
                    choice.camera, choice.frame.value_or(-1));
    const ConfigNode* entries = tree.find("lamps");
    for (std::size_t i = 0; i < desc.lamps.size(); ++i) {
        edited->lamps.push_back(make_edited_lamp(*edited, entries, i));
        edited->lamps.back().on = std::ranges::find(off, desc.lamps[i].name) == off.end();
    }
    return edited;
}

ImageScene lit_scene(const EditedScene& edited) {
    return edited.scene.with([&](SceneDesc& desc) {
        std::vector<LampDesc>& lamps = desc.lamps;
        for (std::size_t i = lamps.size(); i-- > 0;)
            if (!edited.lamps[i].on) lamps.erase(lamps.begin() + static_cast<std::ptrdiff_t>(i));
    });
}

namespace {

// Positions that were dragged are written to 0.1 mm, directions to 1e-4: below a tenth of a pixel.
constexpr NumberStyle k_dragged{.decimals = 4};

void add_texts(const ConfigNode& node, std::set<std::string>& texts) {
    if (node.kind == ConfigNode::Kind::scalar) texts.insert(node.scalar);
    for (const ConfigNode& item : node.items) add_texts(item, texts);
    for (const ConfigNode::Entry& entry : node.entries) add_texts(entry.value, texts);
}

std::set<std::string> texts_of(const ConfigNode& tree) {
    std::set<std::string> texts;
    add_texts(tree, texts);
    return texts;
}

/// Whether a text, as the name of a file or of one for each frame, leads out of the folder.
bool leads_elsewhere(const std::filesystem::path& folder, const std::string& text) {
    if (text.find('\0') != std::string::npos) return true;
    const std::filesystem::path name = text;
    // No file has such a name.
    for (const std::filesystem::path& part : name)
        if (part.native().size() > NAME_MAX) return false;
    const std::filesystem::path file = folder / name;
    if (!lies_within(folder, file)) return true;
    for (std::filesystem::path part = name; has_frame_pattern(part.string());
         part = part.parent_path())
        for (const int frame : frames_found(folder / part))
            if (!lies_within(folder, file_of_frame(file, frame))) return true;
    return false;
}

[[noreturn]] void refuse_file(const std::filesystem::path& name) {
    throw UsageError(
        fmt::format("{}: choose a file of the scene's folder", printable(name.string())));
}

// The name with "left" for "right" and so on; else the name itself.
std::string mirrored_name(const std::string& name) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> k_sides{
        {{"left", "right"}, {"right", "left"}, {"port", "starboard"}, {"starboard", "port"}}};
    for (const auto& [side, other] : k_sides) {
        const std::size_t at = name.find(side);
        if (at != std::string::npos)
            return name.substr(0, at) + std::string(other) + name.substr(at + side.size());
    }
    return name;
}

}  // namespace

void refuse_files_elsewhere(const EditedScene& before, const EditedScene& after) {
    const SceneDesc &old = before.scene.whole(), &desc = after.scene.whole();
    // Meshes that are there already are not asked again what they name.
    SideFiles known;
    for (const GeometryDesc& geometry : old.geometry) known[geometry.file];
    std::set<std::filesystem::path> there;
    for (const InputFile& input : input_files(old, before.scene.choice(), known))
        there.insert(input.file);
    for (const InputFile& input : input_files(desc, after.scene.choice(), known))
        if (!there.contains(input.file) && !lies_within(folder_of(desc.file), input.file))
            refuse_file(input.file);
}

SceneChanges::SceneChanges(SceneText text, std::filesystem::path file,
                           std::shared_ptr<const EditedScene> scene, std::vector<std::string> off)
    : text_(std::move(text)),
      file_(std::move(file)),
      scene_(std::move(scene)),
      off_(std::move(off)) {}

void SceneChanges::apply(const Json& changes) {
    const auto is_set = [&](std::size_t at) {
        return at < changes.size() && changes[at].is_object() &&
               changes[at].value("op", Json()) == "set";
    };
    for (std::size_t at = 0; at < changes.size(); ++at) {
        apply_one(changes[at]);
        if (!is_set(at) || !is_set(at + 1)) read_again();
    }
}

void SceneChanges::apply_one(const Json& change) {
    using Apply = void (SceneChanges::*)(const Json&);
    static constexpr std::array<std::pair<std::string_view, Apply>, 9> k_changes{
        {{"set", &SceneChanges::set},
         {"add_lamp", &SceneChanges::add_lamp},
         {"remove_lamp", &SceneChanges::remove_lamp},
         {"duplicate_lamp", &SceneChanges::duplicate_lamp},
         {"mirror_lamp", &SceneChanges::mirror_lamp},
         {"rename_lamp", &SceneChanges::rename_lamp},
         {"move_lamp", &SceneChanges::move_lamp},
         {"aim_lamp", &SceneChanges::aim_lamp},
         {"lamp_on", &SceneChanges::turn_lamp_on}}};
    if (!change.is_object()) throw UsageError("changes: expected {\"op\": ...}");
    const std::string op = text_member(change, "op");
    const auto found =
        std::ranges::find(k_changes, op, [](const auto& entry) { return entry.first; });
    if (found == k_changes.end())
        throw UsageError(fmt::format("op: unknown '{}'; {}", printable(op),
                                     suggestion(op, words_of(k_changes))));
    const std::set<std::string> before = texts_of(text_.tree());
    (this->*found->second)(change);
    check_texts(before);
}

// A page may not have the program open files elsewhere than where the scene is. Which keys name
// files is not asked: none can be forgotten.
void SceneChanges::check_texts(const std::set<std::string>& before) const {
    const std::filesystem::path folder = folder_of(file_);
    for (const std::string& text : texts_of(text_.tree()))
        if (!before.contains(text) && leads_elsewhere(folder, text)) refuse_file(text);
}

void SceneChanges::read_again() {
    scene_ = make_edited_scene(text_.text(), text_.tree(), file_, off_, scene_->revision,
                               scene_->scene.choice());
}

std::size_t SceneChanges::lamp_of(const Json& change) const {
    const std::string name = text_member(change, "lamp");
    const auto lamp = scene_->find_lamp(name);
    if (!lamp) throw UsageError(fmt::format("there is no lamp '{}'", printable(name)));
    return *lamp;
}

std::string SceneChanges::entry_of(std::size_t lamp) const {
    const auto entry = scene_->lamps[lamp].entry;
    if (!entry)
        throw UsageError(fmt::format(
            "'{}' {}", this->lamp(lamp).name,
            this->lamp(lamp).emissive_volume
                ? "is the light of a volume; change its emission in the scene file"
            : this->lamp(lamp).sky
                ? "is the light of the sky; change that in the scene file"
                : "comes from a glTF file, which is not written here; change it there"));
    return fmt::format("lamps[{}]", *entry);
}

// The entry of a lamp that can be moved.
std::string SceneChanges::placed_entry_of(std::size_t lamp) const {
    if (this->lamp(lamp).sun)
        throw UsageError(fmt::format("'{}' is a sun, which has no place; set its direction",
                                     this->lamp(lamp).name));
    return entry_of(lamp);
}

std::string SceneChanges::free_name(const std::string& like) const {
    if (!scene_->find_lamp(like)) return like;
    std::string stem = like;
    while (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem.pop_back();
    for (int number = 2;; ++number) {
        std::string name = stem + std::to_string(number);
        if (!scene_->find_lamp(name)) return name;
    }
}

void SceneChanges::set_vector(const std::string& path, const Vector3& value) {
    text_.set(path, numbers_text(std::array{value.x, value.y, value.z}, k_dragged), k_dragged);
}

void SceneChanges::place(std::size_t index, const Point3& world) {
    const Affine frame_from_world =
        lamp(index).world_from_frame(scene_->scene.desc().camera.world_from_camera).inverse();
    set_vector(placed_entry_of(index) + ".position", from_origin(frame_from_world * world));
}

void SceneChanges::set(const Json& change) {
    const std::string path = text_member(change, "path");
    const Json& value = member(change, "value");
    touched_.insert(path);
    if (!value.is_null())
        text_.set(path, value.dump());
    else if (text_.find(path) || !text_.find(path.substr(0, path.rfind('.'))))
        text_.remove(path);  // throws if nothing is there that could have the key
}

void SceneChanges::add_lamp(const Json& change) {
    Json lamp = member(change, "lamp");
    if (!lamp.is_object()) throw UsageError("lamp: expected {\"name\": ...}");
    std::string like;
    if (change.contains("like")) {
        const auto other = scene_->find_lamp(text_member(change, "like"));
        if (other && scene_->lamps[*other].entry) like = entry_of(*other);
    }
    lamp["name"] = free_name(lamp.contains("name") ? text_member(lamp, "name") : "lamp");
    touched_.insert("lamps." + lamp["name"].get<std::string>());
    text_.append("lamps", lamp.dump(), like);
}

void SceneChanges::remove_lamp(const Json& change) {
    const std::size_t index = lamp_of(change);
    touched_.insert("lamps." + lamp(index).name);
    text_.remove(entry_of(index));
    std::erase(off_, lamp(index).name);
}

void SceneChanges::duplicate_lamp(const Json& change) {
    const std::size_t index = lamp_of(change);
    const std::string name =
        free_name(change.contains("name") ? text_member(change, "name") : lamp(index).name);
    touched_.insert("lamps." + name);
    text_.duplicate(entry_of(index), name);
}

void SceneChanges::mirror_lamp(const Json& change) {
    std::size_t index = lamp_of(change);
    placed_entry_of(index);  // refuses a sun
    const LampDesc mirrored =
        mirrored_lamp(lamp(index), scene_->scene.desc().camera.world_from_camera);
    if (flag_member(change, "copy", false)) {
        const std::string name = free_name(mirrored_name(lamp(index).name));
        text_.duplicate(entry_of(index), name);
        read_again();
        index = *scene_->find_lamp(name);
    }
    touched_.insert("lamps." + lamp(index).name);
    set_vector(entry_of(index) + ".position", from_origin(mirrored.position));
    set_vector(entry_of(index) + ".direction", mirrored.direction);
}

void SceneChanges::rename_lamp(const Json& change) {
    const std::size_t index = lamp_of(change);
    const std::string before = lamp(index).name, name = text_member(change, "name");
    touched_.insert("lamps." + before);
    text_.rename(entry_of(index), name);
    std::ranges::replace(off_, before, name);
}

void SceneChanges::move_lamp(const Json& change) {
    const std::size_t index = lamp_of(change);
    touched_.insert("lamps." + lamp(index).name + ".position");
    const Camera& camera = *scene_->camera;
    const Point3 from = placed_lamp(lamp(index), scene_->scene.desc().camera).position;
    if (change.contains("pixel")) {
        const std::string keeps = optional_text_member(change, "keep");
        if (!keeps.empty() && keeps != "distance" && keeps != "z")
            throw UsageError("keep: expected distance or z");
        place(index, dragged_point(camera, pixel_member(change, "pixel"), from,
                                   keeps == "z" ? DragKeeps::depth : DragKeeps::distance));
    } else if (change.contains("distance")) {
        place(index, point_at_distance(camera, from, number_member(change, "distance")));
    } else {
        place(index, at_origin_plus(vector_member(change, "world")));
    }
}

void SceneChanges::aim_lamp(const Json& change) {
    const std::size_t index = lamp_of(change);
    const std::string entry = placed_entry_of(index);
    touched_.insert("lamps." + lamp(index).name + ".direction");
    const CameraDesc& camera = scene_->scene.desc().camera;
    const PlacedLamp placed = placed_lamp(lamp(index), camera);
    Vector3 direction;
    if (change.contains("pixel")) {
        direction = aimed_direction(*scene_->camera, pixel_member(change, "pixel"), placed);
    } else {
        direction = at_origin_plus(vector_member(change, "world")) - placed.position;
        if (!(glm::length(direction) > 0)) throw UsageError("world: the lamp itself is there");
    }
    const Affine frame_from_world =
        lamp(index).world_from_frame(camera.world_from_camera).inverse();
    set_vector(entry + ".direction", glm::normalize(frame_from_world.apply_to_vector(direction)));
}

void SceneChanges::turn_lamp_on(const Json& change) {
    const std::string& name = lamp(lamp_of(change)).name;
    const bool on = flag_member(change, "on", true);
    touched_.insert("lamps." + name + ".on");
    std::erase(off_, name);
    if (!on) off_.push_back(name);
}

}  // namespace uw
