#include "python/objects.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "python/arguments.h"

namespace py = pybind11;

namespace uw {

namespace {

constexpr std::size_t k_nano_alignment = 32;  // of NanoVDB's grids in memory

template <class T>
py::bytes bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> values_of(const py::handle& object) {
    const auto bytes = object.cast<std::string_view>();
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

py::tuple state_of(const NanoGrid& brick) {
    const Bounds& support = brick.support();
    py::list box;
    for (const Point3& corner : {support.min, support.max})
        for (int axis = 0; axis < 3; ++axis) box.append(corner[axis]);
    return py::make_tuple(py::bytes(static_cast<const char*>(brick.data()), brick.bytes()), box);
}

NanoGrid brick_of_state(const py::tuple& state) {
    const auto bytes = state[0].cast<std::string_view>();
    const auto box = state[1].cast<std::array<double, 6>>();
    void* const memory = ::operator new (bytes.size(), std::align_val_t{k_nano_alignment});
    std::memcpy(memory, bytes.data(), bytes.size());
    std::shared_ptr<const void> storage(
        memory, [](void* owned) { ::operator delete (owned, std::align_val_t{k_nano_alignment}); });
    // The support reaches one beyond the values, which NanoGrid adds.
    std::array<int, 3> min{}, max{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        min[axis] = static_cast<int>(std::lround(box[axis])) + 1;
        max[axis] = static_cast<int>(std::lround(box[axis + 3])) - 1;
    }
    return {std::move(storage), memory, bytes.size(), min, max};
}

}  // namespace

py::array_t<double> matrix_of(const Affine& map) {
    py::array_t<double> matrix({4, 4});
    auto cell = matrix.mutable_unchecked<2>();
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column)
            cell(row, column) = row < 3 ? map.linear()[column][row] : 0;
        cell(row, 3) = row < 3 ? map.offset()[row] : 1;
    }
    return matrix;
}

Affine affine_of(const DoubleRows& matrix) {
    const auto cell = matrix.unchecked<2>();
    Matrix3 linear(1.0);
    Vector3 offset(0.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) linear[column][row] = cell(row, column);
        offset[row] = cell(row, 3);
    }
    return {linear, offset};
}

py::object state_of(const LoadedGrid& grid) {
    py::list bricks;
    for (const NanoGrid& brick : grid.bricks) bricks.append(state_of(brick));
    const GridStatistics& s = grid.statistics;
    return py::make_tuple(
        grid.name, matrix_of(grid.file_from_index), bricks,
        py::make_tuple(s.active_voxels, s.nan_voxels, s.infinite_voxels, s.negative_voxels),
        py::make_tuple(s.background, s.min, s.mean, s.max), grid.warnings, grid.size);
}

std::shared_ptr<const LoadedGrid> grid_of_state(const py::tuple& state) {
    auto grid = std::make_shared<LoadedGrid>();
    grid->name = state[0].cast<std::string>();
    grid->file_from_index = affine_of(state[1].cast<DoubleRows>());
    for (const py::handle brick : state[2])
        grid->bricks.push_back(brick_of_state(brick.cast<py::tuple>()));
    const auto counts = state[3].cast<std::array<std::int64_t, 4>>();
    const auto values = state[4].cast<std::array<double, 4>>();
    grid->statistics = {counts[0], counts[1], counts[2], counts[3],
                        values[0], values[1], values[2], values[3]};
    grid->warnings = state[5].cast<std::vector<std::string>>();
    grid->size = state[6].cast<std::array<std::size_t, 3>>();
    return grid;
}

MeshMaterial textured_material(const PixelImage& image) {
    MeshMaterial material;
    material.base_color = {1, 1, 1};
    material.base_map.texture = std::make_shared<const Texture>(image, TextureEncoding::linear);
    material.base_map.lookup.wrap_u = material.base_map.lookup.wrap_v = TextureWrap::clamp;
    return material;
}

py::object state_of(const TriangleMesh& mesh) {
    py::object texture = py::none();
    if (const TextureUse& map = mesh.materials.front().base_map) {
        const std::span<const float> rgb = map.texture->rgb();
        texture = py::make_tuple(map.texture->width(), map.texture->height(),
                                 bytes_of(std::vector<float>(rgb.begin(), rgb.end())));
    }
    return py::make_tuple(bytes_of(mesh.positions), bytes_of(mesh.triangles), bytes_of(mesh.uvs[0]),
                          texture);
}

std::shared_ptr<const TriangleMesh> mesh_of_state(const py::tuple& state) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = values_of<float>(state[0]);
    mesh->triangles = values_of<std::uint32_t>(state[1]);
    mesh->uvs[0] = values_of<float>(state[2]);
    if (!state[3].is_none()) {
        const auto texture = state[3].cast<py::tuple>();
        mesh->materials = {textured_material({texture[0].cast<int>(), texture[1].cast<int>(), 3,
                                              values_of<float>(texture[2]), true})};
    }
    return mesh;
}

namespace {

using Kind = ConfigNode::Kind;

ConfigNode scalar(std::string text, bool quoted) {
    ConfigNode node;
    node.kind = Kind::scalar;
    node.quoted = quoted;
    node.scalar = std::move(text);
    return node;
}

std::string path_text(const py::object& path) {
    return py::isinstance<py::str>(path) ? text_of(path) : path.cast<std::string>();
}

ConfigNode number(const py::object& value) {
    return scalar(py::repr(value).cast<std::string>(), false);
}

bool is_whole(const std::string& text) {
    const std::size_t first = text.find_first_not_of("+-");
    return first != std::string::npos &&
           text.find_first_not_of("0123456789", first) == std::string::npos;
}

py::object number_of(const std::string& text, double value) {
    if (is_whole(text) && std::abs(value) < 1e15) return py::int_(static_cast<long long>(value));
    return py::float_(value);
}

py::tuple state_of(const ConfigPosition& position) {
    return py::make_tuple(position.origin ? *position.origin : "", position.line, position.column);
}

/// Positions of a scene have few origins, which they share.
using Origins = std::map<std::string, std::shared_ptr<const std::string>>;

ConfigPosition position_of(const py::tuple& state, Origins& origins) {
    auto text = state[0].cast<std::string>();
    auto& origin = origins[text];
    if (!origin) origin = std::make_shared<const std::string>(std::move(text));
    return {origin, state[1].cast<int>(), state[2].cast<int>()};
}

ConfigNode node_with_origins(const py::tuple& state, Origins& origins) {
    ConfigNode node;
    node.kind = static_cast<Kind>(state[0].cast<int>());
    node.quoted = state[1].cast<bool>();
    node.scalar = state[2].cast<std::string>();
    for (const py::handle item : state[3])
        node.items.push_back(node_with_origins(item.cast<py::tuple>(), origins));
    for (const py::handle handle : state[4]) {
        const auto entry = handle.cast<py::tuple>();
        node.entries.push_back({entry[0].cast<std::string>(),
                                position_of(entry[1].cast<py::tuple>(), origins),
                                node_with_origins(entry[2].cast<py::tuple>(), origins)});
    }
    node.position = position_of(state[5].cast<py::tuple>(), origins);
    return node;
}

constexpr std::size_t k_longest_path = 60;  // in messages

/// Makes nodes of objects. Objects may contain themselves, and iterators may never end.
class NodeMaker {
  public:
    NodeMaker(std::string where, std::string path)
        : where_(std::move(where)), path_(std::move(path)) {}

    ConfigNode make(py::handle object) {
        expect(1);
        ++nodes_;
        if (object.is_none()) return {};
        if (py::isinstance<py::bool_>(object))
            return scalar(object.cast<bool>() ? "true" : "false", false);
        if (py::isinstance<py::str>(object)) return scalar(text_of(object), true);
        // For types that are not Python's own, such as NumPy's float64, repr() names the type, too.
        if (py::isinstance<py::int_>(object))
            return number(py::reinterpret_steal<py::object>(PyNumber_Long(object.ptr())));
        if (py::isinstance<py::float_>(object)) return number(py::float_(object.cast<double>()));
        const bool is_dict = py::isinstance<py::dict>(object);
        if (!is_dict && py::hasattr(object, "__fspath__"))
            return scalar(path_text(object.attr("__fspath__")()), true);
        if (depth_ >= limits_.depth)
            refuse(
                fmt::format("nested more than {} levels deep; give lists and dicts that do not "
                            "contain themselves",
                            limits_.depth));
        ++depth_;
        ConfigNode node =
            is_dict ? map_of(py::reinterpret_borrow<py::dict>(object)) : sequence_of(object);
        --depth_;
        return node;
    }

  private:
    ConfigNode map_of(const py::dict& dict) {
        ConfigNode node;
        node.kind = Kind::map;
        for (const auto& [key, value] : dict) {
            if (!py::isinstance<py::str>(key))
                throw py::type_error("keys of a scene are str, found " +
                                     py::repr(key).cast<std::string>());
            auto name = text_of(key);
            ConfigNode made = make_at((path_.empty() ? "" : ".") + name, value);
            node.entries.push_back({std::move(name), {}, std::move(made)});
        }
        return node;
    }

    ConfigNode sequence_of(py::handle object) {
        if (py::isinstance<py::array>(object))
            expect(static_cast<std::size_t>(object.cast<py::array>().size()));
        if (py::hasattr(object, "tolist")) return make(object.attr("tolist")());
        if (!py::hasattr(object, "__iter__"))
            throw py::type_error("a scene has numbers, text, lists and dicts, not " +
                                 py::repr(py::type::handle_of(object)).cast<std::string>());
        ConfigNode node;
        node.kind = Kind::sequence;
        for (const py::handle item : py::iter(object))
            node.items.push_back(make_at(fmt::format("[{}]", node.items.size()), item));
        return node;
    }

    void expect(std::size_t more) const {
        if (more > limits_.nodes - nodes_)
            refuse(fmt::format("more than {} values; use fewer, or a file", limits_.nodes));
    }

    ConfigNode make_at(const std::string& step, py::handle object) {
        const std::size_t length = path_.size();
        path_ += step;
        ConfigNode node = make(object);
        path_.resize(length);
        return node;
    }

    [[noreturn]] void refuse(const std::string& what) const {
        const std::string path = printable(path_, k_longest_path);
        throw InputError(fmt::format("{}: {}{}{}", where_, path, path.empty() ? "" : ": ", what));
    }

    YamlLimits limits_;
    std::string where_, path_;
    std::size_t depth_ = 0, nodes_ = 0;
};

}  // namespace

ConfigNode node_of(py::handle object, const std::string& where, const std::string& path) {
    return NodeMaker(where, path).make(object);
}

py::object object_of(const ConfigNode& node) {
    switch (node.kind) {
        case Kind::null:
            return py::none();
        case Kind::sequence: {
            py::list list;
            for (const ConfigNode& item : node.items) list.append(object_of(item));
            return list;
        }
        case Kind::map: {
            py::dict dict;
            for (const ConfigNode::Entry& entry : node.entries)
                dict[py::str(entry.key)] = object_of(entry.value);
            return dict;
        }
        case Kind::scalar:
            break;
    }
    double value = 0;
    if (!node.quoted) {
        if (parse_number(node.scalar, value) == NumberText::number)
            return number_of(node.scalar, value);
        if (node.scalar == "true" || node.scalar == "True") return py::bool_(true);
        if (node.scalar == "false" || node.scalar == "False") return py::bool_(false);
    }
    return py::str(node.scalar);
}

py::object state_of(const ConfigNode& node) {
    py::list items, entries;
    for (const ConfigNode& item : node.items) items.append(state_of(item));
    for (const ConfigNode::Entry& entry : node.entries)
        entries.append(py::make_tuple(entry.key, state_of(entry.position), state_of(entry.value)));
    return py::make_tuple(static_cast<int>(node.kind), node.quoted, node.scalar, items, entries,
                          state_of(node.position));
}

ConfigNode node_of_state(const py::tuple& state) {
    Origins origins;
    return node_with_origins(state, origins);
}

}  // namespace uw
