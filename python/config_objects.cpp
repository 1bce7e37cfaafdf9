#include "python/config_objects.h"

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/base/text.h"

namespace py = pybind11;

namespace uw {

namespace {

using Kind = ConfigNode::Kind;

ConfigNode scalar(std::string text, bool quoted) {
    ConfigNode node;
    node.kind = Kind::scalar;
    node.quoted = quoted;
    node.scalar = std::move(text);
    return node;
}

ConfigNode number(const py::object& value) {
    return scalar(py::repr(value).cast<std::string>(), false);
}

ConfigNode map_of(const py::dict& dict) {
    ConfigNode node;
    node.kind = Kind::map;
    for (const auto& [key, value] : dict) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error("keys of a scene are str, found " +
                                 py::repr(key).cast<std::string>());
        node.entries.push_back({key.cast<std::string>(), {}, node_of(value)});
    }
    return node;
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

ConfigNode node_of_state(const py::tuple& state, Origins& origins) {
    ConfigNode node;
    node.kind = static_cast<Kind>(state[0].cast<int>());
    node.quoted = state[1].cast<bool>();
    node.scalar = state[2].cast<std::string>();
    for (const py::handle item : state[3])
        node.items.push_back(node_of_state(item.cast<py::tuple>(), origins));
    for (const py::handle handle : state[4]) {
        const auto entry = handle.cast<py::tuple>();
        node.entries.push_back({entry[0].cast<std::string>(),
                                position_of(entry[1].cast<py::tuple>(), origins),
                                node_of_state(entry[2].cast<py::tuple>(), origins)});
    }
    node.position = position_of(state[5].cast<py::tuple>(), origins);
    return node;
}

}  // namespace

ConfigNode node_of(py::handle object) {
    if (object.is_none()) return {};
    if (py::isinstance<py::bool_>(object))
        return scalar(object.cast<bool>() ? "true" : "false", false);
    if (py::isinstance<py::str>(object)) return scalar(object.cast<std::string>(), true);
    // Of other types than Python's own, as NumPy's float64, repr() names the type, too.
    if (py::isinstance<py::int_>(object))
        return number(py::reinterpret_steal<py::object>(PyNumber_Long(object.ptr())));
    if (py::isinstance<py::float_>(object)) return number(py::float_(object.cast<double>()));
    if (py::isinstance<py::dict>(object)) return map_of(py::reinterpret_borrow<py::dict>(object));
    if (py::hasattr(object, "tolist")) return node_of(object.attr("tolist")());
    if (py::hasattr(object, "__fspath__"))
        return scalar(object.attr("__fspath__")().cast<std::string>(), true);
    if (!py::hasattr(object, "__iter__"))
        throw py::type_error("a scene has numbers, text, lists and dicts, not " +
                             py::repr(py::type::handle_of(object)).cast<std::string>());
    ConfigNode node;
    node.kind = Kind::sequence;
    for (const py::handle item : py::iter(object)) node.items.push_back(node_of(item));
    return node;
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
    return node_of_state(state, origins);
}

}  // namespace uw
