#include "cli/water/water_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

constexpr double k_degree = std::numbers::pi / 180;
constexpr std::size_t k_narrowest = 9;

/// Columns of right-aligned cells, each as wide as its widest cell.
class TextTable {
  public:
    void add_column(std::string name, std::string unit) {
        columns_.push_back({std::move(name), std::move(unit)});
    }
    void add(std::size_t column, double value) {
        // Column 0 is the wavelength or angle, printed with the digits given.
        const int digits = column == 0 ? 8 : 4;
        columns_[column].push_back(std::isfinite(value) ? fmt::format("{:.{}g}", value, digits)
                                                        : "-");
    }
    std::string text() const {
        std::string out;
        for (std::size_t row = 0; row < columns_[0].size(); ++row) {
            for (const std::vector<std::string>& column : columns_) {
                std::size_t width = k_narrowest;
                for (const std::string& cell : column) width = std::max(width, cell.size());
                out += fmt::format("  {:>{}}", column[row], width);
            }
            out += "\n";
        }
        return out;
    }

  private:
    std::vector<std::vector<std::string>> columns_;
};

std::string heading(const std::string& text) {
    return "\n" + text + "\n";
}

/// Unit of a coefficient per unit of concentration: "1/m", "1/m/ppm", "1/m per 1".
std::string per(const std::string& coefficient, const CoefficientTable& table) {
    if (table.unit.empty()) return fmt::format("[{}]", coefficient);
    return fmt::format("[{} per {}]", coefficient, table.unit == "1" ? "unit" : table.unit);
}

std::string coefficients(const WaterTable& water, const CoefficientTable& table) {
    TextTable text;
    const std::string per_metre = per("1/m", table);
    text.add_column("band", "[nm]");
    for (const char* name : {"a", "b", "c", "b_b"}) text.add_column(name, per_metre);
    for (const char* name : {"b_b/b", "b/c", "<cos psi>"}) text.add_column(name, "");
    const bool uniform = table.unit.empty();
    if (uniform) text.add_column("1/c", "[m]");
    const bool split = table.parts.size() > 1;
    if (split)
        for (const ScatteringPart& part : table.parts) text.add_column("b " + part.name, per_metre);
    for (std::size_t i = 0; i < water.wavelengths_nm.size(); ++i) {
        std::vector<double> row{water.wavelengths_nm[i], table.absorption[i],
                                table.scattering(i),     table.attenuation(i),
                                table.backscattering(i), table.backscatter_fraction(i),
                                table.albedo(i),         table.mean_cosine(i)};
        if (uniform) row.push_back(1 / table.attenuation(i));
        if (split)
            for (const ScatteringPart& part : table.parts) row.push_back(part.b[i]);
        for (std::size_t column = 0; column < row.size(); ++column) text.add(column, row[column]);
    }
    return text.text();
}

std::string vsf_text(const WaterReport& report, std::size_t band) {
    const CoefficientTable& uniform = report.table.uniform;
    TextTable text;
    text.add_column("psi", "[deg]");
    text.add_column("total", "[1/(m sr)]");
    const bool split = uniform.parts.size() > 1;
    if (split)
        for (const ScatteringPart& part : uniform.parts) text.add_column(part.name, "[1/(m sr)]");
    for (const CoefficientTable& constituent : report.table.constituents)
        text.add_column(constituent.name + "*", per("1/(m sr)", constituent));
    for (const double angle : printed_angles()) {
        const double psi = angle * k_degree;
        std::vector<double> row{angle, uniform.vsf(band, psi)};
        if (split)
            for (std::size_t part = 0; part < uniform.parts.size(); ++part)
                row.push_back(uniform.vsf(band, part, psi));
        for (const CoefficientTable& constituent : report.table.constituents)
            row.push_back(constituent.vsf(band, psi));
        for (std::size_t column = 0; column < row.size(); ++column) text.add(column, row[column]);
    }
    return text.text();
}

}  // namespace

std::string water_text(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string out = report.title + "\n";
    for (const std::string& line : report.sources) out += "  " + line + "\n";
    out += heading(
        "Coefficients of the water everywhere: absorption a, scattering b, attenuation c = a + b, "
        "backscattering b_b");
    if (water.uniform.parts.size() == 1)
        out += fmt::format("(all scattering is that of: {})\n", water.uniform.parts[0].name);
    out += coefficients(water, water.uniform);
    for (const CoefficientTable& constituent : water.constituents) {
        out += heading(
            fmt::format("What grids add: '{}', per {}", constituent.name,
                        constituent.unit == "1" ? "unit of the grid's value" : constituent.unit));
        out += coefficients(water, constituent);
    }
    for (const std::size_t band : report.vsf_bands) {
        out += heading(fmt::format(
            "Volume scattering function beta(psi) at {:g} nm; psi is the change of direction: 0 "
            "forward, 180 backward",
            water.wavelengths_nm[band]));
        out += vsf_text(report, band);
    }
    return out;
}

}  // namespace uw
