#include "cli/render/picture_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

PixelWindow window_of(const std::array<int, 4>& pixels) {
    return {pixels[0], pixels[1], pixels[2], pixels[3]};
}

std::string list_of(const std::vector<GeometryDesc>& geometry) {
    std::string text;
    for (std::size_t i = 0; i < geometry.size(); ++i)
        text += fmt::format("{}{} ({})", i == 0 ? "" : ", ", i + 1, object_name(geometry[i]));
    return text.empty() ? "no objects" : text;
}

[[noreturn]] void refuse_object(const std::string& object,
                                const std::vector<GeometryDesc>& geometry) {
    throw UsageError(fmt::format("--object {}: no such object; the scene has {}", printable(object),
                                 list_of(geometry)));
}

// The entry by its number from 1, or the only one of that name; none if it is no entry. Throws
// UsageError if there are several.
std::optional<std::size_t> entry_called(const std::string& object,
                                        const std::vector<GeometryDesc>& geometry) {
    double number = 0;
    if (parse_number(object, number) == NumberText::number && number >= 1 &&
        number <= static_cast<double>(geometry.size()) && number == std::floor(number))
        return static_cast<std::size_t>(number) - 1;
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < geometry.size(); ++i) {
        if (object_name(geometry[i]) != object) continue;
        if (found)
            throw UsageError(
                fmt::format("--object {}: there are several; give the number of one, "
                            "of {}",
                            printable(object), list_of(geometry)));
        found = i;
    }
    return found;
}

}  // namespace

void add_part_options(Options& options, PartArguments& a) {
    options.window("--part", a.pixels, "measure these pixels, too; x1 and y1 are excluded");
    options.text("--object", "NAME", a.object,
                 "measure this object, too: its name, that of its file, its type or its number");
}

std::string object_name(const GeometryDesc& geometry) {
    switch (geometry.type) {
        case GeometryDesc::Type::file:
            return geometry.file.stem().string();
        case GeometryDesc::Type::plane:
            return "plane";
        case GeometryDesc::Type::box:
            return "box";
        case GeometryDesc::Type::sphere:
            return "sphere";
    }
    return "";
}

ChosenObject chosen_object(const std::string& object, const std::vector<GeometryDesc>& geometry,
                           const SurfaceNames& names) {
    const std::optional<std::size_t> entry = entry_called(object, geometry);
    ChosenObject chosen{entry ? object_name(geometry[*entry]) : object, {}};
    for (std::size_t i = 0; i < names.objects.size(); ++i) {
        const SurfaceName& candidate = names.objects[i];
        if (entry ? candidate.entry == *entry : candidate.name == object)
            chosen.ids.push_back(static_cast<std::uint32_t>(i + 1));
    }
    if (!entry && chosen.ids.empty()) refuse_object(object, geometry);
    return chosen;
}

void check_parts(const PartArguments& a, const SceneDesc& scene, const PixelWindow& window) {
    const bool has_files =
        std::ranges::count(scene.geometry, GeometryDesc::Type::file, &GeometryDesc::type) > 0;
    if (!a.object.empty() && !entry_called(a.object, scene.geometry) && !has_files)
        refuse_object(a.object, scene.geometry);
    if (!a.pixels) return;
    const PixelWindow part = window_of(*a.pixels);
    if (part.x0 < window.x0 || part.y0 < window.y0 || part.x1 > window.x1 || part.y1 > window.y1 ||
        part.x0 >= part.x1 || part.y0 >= part.y1)
        throw UsageError(fmt::format(
            "--part {},{},{},{}: not a part of the pixels {},{},{},{} of the image", part.x0,
            part.y0, part.x1, part.y1, window.x0, window.y0, window.x1, window.y1));
}

std::vector<PicturePart> picture_parts(const PartArguments& a, const SceneDesc& scene,
                                       const SurfaceNames& names, const Film& film,
                                       const LayerPlan& plan) {
    const PixelWindow& window = film.window();
    check_parts(a, scene, window);
    std::vector<PicturePart> parts{
        {"image", pixels_within({0, 0, window.width(), window.height()}, window.width())}};
    if (a.pixels) {
        PixelWindow part = window_of(*a.pixels);
        part = {part.x0 - window.x0, part.y0 - window.y0, part.x1 - window.x0, part.y1 - window.y0};
        parts.push_back({"part", pixels_within(part, window.width())});
    }
    if (a.object.empty()) return parts;
    const ChosenObject object = chosen_object(a.object, scene.geometry, names);
    PicturePart part{object.name, {}};
    const std::size_t stride = film.channel_names().size();
    const auto ids = film.values().subspan(static_cast<std::size_t>(plan.first_channel(Layer::id)));
    for (const std::size_t pixel : parts.front().pixels) {
        if (std::ranges::binary_search(object.ids, static_cast<std::uint32_t>(ids[pixel * stride])))
            part.pixels.push_back(pixel);
    }
    if (!part.pixels.empty()) parts.push_back(std::move(part));
    return parts;
}

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
    NumberColumn{"evenness", surfaces<&Evenness::min_to_mean>},
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
