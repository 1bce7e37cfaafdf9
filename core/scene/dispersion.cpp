#include "core/scene/dispersion.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace uw {

namespace {

using Material = DispersionDesc::Material;

/// A term of Sellmeier's n^2 = 1 + sum of strength lambda^2 / (lambda^2 - pole), lambda in um.
struct SellmeierTerm {
    double strength, pole;
};

double sellmeier(std::span<const SellmeierTerm> terms, double wavelength_nm) {
    const double squared = wavelength_nm * wavelength_nm * 1e-6;
    double sum = 1;
    for (const SellmeierTerm& term : terms) sum += term.strength * squared / (squared - term.pole);
    return std::sqrt(sum);
}

constexpr double square(double x) {
    return x * x;
}

// Schott, Optical Glass Data Sheets, N-BK7 517642.
constexpr std::array<SellmeierTerm, 3> k_bk7{
    {{1.03961212, 0.00600069867}, {0.231792344, 0.0200179144}, {1.01046945, 103.560653}}};
// I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965), at 20 deg C.
constexpr std::array<SellmeierTerm, 3> k_fused_silica{{{0.6961663, square(0.0684043)},
                                                       {0.4079426, square(0.1162414)},
                                                       {0.8974794, square(9.896161)}}};
// M. J. Dodge, in Handbook of Laser Science and Technology IV (1986), ordinary ray at 20 deg C:
// windows are cut across the axis, along which both rays have this index.
constexpr std::array<SellmeierTerm, 3> k_sapphire{{{1.4313493, square(0.0726631)},
                                                   {0.65054713, square(0.1193242)},
                                                   {5.3414021, square(18.028251)}}};
// N. Sultanova, S. Kasarova, I. Nikolov, Acta Phys. Pol. A 116, 585 (2009), at 20 deg C.
constexpr std::array<SellmeierTerm, 1> k_pmma{{{1.1819, 0.011313}}};
constexpr std::array<SellmeierTerm, 1> k_polycarbonate{{{1.4182, 0.021304}}};

/// Dry air of 15 deg C, 101325 Pa and 450 ppm CO2 against vacuum (Ciddor, Appl. Opt. 35, 1566
/// (1996), eq. 1).
double air_index(double wavelength_nm) {
    const double squared = 1e6 / (wavelength_nm * wavelength_nm);
    return 1 + 0.05792105 / (238.0185 - squared) + 0.00167917 / (57.362 - squared);
}

/// Cauchy's two terms, through the lines F, d and C by which n_d and Abbe's number are defined.
double abbe_index(double n_d, double abbe, double wavelength_nm) {
    constexpr double k_f = 486.1327, k_d = 587.5618, k_c = 656.2725;
    const auto inverse_square = [](double nm) { return 1 / (nm * nm); };
    const double b = (n_d - 1) / abbe / (inverse_square(k_f) - inverse_square(k_c));
    return n_d + b * (inverse_square(wavelength_nm) - inverse_square(k_d));
}

constexpr std::array<std::pair<std::string_view, Material>, 6> k_index_words{
    {{"vacuum", Material::vacuum},
     {"bk7", Material::bk7},
     {"fused-silica", Material::fused_silica},
     {"sapphire", Material::sapphire},
     {"pmma", Material::pmma},
     {"polycarbonate", Material::polycarbonate}}};

/// Materials without dispersion, or whose dispersion depends on the scene's water.
enum class Plain { air, seawater, freshwater };
constexpr std::array<std::pair<std::string_view, Plain>, 3> k_other_index_words{
    {{"air", Plain::air}, {"seawater", Plain::seawater}, {"freshwater", Plain::freshwater}}};

constexpr auto k_index_hint =
    "give a refractive index, such as 1.0, 1.49 or 1.334, or a material, such as bk7, seawater, "
    "{salinity: 35, temperature: 10} or {n_d: 1.5168, abbe: 64.2}";

DispersionDesc read_by_numbers(const ConfigValue& value) {
    ConfigMap map(value, {"salinity", "temperature", "n_d", "abbe"}, k_index_hint);
    DispersionDesc desc;
    if (const auto n_d = map.find("n_d")) {
        desc.material = Material::abbe;
        desc.n_d = n_d->within(1, 3, "give the index at 587.56 nm, such as 1.5168");
        desc.abbe = map.require("abbe", "give Abbe's number, such as 64.2")
                        .within(10, 200, "give Abbe's number, such as 64.2");
        map.finish("an index by n_d and abbe");
        return desc;
    }
    desc.material = Material::water;
    if (const auto entry = map.find("salinity"))
        desc.salinity = entry->within(0, 100, "give the salinity in PSU (the sea: 35)");
    if (const auto entry = map.find("temperature"))
        desc.temperature = entry->within(-3, 50, "give the temperature in degrees Celsius");
    map.finish("water (write {salinity: 35, temperature: 10}, or n_d and abbe)");
    if (!desc.salinity && !desc.temperature) value.fail(fmt::format("is empty; {}", k_index_hint));
    return desc;
}

}  // namespace

std::optional<DispersionDesc> read_index(const ConfigValue& value, double& number) {
    if (value.node().kind == ConfigNode::Kind::map) return read_by_numbers(value);
    double parsed = 0;
    const bool is_word = value.node().kind == ConfigNode::Kind::scalar &&
                         !value.node().scalar.empty() &&
                         parse_number(value.node().scalar, parsed) == NumberText::no_number;
    if (!is_word) {
        number = value.within(1, 3, k_index_hint);
        return std::nullopt;
    }
    for (const auto& [word, material] : k_index_words)
        if (value.node().scalar == word) return DispersionDesc{.material = material};
    std::vector<std::string_view> words;
    for (const auto& [word, material] : k_index_words) words.push_back(word);
    for (const auto& [word, plain] : k_other_index_words) words.push_back(word);
    const std::size_t index = value.word_index(words);
    const Plain plain = k_other_index_words[index - k_index_words.size()].second;
    if (plain == Plain::air) {
        number = 1;
        return std::nullopt;
    }
    DispersionDesc water{.material = Material::water};
    if (plain == Plain::freshwater) water.salinity = 0;
    return water;
}

std::string scene_text(const DispersionDesc& desc) {
    for (const auto& [word, material] : k_index_words)
        if (desc.material == material) return std::string(word);
    if (desc.material == Material::abbe)
        return fmt::format("{{n_d: {}, abbe: {}}}", desc.n_d, desc.abbe);
    if (!desc.salinity && !desc.temperature) return "seawater";
    std::string text;
    if (desc.salinity) text = fmt::format("salinity: {}", *desc.salinity);
    if (desc.temperature)
        text += fmt::format("{}temperature: {}", text.empty() ? "" : ", ", *desc.temperature);
    return fmt::format("{{{}}}", text);
}

double water_refractive_index(double wavelength_nm, double temperature, double salinity) {
    const double t = temperature, s = salinity, nm = wavelength_nm;
    return 1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t +
           (15.868 + 0.01155 * s - 0.00423 * t) / nm - 4382 / (nm * nm) + 1.1455e6 / (nm * nm * nm);
}

double refractive_index(const DispersionDesc& desc, double wavelength_nm) {
    switch (desc.material) {
        case Material::vacuum:
            return 1 / air_index(wavelength_nm);
        case Material::bk7:
            return sellmeier(k_bk7, wavelength_nm);
        case Material::fused_silica:
            return sellmeier(k_fused_silica, wavelength_nm);
        case Material::sapphire:
            return sellmeier(k_sapphire, wavelength_nm);
        case Material::pmma:
            return sellmeier(k_pmma, wavelength_nm);
        case Material::polycarbonate:
            return sellmeier(k_polycarbonate, wavelength_nm);
        case Material::water:
            return water_refractive_index(wavelength_nm, desc.temperature.value(),
                                          desc.salinity.value());
        case Material::abbe:
            break;
    }
    return abbe_index(desc.n_d, desc.abbe, wavelength_nm);
}

}  // namespace uw
