#include "core/scene/yaml/phase_reader.h"

#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/name_reader.h"

namespace uw {
namespace {

PhaseFunctionDesc read_henyey_greenstein(ConfigMap& map, const SceneContext& /*context*/) {
    constexpr auto k_mend = "give the mean cosine of the scattering angle";
    return HenyeyGreensteinDesc{map.require("g", k_mend).between(-1, 1, k_mend)};
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

}  // namespace uw
