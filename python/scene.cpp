#include "python/scene.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/mesh_reader.h"
#include "core/image/pixel_image.h"
#include "core/scene/key_path.h"
#include "core/scene/scene_desc.h"
#include "core/scene/variations.h"
#include "core/scene/yaml_document.h"
#include "media/volumes/array_grid.h"
#include "python/bindings.h"
#include "python/objects.h"
#include "python/watched_task.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"

namespace py = pybind11;

namespace uw {

namespace {

constexpr std::size_t k_longest_origin = 80;  // as of --set
constexpr std::size_t k_longest_file = 300;

void set_origin(ConfigNode& value, const std::shared_ptr<const std::string>& origin) {
    value.position = {origin, 0, 0};
    for (ConfigNode& item : value.items) set_origin(item, origin);
    for (ConfigNode::Entry& entry : value.entries) {
        entry.position = {origin, 0, 0};
        set_origin(entry.value, origin);
    }
}

/// Its variations, of which `number` is one.
SceneVariations variations_of(const SceneObject& scene, int number) {
    if (number < 0)
        throw UsageError(
            fmt::format("variation: expected a whole number of 0 or more, found {}", number));
    SceneVariations variations(scene.tree(), scene.file());
    if (!variations.desc())
        throw UsageError(
            "variation: the scene has no variations; set them, such as scene[\"variations\"] = "
            "{\"keys\": {\"lamps[0].power\": {\"uniform\": [10, 30]}}}");
    return variations;
}

void refuse_taken(const std::string& section, const std::string& name, const SceneArrays& there) {
    if (there.grids.contains(name) || there.meshes.contains(name))
        throw UsageError(fmt::format(
            "{}.add: there is a '{}' already, added meanwhile; add one after the other, or give "
            "each a name",
            section, printable(name)));
}

}  // namespace

void set_origin(ConfigNode& value, const std::string& origin) {
    set_origin(value, std::make_shared<const std::string>(origin));
}

SceneObject::SceneObject(ConfigNode tree, std::filesystem::path file, SceneArrays arrays)
    : file_(std::move(file)) {
    replace(std::move(tree), std::move(arrays));
}

void SceneObject::replace(ConfigNode tree, SceneArrays arrays) {
    read_variations(tree, file_);
    auto desc = std::make_shared<const SceneDesc>(load_scene_tree(tree, file_, &arrays));
    tree_ = std::move(tree);
    arrays_ = std::move(arrays);
    desc_ = std::move(desc);
}

void SceneObject::set(const Changes& changes) {
    ConfigNode tree = tree_;
    for (const auto& [path, value] : changes) {
        const std::string origin =
            printable(fmt::format("{} = {}", path, flow_text(value)), k_longest_origin);
        ConfigNode placed = value;
        set_origin(placed, origin);
        set_value(tree, path, std::move(placed), origin);
    }
    replace(std::move(tree), arrays_);
}

bool SceneObject::remove(const std::string& path) {
    ConfigNode tree = tree_;
    if (!remove_value(tree, path)) return false;
    replace(std::move(tree), arrays_);
    return true;
}

void SceneObject::append(const std::string& section, ConfigNode entry, SceneArrays arrays) {
    for (const auto& [name, grid] : arrays.grids) refuse_taken(section, name, arrays_);
    for (const auto& [name, mesh] : arrays.meshes) refuse_taken(section, name, arrays_);
    ConfigNode tree = tree_;
    ConfigNode* list = tree.find(section);
    if (list == nullptr) {
        tree.entries.push_back({section, entry.position, {}});
        list = &tree.entries.back().value;
        list->position = entry.position;
    }
    list->kind = ConfigNode::Kind::sequence;
    list->items.push_back(std::move(entry));
    SceneArrays all = arrays_;
    for (auto& grid : arrays.grids) all.grids.insert(std::move(grid));
    for (auto& mesh : arrays.meshes) all.meshes.insert(std::move(mesh));
    replace(std::move(tree), std::move(all));
}

void SceneObject::set_grid(const std::string& name, std::shared_ptr<const LoadedGrid> grid) {
    SceneArrays arrays = arrays_;
    arrays.grids.at(name) = std::move(grid);
    replace(tree_, std::move(arrays));
}

void SceneObject::set_mesh(const std::string& name, std::shared_ptr<const TriangleMesh> mesh) {
    SceneArrays arrays = arrays_;
    arrays.meshes.at(name) = std::move(mesh);
    replace(tree_, std::move(arrays));
}

SceneObject SceneObject::variation(int number) const {
    VariedScene varied = variations_of(*this, number).varied(number, &arrays_);
    SceneObject scene;
    scene.tree_ = std::move(varied.tree);
    scene.file_ = file_;
    scene.arrays_ = arrays_;
    scene.desc_ = std::make_shared<const SceneDesc>(std::move(varied.desc));
    return scene;
}

SceneObject::Changes SceneObject::variation_values(int number) const {
    Changes values;
    for (const DrawnValue& value : variations_of(*this, number).values(number))
        values.emplace_back(value.key, parse_yaml_value(value.text, value.override_text()));
    return values;
}

namespace {

using ScenePointer = std::unique_ptr<SceneObject>;

py::dict variation_values(const SceneObject& scene, int number) {
    py::dict values;
    for (const auto& [path, value] : scene.variation_values(number))
        values[py::str(path)] = object_of(value);
    return values;
}

ScenePointer load(const FileName& name) {
    const std::filesystem::path& file = name;
    return std::make_unique<SceneObject>(read_scene_tree(file, {}), file);
}

ScenePointer parse(const Text& text, const FileName& file) {
    return std::make_unique<SceneObject>(scene_tree(text.value, file), file);
}

ScenePointer of_sections(const py::dict& sections, const FileName& name) {
    const std::filesystem::path& file = name;
    const std::string origin = printable(file.string(), k_longest_file);
    ConfigNode tree = node_of(sections, origin);
    set_origin(tree, origin);
    return std::make_unique<SceneObject>(std::move(tree), file);
}

void set(SceneObject& scene, const py::dict& changes) {
    SceneObject::Changes nodes;
    for (const auto& [path, value] : changes) {
        if (!py::isinstance<py::str>(path))
            throw py::type_error("paths of a scene are str, found " +
                                 py::repr(path).cast<std::string>());
        auto name = text_of(path);
        ConfigNode node = node_of(value, printable(name, k_longest_origin) + " = ...", name);
        nodes.emplace_back(std::move(name), std::move(node));
    }
    scene.set(nodes);
}

py::object get(const SceneObject& scene, const Text& wanted) {
    const std::string& path = wanted;
    const ConfigNode* const node = path.empty() ? &scene.tree() : find_value(scene.tree(), path);
    if (node == nullptr) throw py::key_error(path + ": is not in the scene");
    return object_of(*node);
}

ArrayView view_of(const FloatArray& array) {
    ArrayView view{array.data(), {}, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.size[axis] = static_cast<std::size_t>(array.shape(static_cast<py::ssize_t>(axis)));
        view.steps[axis] = array.strides(static_cast<py::ssize_t>(axis)) /
                           static_cast<std::ptrdiff_t>(sizeof(float));
    }
    return view;
}

std::shared_ptr<const LoadedGrid> grid_of(const FloatArray& array, const Affine& place,
                                          const std::string& name, const std::string& where) {
    std::shared_ptr<const LoadedGrid> grid;
    WatchedTask task;
    run_interruptible(task, [&] {
        grid =
            std::make_shared<const LoadedGrid>(grid_of_array(view_of(array), place, name, where));
    });
    return grid;
}

void add_volume(SceneObject& scene, const Text& name, const FloatArray& array,
                const DoubleRows& place, const py::dict& entry, const Text& where) {
    ConfigNode node = node_of(entry, where);
    set_origin(node, where);
    SceneArrays arrays;
    arrays.grids[name.value] = grid_of(array, affine_of(place), name, where);
    scene.append("volumes", std::move(node), std::move(arrays));
}

void set_array(SceneObject& scene, const Text& wanted, const FloatArray& array,
               const Text& caller) {
    const std::string &name = wanted, &where = caller;
    const auto found = scene.arrays().grids.find(name);
    if (found == scene.arrays().grids.end())
        throw UsageError(fmt::format("{}: the scene has no array '{}'", where, printable(name)));
    const LoadedGrid& before = *found->second;
    if (view_of(array).size != before.size)
        throw UsageError(fmt::format("{}: expected an array of shape ({}, {}, {}), as before",
                                     where, before.size[0], before.size[1], before.size[2]));
    scene.set_grid(name, grid_of(array, before.file_from_index, name, where));
}

using Corners = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Linear red, green and blue in rows.
using TextureArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

PixelImage pixels_of(const TextureArray& rgb) {
    return {static_cast<int>(rgb.shape(1)),
            static_cast<int>(rgb.shape(0)),
            3,
            {rgb.data(), rgb.data() + rgb.size()},
            true};
}

// `uvs` and `texture`: both, or neither.
void add_mesh(SceneObject& scene, const Text& name, const DoubleRows& vertices,
              const Corners& faces, const std::optional<DoubleRows>& uvs,
              const std::optional<TextureArray>& texture, const py::dict& entry,
              const Text& caller) {
    const std::string& where = caller;
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions.assign(vertices.data(), vertices.data() + vertices.size());
    if (uvs && texture) {
        mesh->uvs[0].assign(uvs->data(), uvs->data() + uvs->size());
        mesh->materials = {textured_material(pixels_of(*texture))};
    }
    // An index beyond the vertices, or negative, becomes one that no vertex has: it is counted as
    // missing.
    const auto count = static_cast<std::int64_t>(mesh->vertex_count());
    for (py::ssize_t i = 0; i < faces.size(); ++i) {
        const std::int64_t corner = faces.data()[i];
        mesh->triangles.push_back(
            static_cast<std::uint32_t>(corner < 0 || corner >= count ? count : corner));
    }
    DroppedTriangles dropped;
    drop_bad_triangles(*mesh, dropped);
    if (dropped.missing_corner > 0)
        throw InputError(where + ": " + std::to_string(dropped.missing_corner) +
                         " faces have a corner that is no vertex; count vertices from 0");
    if (mesh->triangles.empty())
        throw InputError(where + ": no face has an area; give triangles of three vertices each");
    ConfigNode node = node_of(entry, where);
    set_origin(node, where);
    SceneArrays arrays;
    arrays.meshes[name.value] = std::move(mesh);
    scene.append("geometry", std::move(node), std::move(arrays));
}

void set_texture(SceneObject& scene, const Text& wanted, const TextureArray& texture,
                 const Text& caller) {
    const std::string &name = wanted, &where = caller;
    const auto found = scene.arrays().meshes.find(name);
    if (found == scene.arrays().meshes.end() || !found->second->materials.front().base_map)
        throw UsageError(
            fmt::format("{}: the scene has no mesh '{}' with a texture", where, printable(name)));
    auto mesh = std::make_shared<TriangleMesh>(*found->second);
    mesh->materials = {textured_material(pixels_of(texture))};
    scene.set_mesh(name, std::move(mesh));
}

py::tuple state(const SceneObject& scene) {
    py::dict grids, meshes;
    for (const auto& [name, grid] : scene.arrays().grids) grids[py::str(name)] = state_of(*grid);
    for (const auto& [name, mesh] : scene.arrays().meshes) meshes[py::str(name)] = state_of(*mesh);
    return py::make_tuple(scene.file().string(), state_of(scene.tree()), grids, meshes);
}

ScenePointer of_state(const py::tuple& state) {
    SceneArrays arrays;
    for (const auto& [name, grid] : state[2].cast<py::dict>())
        arrays.grids[name.cast<std::string>()] = grid_of_state(grid.cast<py::tuple>());
    for (const auto& [name, mesh] : state[3].cast<py::dict>())
        arrays.meshes[name.cast<std::string>()] = mesh_of_state(mesh.cast<py::tuple>());
    return std::make_unique<SceneObject>(node_of_state(state[1].cast<py::tuple>()),
                                         state[0].cast<std::string>(), std::move(arrays));
}

std::vector<std::string> lamp_names(const SceneObject& scene) {
    std::vector<std::string> names;
    for (const LampDesc& lamp : scene.desc()->lamps) names.push_back(lamp.name);
    return names;
}

std::vector<std::string> camera_names(const SceneObject& scene) {
    std::vector<std::string> names;
    for (const RigCameraDesc& entry : scene.desc()->cameras) names.push_back(entry.name);
    return names;
}

std::vector<std::string> array_names(const SceneObject& scene) {
    std::vector<std::string> names;
    for (const auto& [name, grid] : scene.arrays().grids) names.push_back(name);
    for (const auto& [name, mesh] : scene.arrays().meshes) names.push_back(name);
    return names;
}

py::object frames(const SceneObject& scene) {
    const auto range = frames_of(*scene.desc());
    if (!range) return py::none();
    return py::make_tuple(range->first, range->last);
}

}  // namespace

void bind_scene(py::module_& module) {
    module.def(
        "require_memory",
        [](double bytes, const Text& what, const Text& hint) {
            require_memory(bytes, what.value, hint.value);
        },
        py::arg("bytes"), py::arg("what"), py::arg("mend"));
    py::class_<SceneObject>(module, "Scene")
        .def_static("load", load, py::arg("file"))
        .def_static("parse", parse, py::arg("text"), py::arg("file"))
        .def_static("of_sections", of_sections, py::arg("sections"), py::arg("file"))
        .def("set", set, py::arg("changes"))
        .def("get", get, py::arg("path"))
        .def("has",
             [](const SceneObject& scene, const Text& path) {
                 return find_value(scene.tree(), path.value) != nullptr;
             })
        .def(
            "remove", [](SceneObject& scene, const Text& path) { return scene.remove(path); },
            py::arg("path"))
        .def("add_volume", add_volume)
        .def("set_array", set_array)
        .def("add_mesh", add_mesh)
        .def("set_texture", set_texture)
        .def(
            "variation",
            [](const SceneObject& scene, int number) {
                return std::make_unique<SceneObject>(scene.variation(number));
            },
            py::arg("number"))
        .def("variation_values", variation_values, py::arg("number"))
        .def("copy", [](const SceneObject& scene) { return std::make_unique<SceneObject>(scene); })
        .def_property_readonly("file", &SceneObject::file)
        .def_property_readonly("lamps", lamp_names)
        .def_property_readonly("cameras", camera_names)
        .def_property_readonly("arrays", array_names)
        .def_property_readonly("frames", frames)
        .def_property_readonly("bands",
                               [](const SceneObject& s) { return s.desc()->water.bands_nm; })
        .def_property_readonly("hash", [](const SceneObject& s) { return s.desc()->hash; })
        .def_property_readonly("warnings", [](const SceneObject& s) { return s.desc()->warnings; })
        .def(py::pickle([](const SceneObject& scene) { return state(scene); },
                        [](const py::tuple& saved) { return of_state(saved); }));
}

}  // namespace uw
