#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "core/scene/scene_desc.h"
#include "render/measures/lamp_numbers.h"

namespace uw {

/// Which parts of an image to measure, as typed, besides all of it.
struct PartArguments {
    std::optional<std::array<int, 4>> pixels;  // --part x0,y0,x1,y1
    std::string object;                        // --object: a number or a name

    bool any() const { return pixels || !object.empty(); }
};

/// Declares --part and --object.
void add_part_options(Options& options, PartArguments& arguments);

/// What a user calls an entry of `geometry`: the name of its file without ending, or its type.
std::string object_name(const GeometryDesc& geometry);

/// The object that --object names, by its number in the layer `id`: an entry of `geometry`, from 1,
/// or the only one with the name. Throws UsageError that names those there are.
int chosen_object(const std::string& object, const std::vector<GeometryDesc>& geometry);

/// Throws UsageError if the arguments name no part of the image of `scene` within `window`.
void check_parts(const PartArguments& arguments, const SceneDesc& scene, const PixelWindow& window);

/// The whole image, then the parts. `film` has the layer id if an object is named. An object that
/// is not in the image is left out. Throws as check_parts.
std::vector<PicturePart> picture_parts(const PartArguments& arguments, const SceneDesc& scene,
                                       const Film& film, const LayerPlan& plan);

}  // namespace uw
