#include "core/scene/yaml/spectrum_reader.h"

#include <array>
#include <string_view>
#include <utility>

#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/name_reader.h"

namespace uw {

LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context) {
    using Type = LampSpectrumDesc::Type;
    constexpr auto k_example = "write {type: led, name: LED-B4} or {file: lamp.csv}";
    ConfigMap map(value, {"type", "temperature", "name", "file", "column"}, k_example);
    LampSpectrumDesc spectrum;
    spectrum.where = value.location();
    if (!map.has("type") && map.has("file")) {
        spectrum.type = Type::file;
        spectrum.file = read_existing_file(*map.find("file"), context);
        if (const auto column = map.find("column"))
            spectrum.column = column->text("name the column of the file");
        map.finish("a spectrum with 'file'");
        return spectrum;
    }
    const ConfigValue type = map.require("type", k_example);
    constexpr std::array<std::pair<std::string_view, Type>, 4> k_types{
        {{"flat", Type::flat},
         {"d65", Type::d65},
         {"blackbody", Type::blackbody},
         {"led", Type::led}}};
    spectrum.type = type.choice(k_types);
    if (spectrum.type == Type::blackbody) {
        constexpr auto k_mend = "give the colour temperature in kelvin, such as 5600";
        spectrum.temperature = map.require("temperature", k_mend).within(500, 100000, k_mend);
    }
    if (spectrum.type == Type::led) {
        constexpr auto k_mend = "name one of the CIE's LED illuminants, such as LED-B4";
        spectrum.name = map.require("name", k_mend).text(k_mend);
    }
    map.finish("spectrum type '" + type.node().scalar + "'");
    return spectrum;
}

}  // namespace uw
