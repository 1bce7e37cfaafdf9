#include <pybind11/stl.h>

#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/scene/scene_desc.h"
#include "media/water/water_model.h"
#include "python/arguments.h"
#include "python/bindings.h"
#include "python/objects.h"
#include "python/scene.h"

namespace py = pybind11;

namespace uw {

namespace {

/// The optical properties of a scene's water, and what it was made of.
struct WaterObject {
    WaterModel model;
    ConfigNode tree;                                // with its section `water` alone
    std::shared_ptr<const SceneObject> scene = {};  // instead of it
};

}  // namespace

}  // namespace uw

UWVDB_BOUND_CLASS(uw::WaterObject);

namespace uw {

namespace {

WaterObject of_tree(ConfigNode tree) {
    WaterModel model = build_water_model(water_of_tree(tree), {});
    return {std::move(model), std::move(tree)};
}

WaterObject of_section(const py::dict& section) {
    constexpr const char* k_origin = "Water";
    py::dict root;
    root["water"] = section;
    ConfigNode tree = node_of(root, k_origin);
    set_origin(tree, k_origin);
    return of_tree(std::move(tree));
}

WaterObject of_scene(const SceneObject& scene) {
    return {build_water_model(scene.desc()->water, scene.desc()->volumes),
            {},
            std::make_shared<const SceneObject>(scene)};
}

py::tuple water_state(const WaterObject& water) {
    if (!water.scene) return py::make_tuple(state_of(water.tree));
    return py::make_tuple(py::none(), std::make_unique<SceneObject>(*water.scene));
}

WaterObject water_of_state(const py::tuple& state) {
    if (state[0].is_none()) return of_scene(state[1].cast<const SceneObject&>());
    return of_tree(node_of_state(state[0].cast<py::tuple>()));
}

py::array_t<double> per_band(const WaterObject& water, const Spectrum& values) {
    py::array_t<double> array(water.model.medium.band_count());
    for (py::ssize_t band = 0; band < array.size(); ++band)
        array.mutable_at(band) = values[static_cast<std::size_t>(band)];
    return array;
}

const OpticalCoefficients& uniform(const WaterObject& water) {
    return water.model.medium.uniform;
}

/// The volume scattering function [1/(m sr)] by band and angle [degrees].
py::array_t<double> scattering_function(const WaterObject& water, const DoubleRows& angles) {
    const Medium& medium = water.model.medium;
    std::vector<double> psi(static_cast<std::size_t>(angles.size()));
    for (std::size_t i = 0; i < psi.size(); ++i) psi[i] = angles.data()[i] * std::numbers::pi / 180;
    py::array_t<double> result({py::ssize_t{medium.band_count()}, angles.size()});
    auto cell = result.mutable_unchecked<2>();
    for (py::ssize_t band = 0; band < result.shape(0); ++band)
        for (py::ssize_t i = 0; i < result.shape(1); ++i) cell(band, i) = 0;
    std::vector<double> p(psi.size());
    for (std::size_t m = 0; m < medium.phase_functions.size(); ++m) {
        medium.phase_functions[m]->eval(psi, p);
        for (py::ssize_t band = 0; band < result.shape(0); ++band)
            for (std::size_t i = 0; i < p.size(); ++i)
                cell(band, static_cast<py::ssize_t>(i)) +=
                    medium.uniform.scattering[m][static_cast<std::size_t>(band)] * p[i];
    }
    return result;
}

py::list constituents(const WaterObject& water) {
    py::list list;
    for (const Constituent& constituent : water.model.medium.constituents) {
        py::dict entry;
        entry["name"] = constituent.name;
        entry["unit"] = constituent.unit;
        entry["absorption"] = per_band(water, constituent.per_unit.absorption);
        entry["scattering"] = per_band(water, constituent.per_unit.total_scattering());
        list.append(entry);
    }
    return list;
}

}  // namespace

void bind_water(py::module_& module) {
    py::class_<WaterObject>(module, "Water")
        .def_static("of_section", of_section, py::arg("section"))
        .def_static("of_scene", of_scene, py::arg("scene"))
        .def_property_readonly("bands",
                               [](const WaterObject& w) { return w.model.medium.wavelengths_nm; })
        .def_property_readonly(
            "absorption", [](const WaterObject& w) { return per_band(w, uniform(w).absorption); })
        .def_property_readonly(
            "scattering",
            [](const WaterObject& w) { return per_band(w, uniform(w).total_scattering()); })
        .def("scattering_function", scattering_function, py::arg("angles"))
        .def_property_readonly("constituents", constituents)
        .def_property_readonly("phase_functions",
                               [](const WaterObject& w) {
                                   std::vector<std::string> names;
                                   for (const auto& phase : w.model.medium.phase_functions)
                                       names.push_back(phase->description());
                                   return names;
                               })
        .def_property_readonly("warnings", [](const WaterObject& w) { return w.model.warnings; })
        .def(py::pickle([](const WaterObject& water) { return water_state(water); },
                        [](const py::tuple& saved) { return water_of_state(saved); }));
}

}  // namespace uw
