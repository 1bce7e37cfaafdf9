#include "cli/water/water_json.h"

#include <cmath>
#include <numbers>

#include "core/base/version.h"
#include "core/json/json.h"

namespace uw {

namespace {

template <class F>
Json list(std::size_t count, F value) {
    Json out = Json::array();
    for (std::size_t i = 0; i < count; ++i) out.push_back(number_json(value(i)));
    return out;
}

Json coefficients(const CoefficientTable& table) {
    const std::size_t n = table.absorption.size();
    Json out;
    if (!table.unit.empty()) {
        out["name"] = table.name;
        out["unit"] = table.unit;
    }
    out["a"] = list(n, [&](std::size_t i) { return table.absorption[i]; });
    out["b"] = list(n, [&](std::size_t i) { return table.scattering(i); });
    out["c"] = list(n, [&](std::size_t i) { return table.attenuation(i); });
    out["bb"] = list(n, [&](std::size_t i) { return table.backscattering(i); });
    out["bb_over_b"] = list(n, [&](std::size_t i) { return table.backscatter_fraction(i); });
    out["albedo"] = list(n, [&](std::size_t i) { return table.albedo(i); });
    out["mean_cosine"] = list(n, [&](std::size_t i) { return table.mean_cosine(i); });
    out["components"] = Json::array();
    for (const ScatteringPart& part : table.parts)
        out["components"].push_back({{"name", part.name},
                                     {"phase_function", part.phase->description()},
                                     {"b", part.b},
                                     {"bb_over_b", part.backscatter_fraction},
                                     {"mean_cosine", part.mean_cosine}});
    return out;
}

Json vsf_json(const WaterReport& report, std::size_t band) {
    const std::vector<double>& angles = file_angles();
    const auto over_angle = [&](auto value) {
        return list(angles.size(),
                    [&](std::size_t i) { return value(angles[i] * std::numbers::pi / 180); });
    };
    const CoefficientTable& uniform = report.table.uniform;
    Json out;
    out["wavelength_nm"] = report.table.wavelengths_nm[band];
    out["total"] = over_angle([&](double psi) { return uniform.vsf(band, psi); });
    // Lists in the order of `components` and `constituents`: names need not be unique.
    out["components"] = Json::array();
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        out["components"].push_back(
            over_angle([&](double psi) { return uniform.vsf(band, part, psi); }));
    out["constituents"] = Json::array();
    for (const CoefficientTable& constituent : report.table.constituents)
        out["constituents"].push_back(
            over_angle([&](double psi) { return constituent.vsf(band, psi); }));
    return out;
}

}  // namespace

std::string water_json(const WaterReport& report) {
    const WaterTable& water = report.table;
    Json json;
    json["uwvdb"] = program_version();
    json["water"] = report.title;
    json["sources"] = report.sources;
    json["warnings"] = water.warnings;
    json["units"] = {{"coefficients", "1/m; of constituents 1/m per unit of concentration"},
                     {"vsf", "1/(m sr); of constituents per unit of concentration"},
                     {"attenuation_length", "m"},
                     {"angles", "degrees; 0 is forward"}};
    json["wavelengths_nm"] = water.wavelengths_nm;
    json["small_ppm"] = water.small_ppm;
    json["large_ppm"] = water.large_ppm;
    json["uniform"] = coefficients(water.uniform);
    json["uniform"]["attenuation_length"] = list(water.wavelengths_nm.size(), [&](std::size_t i) {
        return 1 / water.uniform.attenuation(i);
    });
    json["constituents"] = Json::array();
    for (const CoefficientTable& constituent : water.constituents)
        json["constituents"].push_back(coefficients(constituent));
    json["vsf"]["angles_deg"] = file_angles();
    json["vsf"]["bands"] = Json::array();
    for (const std::size_t band : report.vsf_bands)
        json["vsf"]["bands"].push_back(vsf_json(report, band));
    // Names of grids come from users' files and need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace uw
