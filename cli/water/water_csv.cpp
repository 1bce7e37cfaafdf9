#include "cli/water/water_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/base/version.h"

namespace uw {

namespace {

/// A field of RFC 4180. Names come from users' files.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

void add(std::string& row, const std::string& text) {
    row += (row.empty() ? "" : ",") + field(text);
}

void add(std::string& row, double value) {
    add(row, std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string());
}

std::string comment(const WaterReport& report, const std::string& what) {
    std::string out = fmt::format("# {}: {}", report.title, what);
    for (const std::string& source : report.sources) out += " | " + source;
    for (char& c : out)
        if (c == '\n' || c == '\r') c = ' ';
    return out + fmt::format(" | uwvdb {}\n", program_version());
}

/// "_per_m", "_per_m_per_ppm", "_per_m_per_unit".
std::string unit_suffix(const CoefficientTable& table, const std::string& per) {
    if (table.unit.empty()) return per;
    return per + (table.unit == "1" ? "_per_unit" : "_per_" + table.unit);
}

void name_coefficients(const CoefficientTable& table, std::string& header) {
    const std::string before = table.name.empty() ? "" : table.name + "_";
    const std::string after = unit_suffix(table, "_per_m");
    for (const char* name : {"a", "b", "c", "bb"})
        add(header, fmt::format("{}{}{}", before, name, after));
    for (const char* name : {"bb_over_b", "albedo", "mean_cosine"}) add(header, before + name);
}

void add_coefficients(const CoefficientTable& table, std::size_t i, std::string& row) {
    add(row, table.absorption[i]);
    add(row, table.scattering(i));
    add(row, table.attenuation(i));
    add(row, table.backscattering(i));
    add(row, table.backscatter_fraction(i));
    add(row, table.albedo(i));
    add(row, table.mean_cosine(i));
}

}  // namespace

std::string water_coefficients_csv(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string header;
    add(header, std::string("wavelength_nm"));
    name_coefficients(water.uniform, header);
    add(header, std::string("attenuation_length_m"));
    for (const ScatteringPart& part : water.uniform.parts) add(header, "b_" + part.name + "_per_m");
    for (const CoefficientTable& constituent : water.constituents)
        name_coefficients(constituent, header);
    std::string out = comment(report,
                              "coefficients of the water everywhere, then of what grids "
                              "add, per unit of its concentration") +
                      header + "\n";
    for (std::size_t i = 0; i < water.wavelengths_nm.size(); ++i) {
        std::string row;
        add(row, water.wavelengths_nm[i]);
        add_coefficients(water.uniform, i, row);
        add(row, 1 / water.uniform.attenuation(i));
        for (const ScatteringPart& part : water.uniform.parts) add(row, part.b[i]);
        for (const CoefficientTable& constituent : water.constituents)
            add_coefficients(constituent, i, row);
        out += row + "\n";
    }
    return out;
}

std::string water_vsf_csv(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string header = "wavelength_nm,angle_deg,total_per_m_per_sr";
    for (const ScatteringPart& part : water.uniform.parts) add(header, part.name + "_per_m_per_sr");
    for (const CoefficientTable& constituent : water.constituents)
        add(header, constituent.name + unit_suffix(constituent, "_grid_per_m_per_sr"));
    std::string out = comment(report,
                              "volume scattering function of the water everywhere and of "
                              "its components, then of what grids add") +
                      header + "\n";
    for (const std::size_t band : report.vsf_bands)
        for (const double angle : file_angles()) {
            const double psi = angle * std::numbers::pi / 180;
            std::string row;
            add(row, water.wavelengths_nm[band]);
            add(row, angle);
            add(row, water.uniform.vsf(band, psi));
            for (std::size_t part = 0; part < water.uniform.parts.size(); ++part)
                add(row, water.uniform.vsf(band, part, psi));
            for (const CoefficientTable& constituent : water.constituents)
                add(row, constituent.vsf(band, psi));
            out += row + "\n";
        }
    return out;
}

}  // namespace uw
