#include "cli/numbers/picture_parts.h"

#include <fmt/format.h>

#include <cmath>
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

}  // namespace

void add_part_options(Options& options, PartArguments& a) {
    options.window("--part", a.pixels, "measure these pixels, too; x1 and y1 are excluded");
    options.text("--object", "NAME", a.object,
                 "measure this object, too: the name of its file, its type or its number");
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

int chosen_object(const std::string& object, const std::vector<GeometryDesc>& geometry) {
    double number = 0;
    if (parse_number(object, number) == NumberText::number && number >= 1 &&
        number <= static_cast<double>(geometry.size()) && number == std::floor(number))
        return static_cast<int>(number);
    std::optional<int> found;
    for (std::size_t i = 0; i < geometry.size(); ++i) {
        if (object_name(geometry[i]) != object) continue;
        if (found)
            throw UsageError(
                fmt::format("--object {}: there are several; give the number of one, "
                            "of {}",
                            printable(object), list_of(geometry)));
        found = static_cast<int>(i) + 1;
    }
    if (found) return *found;
    throw UsageError(fmt::format("--object {}: no such object; the scene has {}", printable(object),
                                 list_of(geometry)));
}

void check_parts(const PartArguments& a, const SceneDesc& scene, const PixelWindow& window) {
    if (!a.object.empty()) chosen_object(a.object, scene.geometry);
    if (!a.pixels) return;
    const PixelWindow part = window_of(*a.pixels);
    if (part.x0 < window.x0 || part.y0 < window.y0 || part.x1 > window.x1 || part.y1 > window.y1 ||
        part.x0 >= part.x1 || part.y0 >= part.y1)
        throw UsageError(fmt::format(
            "--part {},{},{},{}: not a part of the pixels {},{},{},{} of the image", part.x0,
            part.y0, part.x1, part.y1, window.x0, window.y0, window.x1, window.y1));
}

std::vector<PicturePart> picture_parts(const PartArguments& a, const SceneDesc& scene,
                                       const Film& film, const LayerPlan& plan) {
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
    const int object = chosen_object(a.object, scene.geometry);
    PicturePart part{object_name(scene.geometry[static_cast<std::size_t>(object) - 1]), {}};
    const std::size_t stride = film.channel_names().size();
    const auto ids = film.values().subspan(static_cast<std::size_t>(plan.first_channel(Layer::id)));
    for (const std::size_t pixel : parts.front().pixels)
        if (ids[pixel * stride] == static_cast<float>(object)) part.pixels.push_back(pixel);
    if (!part.pixels.empty()) parts.push_back(std::move(part));
    return parts;
}

}  // namespace uw
