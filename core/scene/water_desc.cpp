#include "core/scene/water_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/spectrum.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/waves_desc.h"

namespace uw {

namespace {

PhaseFunctionDesc read_henyey_greenstein(ConfigMap& map, const SceneContext& /*context*/) {
    constexpr auto k_hint = "give the mean cosine of the scattering angle";
    return HenyeyGreensteinDesc{map.require("g", k_hint).between(-1, 1, k_hint)};
}

PhaseFunctionDesc read_fournier_forand(ConfigMap& map, const SceneContext& /*context*/) {
    FournierForandDesc phase;
    if (const auto n = map.find("n")) {
        phase.n = n->number("give the particles' refractive index relative to water");
        if (phase.n <= 1 || phase.n > 3) {
            n->fail(
                "must be greater than 1 and at most 3; give the particles' refractive "
                "index relative to water, such as 1.10");
        }
    }
    if (const auto mu = map.find("mu")) {
        phase.mu = mu->between(3, 5, "give the slope of the particles' Junge distribution");
    }
    return phase;
}

PhaseFunctionDesc read_petzold(ConfigMap& /*map*/, const SceneContext& /*context*/) {
    return PetzoldDesc{};
}

PhaseFunctionDesc read_tabulated_phase(ConfigMap& map, const SceneContext& context) {
    return TabulatedPhaseDesc{
        read_existing_file(map.require("file", "name a CSV file of angle_deg,phase"), context)};
}

PhaseFunctionDesc read_molecular_phase(ConfigMap& /*map*/, const SceneContext& /*context*/) {
    return MolecularPhaseDesc{};
}

}  // namespace

PhaseDesc read_phase(const ConfigValue& value, const SceneContext& context) {
    using Read = PhaseFunctionDesc (*)(ConfigMap&, const SceneContext&);
    constexpr auto k_types =
        std::to_array<std::pair<std::string_view, Read>>({{"hg", read_henyey_greenstein},
                                                          {"fournier-forand", read_fournier_forand},
                                                          {"petzold", read_petzold},
                                                          {"table", read_tabulated_phase},
                                                          {"water", read_molecular_phase}});
    static_assert(k_types.size() == std::variant_size_v<PhaseFunctionDesc>);
    constexpr auto k_example = "write {type: hg, g: 0.9}";
    ConfigMap map(value, {"type", "g", "n", "mu", "file"}, k_example);
    const ConfigValue type = map.require("type", k_example);
    PhaseDesc phase{type.choice(k_types)(map, context), value.location()};
    map.finish("phase type '" + type.node().scalar + "'");
    return phase;
}

namespace {

constexpr double k_max_ppm = 1e6;

std::vector<double> read_bands(const ConfigValue& value) {
    constexpr auto k_hint = "give wavelengths in nm, such as [620, 540, 450]";
    const std::vector<ConfigValue> entries = value.list(k_hint);
    if (entries.empty() || entries.size() > static_cast<std::size_t>(k_max_bands)) {
        value.fail(fmt::format("expected 1 to {} bands, found {}; {}", k_max_bands, entries.size(),
                               k_hint));
    }
    std::vector<double> bands;
    for (const ConfigValue& entry : entries) {
        const double nm = entry.positive(k_hint);
        if (nm < 10) {
            entry.fail(
                fmt::format("{} looks like micrometres; give nanometres ({})", nm, nm * 1000));
        }
        if (nm < 200 || nm > 1100) {
            entry.fail(fmt::format("must be from 200 to 1100, found {}; {}", nm, k_hint));
        }
        if (std::find(bands.begin(), bands.end(), nm) != bands.end()) {
            entry.fail(fmt::format("{} nm is given twice; remove one", nm));
        }
        bands.push_back(nm);
    }
    return bands;
}

/// Preset names of Jerlov's water types.
std::string read_preset(const ConfigValue& value) {
    constexpr std::array<std::string_view, 6> k_presets{"jerlov-IB", "jerlov-II", "jerlov-III",
                                                        "jerlov-1C", "jerlov-3C", "jerlov-5C"};
    return std::string(k_presets[value.word_index(k_presets)]);
}

void read_particles(const ConfigValue& value, WaterDesc& water) {
    constexpr auto k_ppm = "give a concentration in ppm by volume";
    std::vector<std::string_view> keys{"small", "large", "absorption"};
    std::ranges::copy(names_of(water.species), std::back_inserter(keys));
    ConfigMap map(value, std::move(keys), "write {small: 0.03, large: 0.05}");
    water.amounts = read_amounts(map, water.species);
    if (const auto entry = map.find("small")) {
        water.small_ppm = entry->within(0, k_max_ppm, k_ppm);
    }
    if (const auto entry = map.find("large")) {
        water.large_ppm = entry->within(0, k_max_ppm, k_ppm);
    }
    if (const auto entry = map.find("absorption")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_choices{
            {{"none", false}, {"mineral", true}}};
        water.mineral_absorption = entry->choice(k_choices);
    }
    if (water.scattering && (water.small_ppm || water.large_ppm || !water.amounts.empty())) {
        value.fail(
            "'scattering' takes the place of background particles; remove their concentrations, "
            "or remove 'scattering'");
    }
}

ScatteringDesc read_scattering(const ConfigValue& value, bool has_profile,
                               const SceneContext& context) {
    constexpr auto k_example = "write {b: [0.2, 0.2, 0.2], phase: {type: hg, g: 0.9}}";
    ConfigMap map(value, {"b", "phase"}, k_example);
    ScatteringDesc scattering;
    scattering.b = PerBand(context.band_count, 0.0);
    if (has_profile && !map.has("b")) {
        scattering.is_by_depth = true;
    } else {
        scattering.b = map.require("b", k_example)
                           .non_negative_per_band(context.band_count,
                                                  "give the scattering coefficient in 1/m");
    }
    scattering.phase = read_phase(map.require("phase", k_example), context);
    return scattering;
}

ForwardScatterDesc read_forward_scatter(const ConfigValue& value) {
    constexpr auto k_example = "write {K: 1, G: 0.1, B: 0.02}";
    ConfigMap map(value, {"K", "G", "B", "shape"}, k_example);
    ForwardScatterDesc forward;
    forward.where = value.location();
    forward.K = map.require("K", k_example).non_negative("give 0 for no forward scatter");
    if (const auto entry = map.find("G")) forward.G = entry->number("give a coefficient in 1/m");
    const auto blur = map.find("B");
    if (blur) forward.B = blur->non_negative("give a width in rad/m");
    if (forward.K > 0 && !blur)
        value.fail("has no B, the width of the blur in rad/m; " + std::string(k_example));
    if (const auto entry = map.find("shape")) {
        constexpr std::array<std::pair<std::string_view, ForwardScatterDesc::Shape>, 2> k_shapes{
            {{"gaussian", ForwardScatterDesc::Shape::gaussian},
             {"exponential", ForwardScatterDesc::Shape::exponential}}};
        forward.shape = entry->choice(k_shapes);
    }
    return forward;
}

/// Absorption given as a number, or measured for a preset, already includes dissolved matter.
void read_dissolved(ConfigMap& map, WaterDesc& water) {
    const auto refuse_if_covered = [&](const ConfigValue& value) {
        if (water.absorption) {
            value.fail(
                "'absorption' already includes dissolved matter; remove this or 'absorption'");
        }
        if (!water.preset.empty()) {
            value.fail("the preset already includes dissolved matter; remove this or 'preset'");
        }
    };
    if (const auto entry = map.find("cdom")) {
        water.cdom = entry->non_negative("give a_g at 440 nm in 1/m");
        refuse_if_covered(*entry);
    }
    if (const auto entry = map.find("chlorophyll")) {
        water.chlorophyll = entry->non_negative("give a concentration in mg/m^3");
        refuse_if_covered(*entry);
    }
}

// Of the water against the air.
constexpr double k_min_n = 1.0001, k_max_n = 3;

WaterSurfaceDesc read_surface(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example =
        "write {height: 10, n: 1.34}, or {point: [0, 10, 0], normal: [0, 1, 0]}";
    ConfigMap map(value, {"height", "point", "normal", "n", "waves"}, k_example);
    WaterSurfaceDesc surface;
    if (const auto height = map.find("height")) {
        for (const auto* const other : {"point", "normal"})
            if (const auto entry = map.find(other))
                entry->fail("height says already where the surface is; remove one");
        surface.point = {0, height->number("give the surface's height along y in metres"), 0};
    } else {
        surface.point = at_origin_plus(
            map.require("point", k_example)
                .vector("give a point on the water's surface, three lengths in metres"));
        surface.normal = map.require("normal", k_example)
                             .direction("give the direction out of the water, not all 0");
    }
    if (const auto entry = map.find("n"))
        surface.n = entry->within(k_min_n, k_max_n,
                                  "give the water's refractive index against air, such as 1.34");
    if (const auto entry = map.find("waves")) {
        if (!surface.n)
            entry->fail(
                "waves are seen by what they refract and reflect, and the surface has no index; "
                "add n: 1.34");
        surface.waves = std::make_shared<const WavesDesc>(read_waves(*entry, context));
    }
    return surface;
}

constexpr double k_min_diameter = 1e-6, k_max_diameter = 0.1;
constexpr int k_max_particles = 20'000'000;

SnowDesc read_snow(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example = "write {number: 2000, diameter: [0.2 mm, 5 mm]}";
    ConfigMap map(value,
                  {"number", "diameter", "exponent", "reflectance", "drift", "seed", "mean",
                   "ground_truth", "most"},
                  k_example);
    SnowDesc snow;
    snow.where = value.location();
    snow.number = map.require("number", k_example).positive("give the particles per m^3");
    read_diameters(map.require("diameter", k_example), k_min_diameter, k_max_diameter, snow.least,
                   snow.greatest);
    if (const auto entry = map.find("exponent"))
        snow.exponent = entry->within(0, 10, "give Junge's exponent, of numbers per diameter: 4");
    snow.reflectance.assign(context.band_count, 0.4);
    if (const auto entry = map.find("reflectance")) {
        constexpr auto k_hint = "give the particles' reflectance, 0 to 1";
        snow.reflectance.clear();
        for (const ConfigValue& band : entry->per_band(context.band_count, k_hint))
            snow.reflectance.push_back(band.within(0, 1, k_hint));
    }
    if (const auto entry = map.find("drift"))
        snow.drift = entry->vector("give a velocity in m/s, such as [0.02, -0.001, 0]");
    if (const auto entry = map.find("seed"))
        snow.seed =
            static_cast<std::uint64_t>(entry->integer(0, 2147483647, "give a whole number"));
    if (const auto entry = map.find("mean")) {
        constexpr std::array<std::pair<std::string_view, SnowDesc::Mean>, 2> k_means{
            {{"included", SnowDesc::Mean::included}, {"added", SnowDesc::Mean::added}}};
        snow.mean = entry->choice(k_means);
    }
    if (const auto entry = map.find("ground_truth")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_choices{
            {{"ignored", false}, {"held", true}}};
        snow.in_ground_truth = entry->choice(k_choices);
    }
    if (const auto entry = map.find("most"))
        snow.most = entry->integer(1, k_max_particles,
                                   "give how many particles to draw in an image, 1 to 20000000");
    return snow;
}

}  // namespace

WaterDesc read_water(const ConfigValue& value, SceneContext& context) {
    ConfigMap map(
        value,
        {"bands", "preset", "salinity", "temperature", "absorption", "cdom", "chlorophyll",
         "species", "particles", "scattering", "forward_scatter", "profile", "surface", "snow"},
        "write {bands: [620, 540, 450]}");
    WaterDesc water;
    water.where = value.location();
    if (const auto entry = map.find("bands")) water.bands_nm = read_bands(*entry);
    context.band_count = water.bands_nm.size();
    if (const auto entry = map.find("preset")) water.preset = read_preset(*entry);
    if (const auto entry = map.find("salinity")) {
        water.salinity = entry->within(0, 100, "give the salinity in PSU (the sea: 35)");
    }
    if (const auto entry = map.find("temperature")) {
        water.temperature = entry->within(-3, 50, "give the temperature in degrees Celsius");
    }
    if (const auto entry = map.find("absorption")) {
        water.absorption = entry->non_negative_per_band(context.band_count,
                                                        "give the absorption coefficient in 1/m");
    }
    read_dissolved(map, water);
    if (const auto entry = map.find("scattering")) {
        water.scattering = read_scattering(*entry, map.has("profile"), context);
    }
    if (const auto entry = map.find("species")) water.species = read_species(*entry, context);
    if (const auto entry = map.find("particles")) read_particles(*entry, water);
    if (const auto entry = map.find("forward_scatter"))
        water.forward_scatter = read_forward_scatter(*entry);
    if (const auto entry = map.find("surface")) water.surface = read_surface(*entry, context);
    context.water_surface = water.surface;
    if (const auto entry = map.find("profile")) {
        if (!water.surface)
            entry->fail(
                "depths count from the water's surface, which is missing; add surface: {point: [0, "
                "10, 0], normal: [0, 1, 0]}");
        water.profile = DepthProfileDesc{read_existing_file(*entry, context), entry->location()};
    }
    if (const auto entry = map.find("snow")) water.snow = read_snow(*entry, context);
    return water;
}

}  // namespace uw
