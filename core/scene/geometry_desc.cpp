#include "core/scene/geometry_desc.h"

#include <fmt/format.h>

#include <array>

#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory_reader.h"

namespace uw {

namespace {

constexpr auto k_lengths = "give three lengths in metres";

PerBand read_reflectance(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_hint = "give the fraction of light reflected, from 0 to 1";
    PerBand reflectance;
    for (const ConfigValue& entry : value.per_band(context.band_count, k_hint)) {
        const double rho = entry.non_negative(k_hint);
        if (rho > 1) {
            entry.fail(
                fmt::format("must be from 0 to 1, found {}, which looks like {}; give the "
                            "fraction of light reflected",
                            rho, rho <= 100 ? "percent" : "an 8-bit colour"));
        }
        reflectance.push_back(rho);
    }
    return reflectance;
}

/// `material` of an entry that is of glass.
std::optional<GlassDesc> read_glass(const ConfigValue& value, const SceneContext& context,
                                    GeometryDesc::Type type) {
    const bool is_word = value.node().kind == ConfigNode::Kind::scalar;
    if (is_word && value.node().scalar != "glass") return std::nullopt;
    GlassDesc glass;
    if (!is_word) {
        ConfigMap map(value, {"type", "n", "thin", "thickness", "absorption", "roughness"},
                      "write {type: glass, n: 1.5}");
        constexpr std::array<std::pair<std::string_view, bool>, 1> k_types{{{"glass", true}}};
        map.require("type", "write type: glass").choice(k_types);
        if (const auto n = map.find("n"))
            glass.n = n->within(1, 3, "give the refractive index: 1.5 is glass, 1 is air");
        if (const auto roughness = map.find("roughness");
            roughness && roughness->non_negative("glass is smooth: write 0, or leave it out") > 0)
            roughness->fail("rough glass is not rendered; write 0, or leave it out");
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_booleans{
            {{"false", false}, {"true", true}}};
        if (const auto thin = map.find("thin")) glass.is_thin = thin->choice(k_booleans);
        if (const auto absorption = map.find("absorption")) {
            glass.absorption = absorption->non_negative_per_band(
                context.band_count, "give the absorption coefficient of the glass in 1/m");
        }
        if (const auto thickness = map.find("thickness")) {
            if (!glass.is_thin)
                thickness->fail(
                    "is that of a thin pane; solid glass is as thick as its shape: add thin: true, "
                    "or remove it");
            glass.thickness = thickness->positive("give the thickness of the pane in metres");
        } else if (glass.is_thin && !glass.absorption.empty()) {
            value.fail("thin glass that absorbs needs a thickness; give it in metres");
        }
        map.finish("type 'glass'");
    }
    if (type == GeometryDesc::Type::plane && !glass.is_thin)
        value.fail("a plane encloses no solid glass; add thin: true, or use a box");
    return glass;
}

void read_box(ConfigMap& map, GeometryDesc& object) {
    const ConfigValue low = map.require("min", "give the box's lowest corner in metres");
    const ConfigValue high = map.require("max", "give the box's highest corner in metres");
    object.min = at_origin_plus(low.vector(k_lengths));
    object.max = at_origin_plus(high.vector(k_lengths));
    constexpr std::string_view k_axes = "xyz";
    for (int axis = 0; axis < 3; ++axis) {
        if (object.min[axis] < object.max[axis]) continue;
        high.fail(fmt::format(
            "max must be greater than min on every axis, found {} against {} on {}; swap or "
            "correct them",
            object.max[axis], object.min[axis], k_axes[static_cast<std::size_t>(axis)]));
    }
}

template <class ReadMaterial>
void read_shape(ConfigMap& map, const ConfigValue& type, GeometryDesc& object,
                const ReadMaterial& read_material) {
    using Type = GeometryDesc::Type;
    constexpr std::array<std::pair<std::string_view, Type>, 3> k_types{
        {{"plane", Type::plane}, {"box", Type::box}, {"sphere", Type::sphere}}};
    object.type = type.choice(k_types);
    read_material();
    if (object.type == Type::plane) {
        object.point =
            at_origin_plus(map.require("point", "give a point of the plane").vector(k_lengths));
        object.normal = map.require("normal", "give the plane's normal")
                            .direction("give the plane's normal, of any length except 0");
    } else if (object.type == Type::box) {
        read_box(map, object);
    } else {
        object.center =
            at_origin_plus(map.require("center", "give the sphere's centre").vector(k_lengths));
        object.radius = map.require("radius", "give the sphere's radius in metres")
                            .positive("give the sphere's radius in metres");
    }
    map.finish("type '" + type.node().scalar + "'");
}

std::vector<std::string> read_lamp_names(const ConfigValue& value, bool& all) {
    constexpr auto k_hint = "write all, or a list of the lights' names";
    all = value.node().kind == ConfigNode::Kind::scalar && value.node().scalar == "all";
    std::vector<std::string> names;
    if (all) return names;
    for (const ConfigValue& name : value.list(k_hint)) names.push_back(name.text(k_hint));
    if (names.empty()) value.fail("lists no light; write all, a list of names, or leave it out");
    return names;
}

/// What a file provides besides diffuse meshes.
void read_gltf_keys(ConfigMap& map, GeometryDesc& object) {
    GltfImportDesc& import = object.import;
    const std::string extension = object.file.extension().string();
    const auto check_file = [&](const ConfigValue& value) {
        if (extension == ".gltf" || extension == ".glb") return;
        value.fail(
            fmt::format("only glTF files (.gltf, .glb) provide it, not '{}'; remove it, or export "
                        "the scene as glTF",
                        extension));
    };
    if (const auto camera = map.find("camera")) {
        check_file(*camera);
        import.camera = true;
        import.camera_where = camera->location();
        const ConfigNode& node = camera->node();
        const bool is_true = node.kind == ConfigNode::Kind::scalar && !node.quoted &&
                             (node.scalar == "true" || node.scalar == "True");
        if (!is_true) {
            import.camera_name = camera->text("give the name of a camera in the file, or true");
        }
    }
    const auto lamps = map.find("lamps");
    if (lamps) {
        check_file(*lamps);
        import.lamps_where = lamps->location();
        import.lamps = read_lamp_names(*lamps, import.all_lamps);
    }
    if (const auto units = map.find("light_units")) {
        check_file(*units);
        if (!lamps) units->fail("has an effect only with lamps; add lamps: all, or remove it");
        constexpr std::array<std::pair<std::string_view, LightUnits>, 3> k_units{
            {{"standard", LightUnits::standard},
             {"compat", LightUnits::compat},
             {"raw", LightUnits::raw}}};
        import.units = units->choice(k_units);
    }
    if (const auto material = map.find("material"); material && !object.glass) {
        if (extension != ".obj") check_file(*material);
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_materials{
            {{"diffuse", false}, {"pbr", true}}};
        object.is_pbr = material->choice(k_materials);
        object.is_material_given = true;
    }
}

/// The surface of a level set.
void read_level_set(ConfigMap& map, GeometryDesc& object) {
    LevelSetDesc& level_set = object.level_set.emplace();
    level_set.grid =
        map.require("grid",
                    "name the level set whose surface is meant (uwvdb info FILE lists the "
                    "grids); a fog belongs under volumes")
            .text("name a grid");
    if (const auto entry = map.find("up")) level_set.up = read_up_axis(*entry);
}

GeometryDesc read_object(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"file", "mesh", "transform", "reflectance", "type", "point", "normal", "min",
                   "max", "center", "radius", "camera", "lamps", "light_units", "material",
                   "trajectory", "grid", "up"},
                  "write {file: seabed.glb} or {type: sphere, center: [0, 0, 2], radius: 0.2}");
    GeometryDesc object;
    object.where = value.location();
    if (const auto entry = map.find("reflectance")) {
        object.reflectance = read_reflectance(*entry, context);
    }
    if (const auto entry = map.find("trajectory"))
        object.trajectory = read_trajectory(*entry, context, false);
    const auto read_material = [&] {
        if (!map.has("material")) return;
        const ConfigNode* const node = value.node().find("material");
        const bool is_word = node->kind == ConfigNode::Kind::scalar && node->scalar != "glass";
        // Other materials are those of files (read_gltf_keys).
        if (is_word && object.type == GeometryDesc::Type::file && !map.has("mesh")) return;
        const ConfigValue material = map.require("material", "");
        if (is_word)
            material.fail(
                "the only material of a shape or a mesh in memory is glass; write "
                "material: {type: glass, n: 1.5}, or remove it");
        object.glass = read_glass(material, context, object.type);
        if (object.reflectance)
            material.fail("glass has no reflectance of its own; remove one of the two");
    };
    if (const auto type = map.find("type")) {
        read_shape(map, *type, object, read_material);
        return object;
    }
    if (const auto mesh = map.find("mesh")) {
        object.mesh = read_in_memory(*mesh, context.arrays ? &context.arrays->meshes : nullptr);
        object.mesh_name = mesh->node().scalar;
        read_material();
        if (const auto entry = map.find("transform"))
            object.world_from_object = read_transform(*entry);
        map.finish("a mesh in memory");
        return object;
    }
    object.file = read_existing_file_or_sequence(
        map.require("file", "give a mesh file, or type: plane, box or sphere"), context,
        object.is_sequence);
    if (const auto entry = map.find("transform")) object.world_from_object = read_transform(*entry);
    read_material();
    const std::string extension = object.file.extension().string();
    if (extension == ".vdb" || extension == ".nvdb") {
        read_level_set(map, object);
        map.finish("a VDB file's level set");
        return object;
    }
    read_gltf_keys(map, object);
    map.finish("a mesh file");
    return object;
}

}  // namespace

std::vector<GeometryDesc> read_geometry(const ConfigValue& value, const SceneContext& context) {
    std::vector<GeometryDesc> objects;
    for (const ConfigValue& entry : value.list("write one '- file: ...' or '- type: ...' each")) {
        objects.push_back(read_object(entry, context));
    }
    return objects;
}

}  // namespace uw
