#include "core/scene/volume_desc.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory_reader.h"
#include "core/scene/water_desc.h"

namespace uw {

namespace {

constexpr auto k_grids_example = "write {density: {small: 2, large: 10}}";

bool all_zero(const PerBand& values) {
    for (const double value : values) {
        if (value != 0) return false;
    }
    return true;
}

GridMappingDesc read_mapping(const ConfigValue& value, const std::string& grid,
                             const SceneContext& context) {
    static const std::vector<SpeciesDesc> k_none;
    const std::vector<SpeciesDesc>& species = context.species ? *context.species : k_none;
    std::vector<std::string_view> keys{"small", "large", "absorption", "scattering", "phase"};
    std::ranges::copy(names_of(species), std::back_inserter(keys));
    ConfigMap map(value, std::move(keys),
                  "write {small: 2, large: 10} in ppm per unit of grid value");
    GridMappingDesc mapping;
    mapping.grid = grid;
    mapping.where = value.location();
    if (map.has("absorption") || map.has("scattering")) {
        GridMappingDesc::Optics optics{PerBand(context.band_count, 0.0),
                                       PerBand(context.band_count, 0.0), std::nullopt};
        constexpr auto k_hint = "give coefficients in 1/m per unit of grid value";
        if (const auto entry = map.find("absorption")) {
            optics.absorption = entry->non_negative_per_band(context.band_count, k_hint);
        }
        if (const auto entry = map.find("scattering")) {
            optics.scattering = entry->non_negative_per_band(context.band_count, k_hint);
        }
        if (const auto entry = map.find("phase")) optics.phase = read_phase(*entry, context);
        map.finish("a grid with 'absorption' or 'scattering'");
        if (all_zero(optics.absorption) && all_zero(optics.scattering)) {
            context.warn(value, "all coefficients are 0: this grid will not be seen");
        }
        mapping.optics = std::move(optics);
        return mapping;
    }
    mapping.amounts = read_amounts(map, species);
    if (!map.has("small") && !map.has("large") && mapping.amounts.empty()) {
        value.fail(
            "does not say what the grid means; give small and large in ppm per unit of grid value, "
            "one of water.species, or absorption and scattering in 1/m");
    }
    constexpr auto k_hint = "give ppm per unit of grid value";
    if (const auto entry = map.find("small")) mapping.small_ppm = entry->non_negative(k_hint);
    if (const auto entry = map.find("large")) mapping.large_ppm = entry->non_negative(k_hint);
    map.finish("a grid given in ppm");
    const bool has_species = std::ranges::any_of(
        mapping.amounts, [](const SpeciesAmount& amount) { return amount.amount > 0; });
    if (mapping.small_ppm == 0 && mapping.large_ppm == 0 && !has_species) {
        context.warn(value, "all concentrations are 0: this grid will not be seen");
    }
    return mapping;
}

std::vector<GridMappingDesc> read_grids(const ConfigValue& value, const SceneContext& context) {
    const ConfigNode& node = value.node();
    if (node.kind != ConfigNode::Kind::map || node.entries.empty()) {
        value.fail("expected grid names with their meanings, found " + node.description() + "; " +
                   k_grids_example);
    }
    std::vector<GridMappingDesc> grids;
    grids.reserve(node.entries.size());
    for (const ConfigNode::Entry& entry : node.entries) {
        const ConfigValue mapping(entry.value, value.path() + "." + printable(entry.key));
        grids.push_back(read_mapping(mapping, entry.key, context));
    }
    return grids;
}

EmissionDesc::Blackbody read_blackbody(ConfigMap& map) {
    EmissionDesc::Blackbody blackbody;
    if (const auto entry = map.find("kelvin"))
        blackbody.kelvin = entry->positive("give the kelvins that one unit of the grid stands for");
    if (const auto entry = map.find("offset"))
        blackbody.offset = entry->number("give the temperature at the value 0 in kelvins");
    return blackbody;
}

constexpr auto k_table_example = "write [[0.1, [0, 0, 0]], [1, [4, 1.5, 0.3]]]";

/// Rows of a value of the grid and the light there, one number per band.
void read_table(const ConfigValue& value, EmissionDesc& emission, const SceneContext& context) {
    constexpr std::size_t k_max_rows = 4096;
    const std::vector<ConfigValue> rows = value.list(k_table_example);
    if (rows.size() < 2 || rows.size() > k_max_rows)
        value.fail(std::string("needs 2 to 4096 rows; ") + k_table_example);
    emission.per_unit.assign(context.band_count, 0.0);
    for (const ConfigValue& entry : rows) {
        const auto cells = entry.list_of(2, k_table_example);
        EmissionDesc::Row row{cells[0].non_negative(k_table_example),
                              cells[1].non_negative_per_band(context.band_count, k_table_example)};
        if (!emission.table.empty() && !(row.value > emission.table.back().value))
            entry.fail("values must ascend; sort the rows");
        for (std::size_t i = 0; i < row.light.size(); ++i)
            emission.per_unit[i] = std::max(emission.per_unit[i], row.light[i]);
        emission.table.push_back(std::move(row));
    }
}

/// `by_speed` or `by_shear`, the threshold and the saturation of the light.
void read_stimulus(const ConfigMap& map, EmissionDesc& emission, const ConfigValue& value,
                   EmissionDesc::Stimulus::Quantity quantity) {
    if (emission.stimulus)
        value.fail("light is set off by speed or by shear; remove by_speed or by_shear");
    if (!map.has("per_unit")) value.fail("applies to per_unit only; remove it");
    constexpr auto k_hint =
        "give where the light begins and where there is all of it, such as [0.1, 0.5]";
    const auto ends = value.list_of(2, k_hint);
    emission.stimulus =
        EmissionDesc::Stimulus{quantity, ends[0].non_negative(k_hint), ends[1].positive(k_hint)};
    if (!(emission.stimulus->threshold < emission.stimulus->saturation))
        value.fail("the first must be less than the second; " + std::string(k_hint));
}

EmissionDesc read_one_emission(const ConfigValue& value, const std::string& grid,
                               const SceneContext& context) {
    constexpr auto k_per_unit = "give W/(sr m3) per unit of the grid's value, one number per band";
    EmissionDesc emission;
    emission.grid = grid;
    emission.where = value.location();
    for (const char c : grid)
        emission.name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
    emission.name.resize(std::min(emission.name.size(), std::size_t{64}));
    if (value.node().kind == ConfigNode::Kind::sequence) {
        emission.per_unit = value.non_negative_per_band(context.band_count, k_per_unit);
        return emission;
    }
    ConfigMap map(value,
                  {"per_unit", "blackbody", "kelvin", "offset", "table", "name", "samples",
                   "by_speed", "by_shear"},
                  "write flame: [4, 1.5, 0.3], or temperature: {blackbody: 0.5, kelvin: 1000}");
    if (const auto entry = map.find("blackbody")) {
        emission.per_unit.assign(
            context.band_count,
            entry->non_negative("give the fraction of a blackbody's radiance that a metre adds"));
        emission.blackbody = read_blackbody(map);
    } else if (const auto table = map.find("table")) {
        read_table(*table, emission, context);
    } else {
        emission.per_unit = map.require("per_unit", k_per_unit)
                                .non_negative_per_band(context.band_count, k_per_unit);
    }
    if (const auto entry = map.find("by_speed"))
        read_stimulus(map, emission, *entry, EmissionDesc::Stimulus::Quantity::speed);
    if (const auto entry = map.find("by_shear"))
        read_stimulus(map, emission, *entry, EmissionDesc::Stimulus::Quantity::shear);
    if (const auto entry = map.find("name"))
        emission.name = read_short_name(*entry, "a layer's name", "name the light, such as fire");
    if (const auto entry = map.find("samples"))
        emission.samples = entry->integer(1, 1024, "give the number of points that stand for it");
    map.finish(emission.blackbody        ? "a blackbody"
               : !emission.table.empty() ? "light by a table"
                                         : "light per unit of a grid's value");
    return emission;
}

std::vector<EmissionDesc> read_emission(const ConfigValue& value, const SceneContext& context) {
    const ConfigNode& node = value.node();
    if (node.kind != ConfigNode::Kind::map || node.entries.empty())
        value.fail("expected grid names with the light that they stand for, found " +
                   node.description() + "; write {flame: [4, 1.5, 0.3]}");
    std::vector<EmissionDesc> emission;
    for (const ConfigNode::Entry& entry : node.entries)
        emission.push_back(
            read_one_emission(ConfigValue(entry.value, value.path() + "." + printable(entry.key)),
                              entry.key, context));
    return emission;
}

MotionDesc read_motion(const ConfigValue& value, const VolumeDesc& volume,
                       const SceneContext& context) {
    constexpr auto k_form = "write {grid: velocity}, or {grid: [vel.x, vel.y, vel.z]}";
    ConfigMap map(value, {"grid", "file", "scale"}, k_form);
    MotionDesc motion;
    motion.where = value.location();
    const ConfigValue grid = map.require("grid", k_form);
    if (grid.node().kind == ConfigNode::Kind::sequence) {
        for (const ConfigValue& entry : grid.list(k_form))
            motion.grids.push_back(entry.text(k_form));
        if (motion.grids.size() != 3)
            grid.fail("velocity is one grid of vectors, or three of numbers: x, y, z");
    } else {
        motion.grids.push_back(grid.text(k_form));
    }
    motion.file = volume.file;
    motion.is_sequence = volume.is_sequence;
    if (const auto entry = map.find("file"))
        motion.file = read_existing_file_or_sequence(*entry, context, motion.is_sequence);
    if (const auto entry = map.find("scale")) motion.scale = entry->number("give m/s per unit");
    return motion;
}

void check_stimuli(const VolumeDesc& volume) {
    if (volume.motion) return;
    for (const EmissionDesc& emission : volume.emission)
        if (emission.stimulus)
            throw InputError(emission.where +
                             ": the water's motion is not known; give the volume its velocity, "
                             "such as velocity: {grid: vel}");
}

/// A grid that is in memory.
VolumeDesc read_array(ConfigMap& map, const ConfigValue& name, const SceneContext& context) {
    VolumeDesc volume;
    volume.where = map.value().location();
    volume.array = read_in_memory(name, context.arrays ? &context.arrays->grids : nullptr);
    if (const auto entry = map.find("emission")) {
        volume.emission = read_emission(*entry, context);
        if (volume.emission.size() != 1) entry->fail("an array is one grid; give one light");
    }
    if (volume.emission.empty() || map.has("grids")) {
        const ConfigValue grids = map.require("grids", k_grids_example);
        volume.grids = read_grids(grids, context);
        if (volume.grids.size() != 1) grids.fail("an array is one grid; give one meaning");
    }
    if (const auto entry = map.find("transform"))
        volume.world_from_upright = read_transform(*entry);
    map.finish("an array");
    check_stimuli(volume);
    return volume;
}

VolumeDesc read_volume(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"file", "array", "grids", "emission", "centering", "up", "level_set",
                   "voxel_size", "transform", "velocity"},
                  "write {file: plume.vdb, grids: {density: {small: 2, large: 10}}}");
    if (const auto array = map.find("array")) return read_array(map, *array, context);
    VolumeDesc volume;
    volume.where = value.location();
    volume.file = read_existing_file_or_sequence(map.require("file", "name a VDB file"), context,
                                                 volume.is_sequence);
    if (const auto entry = map.find("emission")) volume.emission = read_emission(*entry, context);
    if (volume.emission.empty() || map.has("grids"))
        volume.grids = read_grids(map.require("grids", k_grids_example), context);
    if (const auto entry = map.find("centering")) {
        constexpr std::array<std::pair<std::string_view, Centering>, 2> k_choices{
            {{"cell", Centering::cell}, {"node", Centering::node}}};
        volume.centering = entry->choice(k_choices);
    }
    if (const auto entry = map.find("up")) volume.up = read_up_axis(*entry);
    if (const auto entry = map.find("level_set")) {
        constexpr std::array<std::pair<std::string_view, LevelSets>, 1> k_choices{
            {{"fog", LevelSets::fog}}};
        volume.level_sets = entry->choice(k_choices);
    }
    if (const auto entry = map.find("voxel_size"))
        volume.voxel_size = entry->positive("give the edge of a voxel in metres");
    if (const auto entry = map.find("transform"))
        volume.world_from_upright = read_transform(*entry);
    if (const auto entry = map.find("velocity"))
        volume.motion = read_motion(*entry, volume, context);
    check_stimuli(volume);
    return volume;
}

}  // namespace

UpAxis read_up_axis(const ConfigValue& value) {
    constexpr std::array<std::pair<std::string_view, UpAxis>, 3> k_choices{
        {{"x", UpAxis::x}, {"y", UpAxis::y}, {"z", UpAxis::z}}};
    return value.choice(k_choices);
}

std::vector<VolumeDesc> read_volumes(const ConfigValue& value, const SceneContext& context) {
    std::vector<VolumeDesc> volumes;
    for (const ConfigValue& entry : value.list("write one '- file: ...' per volume")) {
        volumes.push_back(read_volume(entry, context));
    }
    return volumes;
}

}  // namespace uw
