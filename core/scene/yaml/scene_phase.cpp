#include <array>
#include <cstdint>

#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/scene_sections.h"

namespace uw {

PhaseDesc read_phase(const ConfigValue& value, const SceneContext& context) {
    using Type = PhaseDesc::Type;
    constexpr auto k_example = "write {type: hg, g: 0.9}";
    constexpr std::array<std::pair<std::string_view, Type>, 5> k_types{
        {{"hg", Type::henyey_greenstein},
         {"fournier-forand", Type::fournier_forand},
         {"petzold", Type::petzold},
         {"table", Type::table},
         {"water", Type::water}}};
    ConfigMap map(value, {"type", "g", "n", "mu", "file"}, k_example);
    PhaseDesc phase;
    phase.where = value.location();
    const ConfigValue type = map.require("type", k_example);
    phase.type = type.choice(k_types);
    if (phase.type == Type::henyey_greenstein) {
        constexpr auto k_mend = "give the mean cosine of the scattering angle";
        phase.g = map.require("g", k_mend).between(-1, 1, k_mend);
    } else if (phase.type == Type::fournier_forand) {
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
    } else if (phase.type == Type::table) {
        phase.file =
            read_existing_file(map.require("file", "name a CSV file of angle_deg,phase"), context);
    }
    map.finish("phase type '" + type.node().scalar + "'");
    return phase;
}

}  // namespace uw
