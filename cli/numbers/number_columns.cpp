#include "cli/numbers/number_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace uw {

namespace {

using Value = std::optional<double>;

template <Distribution LightNumbers::*part, double Distribution::*number>
Value light(const LightNumbers& n) {
    return (n.*part).*number;
}

template <double Distribution::*number>
Value multiple(const LightNumbers& n) {
    if (!n.multiple) return std::nullopt;
    return (*n.multiple).*number;
}

template <double PictureNumbers::*number>
Value picture(const LightNumbers& n) {
    return n.picture.*number;
}

template <std::optional<double> PictureNumbers::*number>
Value picture_or_none(const LightNumbers& n) {
    return n.picture.*number;
}

/// None where no surface is seen.
template <double Evenness::*number>
Value surfaces(const LightNumbers& n) {
    if (!n.picture.evenness || n.picture.evenness->pixels == 0) return std::nullopt;
    return (*n.picture.evenness).*number;
}

Value surface_pixels(const LightNumbers& n) {
    if (!n.picture.evenness) return std::nullopt;
    return static_cast<double>(n.picture.evenness->pixels);
}

using N = LightNumbers;
using D = Distribution;
using P = PictureNumbers;

constexpr std::array k_columns{
    NumberColumn{"pixels", [](const N& n) { return Value(static_cast<double>(n.pixels)); }},
    NumberColumn{"direct_mean", light<&N::direct, &D::mean>},
    NumberColumn{"direct_p5", light<&N::direct, &D::percentile5>},
    NumberColumn{"direct_median", light<&N::direct, &D::median>},
    NumberColumn{"direct_p95", light<&N::direct, &D::percentile95>},
    NumberColumn{"forward_mean", light<&N::forward, &D::mean>},
    NumberColumn{"forward_p5", light<&N::forward, &D::percentile5>},
    NumberColumn{"forward_median", light<&N::forward, &D::median>},
    NumberColumn{"forward_p95", light<&N::forward, &D::percentile95>},
    NumberColumn{"backscatter_mean", light<&N::backscatter, &D::mean>},
    NumberColumn{"backscatter_p5", light<&N::backscatter, &D::percentile5>},
    NumberColumn{"backscatter_median", light<&N::backscatter, &D::median>},
    NumberColumn{"backscatter_p95", light<&N::backscatter, &D::percentile95>},
    NumberColumn{"multiple_mean", multiple<&D::mean>},
    NumberColumn{"multiple_p5", multiple<&D::percentile5>},
    NumberColumn{"multiple_median", multiple<&D::median>},
    NumberColumn{"multiple_p95", multiple<&D::percentile95>},
    NumberColumn{"signal", picture<&P::signal>},
    NumberColumn{"backscatter", picture<&P::backscatter>},
    NumberColumn{"signal_to_backscatter", picture<&P::signal_to_backscatter>},
    NumberColumn{"contrast", picture<&P::contrast>},
    NumberColumn{"clean_contrast", picture_or_none<&P::clean_contrast>},
    NumberColumn{"lost_to_water", picture_or_none<&P::lost_to_water>},
    NumberColumn{"surface_pixels", surface_pixels},
    NumberColumn{"irradiance_mean", surfaces<&Evenness::mean>},
    NumberColumn{"irradiance_least", surfaces<&Evenness::least>},
    NumberColumn{"irradiance_p5", surfaces<&Evenness::percentile5>},
    NumberColumn{"irradiance_median", surfaces<&Evenness::median>},
    NumberColumn{"irradiance_p95", surfaces<&Evenness::percentile95>},
    NumberColumn{"irradiance_greatest", surfaces<&Evenness::greatest>},
    NumberColumn{"evenness", surfaces<&Evenness::least_to_mean>},
    NumberColumn{"evenness_p5", surfaces<&Evenness::percentile5_to_mean>},
};

constexpr std::array<std::string_view, 8> k_in_text{
    "direct_mean", "forward_mean",    "backscatter_mean", "signal_to_backscatter",
    "contrast",    "irradiance_mean", "evenness",         "evenness_p5"};

}  // namespace

std::span<const NumberColumn> number_columns() {
    return k_columns;
}

std::string number_cell(const std::optional<double>& value) {
    return value ? fmt::format("{:.9g}", *value) : std::string();
}

std::string number_names_csv() {
    std::string text;
    for (const NumberColumn& column : k_columns) text += fmt::format(",{}", column.name);
    return text;
}

std::string number_values_csv(const LightNumbers& numbers) {
    std::string text;
    for (const NumberColumn& column : k_columns) text += "," + number_cell(column.value(numbers));
    return text;
}

std::string numbers_text(std::span<const PartNumbers> rows) {
    std::size_t parts = 4, lamps = 4;
    for (const PartNumbers& row : rows) {
        parts = std::max(parts, row.part.size());
        lamps = std::max(lamps, row.lamp.size());
    }
    std::string text = fmt::format("{:{}}  {:{}}", "part", parts, "lamp", lamps);
    for (const std::string_view name : k_in_text)
        text += fmt::format("  {:>{}}", name, std::max<std::size_t>(name.size(), 9));
    text += "\n";
    for (const PartNumbers& row : rows) {
        text += fmt::format("{:{}}  {:{}}", row.part, parts, row.lamp.empty() ? "all" : row.lamp,
                            lamps);
        for (const std::string_view name : k_in_text) {
            const auto* const column = std::ranges::find(k_columns, name, &NumberColumn::name);
            const Value value = column->value(row.numbers);
            text += fmt::format("  {:>{}}", value ? fmt::format("{:.4g}", *value) : "-",
                                std::max<std::size_t>(name.size(), 9));
        }
        text += "\n";
    }
    return text;
}

}  // namespace uw
