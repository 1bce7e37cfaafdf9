#include "cli/numbers/picture_parts.h"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace uw
