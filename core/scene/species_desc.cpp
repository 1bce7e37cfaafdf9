#include "core/scene/species_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/csv_table.h"
#include "core/base/text.h"

namespace uw {

namespace {

/// A number followed by one of `units`, with which it is multiplied; a bare number stands for
/// itself. Empty: neither.
template <std::size_t N>
std::optional<double> number_with_unit(
    std::string_view text, const std::array<std::pair<std::string_view, double>, N>& units) {
    double value = 0;
    if (parse_number(text, value) == NumberText::number) return value;
    for (const auto& [unit, factor] : units) {
        std::string_view number = text;
        if (!number.ends_with(unit)) continue;
        number.remove_suffix(unit.size());
        while (number.ends_with(' ')) number.remove_suffix(1);
        if (parse_number(number, value) == NumberText::number) return value * factor;
    }
    return {};
}

std::string length_text(double metres) {
    if (metres < 1e-6) return fmt::format("{:g} nm", metres * 1e9);
    if (metres < 1e-3) return fmt::format("{:g} um", metres * 1e6);
    return fmt::format("{:g} cm", metres * 1e2);
}

}  // namespace

double read_diameter(const ConfigValue& value, double least, double greatest) {
    constexpr auto k_hint = "give a length with its unit, such as 0.2 mm";
    constexpr std::array<std::pair<std::string_view, double>, 7> k_units{{{"nm", 1e-9},
                                                                          {"um", 1e-6},
                                                                          {"µm", 1e-6},
                                                                          {"μm", 1e-6},
                                                                          {"mm", 1e-3},
                                                                          {"cm", 1e-2},
                                                                          {"m", 1}}};
    const ConfigNode& node = value.node();
    const std::optional<double> metres = node.kind == ConfigNode::Kind::scalar
                                             ? number_with_unit(node.scalar, k_units)
                                             : std::nullopt;
    if (!metres)
        value.fail(fmt::format("expected a diameter, found {}; {}", node.description(), k_hint));
    // Tolerates the rounding of units.
    constexpr double k_slack = 1e-9;
    if (!(*metres >= least * (1 - k_slack)) || !(*metres <= greatest * (1 + k_slack)))
        value.fail(fmt::format("must be from {} to {}, found {:g} m; {}", length_text(least),
                               length_text(greatest), *metres, k_hint));
    return *metres;
}

void read_diameters(const ConfigValue& value, double least, double greatest, double& first,
                    double& last) {
    const auto ends =
        value.list_of(2, "give the least and the greatest diameter, such as [0.2 mm, 5 mm]");
    first = read_diameter(ends[0], least, greatest);
    last = read_diameter(ends[1], least, greatest);
    if (!(first < last))
        value.fail("the first must be less than the second; write the least diameter first");
}

namespace {

constexpr double k_least = k_min_diameter, k_greatest = k_max_diameter;
constexpr double k_min_sigma = 1.02;  // narrower ones have halos finer than the tables' angles

SizesDesc read_sizes(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example =
        "write {type: junge, exponent: 4, diameter: [0.5 um, 50 um]}, or {type: lognormal, "
        "median: 5 um, sigma: 1.6}";
    using Type = SizesDesc::Type;
    constexpr std::array<std::pair<std::string_view, Type>, 4> k_types{
        {{"junge", Type::junge},
         {"lognormal", Type::lognormal},
         {"gamma", Type::gamma},
         {"table", Type::table}}};
    ConfigMap map(value, {"type", "diameter", "exponent", "median", "sigma", "mode", "file"},
                  k_example);
    const ConfigValue type = map.require("type", k_example);
    SizesDesc sizes;
    sizes.type = type.choice(k_types);
    switch (sizes.type) {
        case Type::junge:
            if (const auto entry = map.find("exponent"))
                sizes.exponent =
                    entry->within(0, 10, "give Junge's exponent, of numbers per diameter: 4");
            break;
        case Type::lognormal:
            sizes.median = read_diameter(map.require("median", k_example), k_least, k_greatest);
            if (const auto entry = map.find("sigma"))
                sizes.sigma = entry->within(k_min_sigma, 10,
                                            "give the geometric standard deviation, such as 1.6");
            break;
        case Type::gamma:
            sizes.mode = read_diameter(map.require("mode", k_example), k_least, k_greatest);
            sizes.exponent = 3;
            if (const auto entry = map.find("exponent"))
                sizes.exponent = entry->within(0.1, 100, "give the exponent of the diameter: 3");
            break;
        case Type::table:
            sizes.file = read_existing_file(
                map.require("file", "name a CSV with the columns diameter_um,volume"), context);
            break;
    }
    const bool needs_ends = sizes.type == Type::junge || sizes.type == Type::gamma;
    if (sizes.type != Type::table) {
        if (const auto entry = map.find("diameter"))
            read_diameters(*entry, k_least, k_greatest, sizes.least, sizes.greatest);
        else if (needs_ends)
            value.fail(std::string("has no diameter, its least and greatest; ") + k_example);
    }
    map.finish("sizes of type '" + type.node().scalar + "'");
    return sizes;
}

ParticleIndexDesc read_index(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_hint =
        "give the refractive index against that of water, such as 1.15, {n: 1.15, k: 0.001}, or "
        "{file: index.csv}";
    ParticleIndexDesc index;
    const auto within = [&](const ConfigValue& n) { return n.within(0.3, 5, k_hint); };
    if (value.node().kind != ConfigNode::Kind::map) {
        index.n = within(value);
        return index;
    }
    ConfigMap map(value, {"n", "k", "file"}, k_hint);
    if (const auto file = map.find("file")) {
        index.file = read_existing_file(*file, context);
        map.finish("an index with 'file'");
        return index;
    }
    index.n = within(map.require("n", k_hint));
    if (const auto k = map.find("k")) index.k = k->within(0, 5, k_hint);
    return index;
}

/// A species of the library: particles of assets/spectra/species.csv, a water of petzold_vsf.csv,
/// or a class of Kopelevich's.
SpeciesDesc library_species(const ConfigValue& value) {
    const CsvTable library = read_embedded_table("species.csv");
    std::vector<std::string> names = library.text("name");
    const std::size_t computed = names.size();
    const CsvTable measured = read_embedded_table("petzold_vsf.csv");
    for (const std::string& water : measured.columns())
        if (water.starts_with("petzold")) names.push_back(water);
    const std::size_t kopelevich = names.size();
    names.insert(names.end(), {"kopelevich-small", "kopelevich-large"});
    const std::vector<std::string_view> words(names.begin(), names.end());
    const std::size_t row = value.word_index(words);
    if (row >= kopelevich)
        return kopelevich_species(
            row == kopelevich ? KopelevichClass::small : KopelevichClass::large, {}, {});
    if (row >= computed) {
        SpeciesDesc species;
        species.vsf = MeasuredVsfDesc{};
        species.vsf->library = names[row];
        species.vsf->has_water = true;
        return species;
    }
    const auto number = [&](std::string_view column) { return library.numbers(column)[row]; };
    SpeciesDesc species;
    species.sizes.exponent = number("exponent");
    species.sizes.least = number("least_um") * 1e-6;
    species.sizes.greatest = number("greatest_um") * 1e-6;
    species.index.n = number("n");
    species.index.k = number("k_550");
    species.index.k_slope = number("k_slope_per_nm");
    species.density = number("density");
    if (number("coat_um") > 0)
        species.coat = SpeciesDesc::Coat{number("coat_um") * 1e-6,
                                         {number("coat_n"), 0, 0, std::filesystem::path()}};
    return species;
}

void read_sample(ConfigMap& map, const SceneContext& context, SpeciesDesc& species) {
    MeasuredVsfDesc& vsf = *species.vsf;
    if (const auto sample = map.find("sample")) {
        using Unit = SpeciesAmount::Unit;
        const ConfigNode& node = sample->node();
        const auto amount = node.kind == ConfigNode::Kind::scalar ? parse_amount(node.scalar)
                                                                  : std::optional<SpeciesAmount>{};
        if (!amount || !(amount->amount > 0) ||
            (amount->unit != Unit::grams && amount->unit != Unit::number))
            sample->fail(
                fmt::format("expected what was in the sample, found {}; write '3 g/m3' or "
                            "'1e6 /m3'",
                            node.description()));
        vsf.sample = amount;
    }
    const auto absorption = map.find("absorption");
    if (!absorption) return;
    constexpr auto k_hint =
        "give the particles' absorption in the sample in 1/m, or {file: absorption.csv}";
    if (absorption->node().kind != ConfigNode::Kind::map) {
        vsf.absorption = absorption->within(0, 1e6, k_hint);
        return;
    }
    ConfigMap of_file(*absorption, {"file"}, k_hint);
    vsf.absorption_file = read_existing_file(of_file.require("file", k_hint), context);
}

}  // namespace

SpeciesDesc kopelevich_species(KopelevichClass kind, std::string name, SourceLocation where) {
    SpeciesDesc species;
    species.name = std::move(name);
    species.kopelevich = kind;
    species.density =
        kind == KopelevichClass::small ? k_small_particle_density : k_large_particle_density;
    species.where = std::move(where);
    return species;
}

namespace {

SpeciesDesc read_one(const std::string& name, const ConfigValue& value,
                     const SceneContext& context) {
    constexpr auto k_example =
        "write {library: clay}, or {size: {type: junge, diameter: [0.5 um, 50 um]}, index: 1.15}, "
        "or {vsf: measured.csv, water: included}";
    ConfigMap map(value,
                  {"library", "size", "index", "density", "coat", "vsf", "water", "sample",
                   "absorption", "ntu"},
                  k_example);
    SpeciesDesc species;
    if (const auto entry = map.find("library")) species = library_species(*entry);
    const bool is_known = map.has("library");
    species.name = name;
    species.where = value.location();
    if (const auto ntu = map.find("ntu"))
        species.ntu_scattering =
            ntu->between(0, 1e3, "give b at 550 nm in 1/m of as much of the species as has 1 NTU");
    if (map.has("vsf")) {
        if (is_known) value.fail("has a 'library' and a 'vsf'; remove one of them");
        species.vsf = MeasuredVsfDesc{};
        species.vsf->file = read_existing_file(*map.find("vsf"), context);
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_choices{
            {{"included", true}, {"removed", false}}};
        species.vsf->has_water =
            map.require("water",
                        "say whether the scattering of water's molecules is part of what was "
                        "measured: included or removed")
                .choice(k_choices);
    }
    if (species.vsf) {
        read_sample(map, context, species);
        map.finish("a species with a measured VSF");
        return species;
    }
    if (species.kopelevich) {
        map.finish("a species of Kopelevich's");
        return species;
    }
    const auto entry = [&](std::string_view key) {
        return is_known ? map.find(key) : std::optional(map.require(key, k_example));
    };
    if (const auto size = entry("size")) species.sizes = read_sizes(*size, context);
    if (const auto index = entry("index")) species.index = read_index(*index, context);
    if (const auto density = map.find("density"))
        species.density = density->within(1e-4, 25, "give the particles' density in g/cm3");
    if (const auto coat = map.find("coat")) {
        constexpr auto k_coat = "write {thickness: 0.1 um, index: 1.2}";
        ConfigMap of_coat(*coat, {"thickness", "index"}, k_coat);
        SpeciesDesc::Coat made;
        made.thickness = read_diameter(of_coat.require("thickness", k_coat), 1e-9, 1e-3);
        made.index = read_index(of_coat.require("index", k_coat), context);
        species.coat = made;
    }
    return species;
}

}  // namespace

std::vector<SpeciesDesc> read_species(const ConfigValue& value, const SceneContext& context) {
    // In concentrations, in grids, and as columns of depth profiles.
    constexpr std::array<std::string_view, 8> k_taken{"small",      "large",      "absorption",
                                                      "scattering", "phase",      "attenuation",
                                                      "cdom",       "chlorophyll"};
    const ConfigNode& node = value.node();
    if (node.kind != ConfigNode::Kind::map)
        value.fail("expected names with what they are, found " + node.description() +
                   "; write {silt: {library: silt}}");
    std::vector<SpeciesDesc> all;
    for (const ConfigNode::Entry& entry : node.entries) {
        const ConfigValue one(entry.value, value.path() + "." + printable(entry.key));
        if (std::ranges::find(k_taken, entry.key) != k_taken.end())
            one.fail("this name has a meaning of its own; choose another");
        const bool is_plain = !entry.key.empty() && entry.key.size() <= 64 &&
                              std::ranges::all_of(entry.key, [](unsigned char c) {
                                  return std::isalnum(c) != 0 || c == '_' || c == '-';
                              });
        if (!is_plain) one.fail("a species' name has up to 64 letters, digits, _ and -; rename it");
        all.push_back(read_one(entry.key, one, context));
    }
    return all;
}

std::vector<std::string_view> names_of(const std::vector<SpeciesDesc>& species) {
    std::vector<std::string_view> names;
    for (const SpeciesDesc& one : species) names.emplace_back(one.name);
    return names;
}

std::optional<SpeciesAmount> parse_amount(std::string_view text) {
    using Unit = SpeciesAmount::Unit;
    struct Choice {
        std::string_view text;
        Unit unit;
        double factor;
    };
    // A bare number belongs to the first unit.
    constexpr std::array<Choice, 9> k_units{{{"ppm", Unit::own, 1},
                                             {"mg/l", Unit::grams, 1},
                                             {"mg/L", Unit::grams, 1},
                                             {"g/m3", Unit::grams, 1},
                                             {"/m3", Unit::number, 1},
                                             {"/l", Unit::number, 1000},
                                             {"NTU", Unit::ntu, 1},
                                             {"FTU", Unit::ntu, 1},
                                             {"FNU", Unit::ntu, 1}}};
    for (const Choice& choice : k_units)
        if (const auto amount =
                number_with_unit(text, std::array{std::pair(choice.text, choice.factor)}))
            return SpeciesAmount{0, *amount, choice.unit};
    return {};
}

SpeciesAmount read_amount(std::string_view text, std::size_t index, const SpeciesDesc& species,
                          const SourceLocation& where) {
    using Unit = SpeciesAmount::Unit;
    std::optional<SpeciesAmount> amount = parse_amount(text);
    if (!amount)
        throw InputError(
            fmt::format("{}: expected a concentration, found '{}'; give ppm by volume, or write '3 "
                        "g/m3', '1e6 /m3' or '4 NTU'",
                        where, printable(text)));
    if (!(amount->amount >= 0 && amount->amount <= 1e18))
        throw InputError(fmt::format("{}: must be from 0 to 1e18, found {:g}; give a concentration",
                                     where, amount->amount));
    if (species.vsf) {
        const bool is_of_sample = amount->unit == Unit::grams || amount->unit == Unit::number;
        if (text.ends_with("ppm") ||
            (is_of_sample && !(species.vsf->sample && species.vsf->sample->unit == amount->unit)))
            throw InputError(fmt::format(
                "{}: what was in the sample of {} is not known in this unit; give how many times "
                "as much there is, a bare number, or the species a sample: 3 g/m3",
                where, species.name));
    } else if (species.kopelevich && amount->unit == Unit::number) {
        throw InputError(fmt::format(
            "{}: how many particles of {} are 1 ppm is not known, since Kopelevich gives no sizes; "
            "give ppm, or write '3 g/m3' or '4 NTU'",
            where, species.name));
    } else if (amount->unit == Unit::grams && !species.density) {
        throw InputError(fmt::format(
            "{}: {} has no density, by which grams become particles; give it one in g/cm3", where,
            species.name));
    }
    amount->species = index;
    return *amount;
}

std::vector<SpeciesAmount> read_amounts(ConfigMap& map, const std::vector<SpeciesDesc>& species) {
    std::vector<SpeciesAmount> amounts;
    for (std::size_t i = 0; i < species.size(); ++i) {
        const auto entry = map.find(species[i].name);
        if (!entry) continue;
        const ConfigNode& node = entry->node();
        if (node.kind != ConfigNode::Kind::scalar)
            entry->fail("expected a concentration, found " + node.description() +
                        "; give ppm by volume, or write '3 g/m3', '1e6 /m3' or '4 NTU'");
        amounts.push_back(read_amount(node.scalar, i, species[i], entry->location()));
    }
    return amounts;
}

}  // namespace uw
