#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "core/geometry/surfaces.h"
#include "core/scene/scene_desc.h"
#include "render/measures/picture_numbers.h"

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

/// What --object names, as numbers of the layer `id`.
struct ChosenObject {
    std::string name;
    std::vector<std::uint32_t> ids;  // ascending
};

/// All of an entry of `geometry`, by its number from 1 or its name if no other has it; else what
/// has the name in a file (SurfaceNames). Throws UsageError that names the entries there are.
ChosenObject chosen_object(const std::string& object, const std::vector<GeometryDesc>& geometry,
                           const SurfaceNames& names);

/// Throws UsageError if the arguments name no part of the image of `scene` within `window`, as far
/// as that can be told before the files of `geometry` are read.
void check_parts(const PartArguments& arguments, const SceneDesc& scene, const PixelWindow& window);

/// The whole image, then the parts. `film` has the layer id if an object is named. An object that
/// is not in the image is left out. Throws as check_parts and chosen_object.
std::vector<PicturePart> picture_parts(const PartArguments& arguments, const SceneDesc& scene,
                                       const SurfaceNames& names, const Film& film,
                                       const LayerPlan& plan);

/// One number of a part of an image, by the name that it has in tables and JSON
/// (docs/command-line.md).
struct NumberColumn {
    std::string_view name;
    /// Empty: the image has no such number.
    std::optional<double> (*value)(const LightNumbers& numbers);
};

/// All of them, in the order of tables.
std::span<const NumberColumn> number_columns();

/// A number as a cell of a CSV: empty for a number that there is not, `inf` for an infinite one.
std::string number_cell(const std::optional<double>& value);

/// The names of all columns, and the values of one row, each after a comma.
std::string number_names_csv();
std::string number_values_csv(const LightNumbers& numbers);

/// Those that matter most, aligned, a line for each part and lamp under a line of names.
std::string numbers_text(std::span<const PartNumbers> rows);

}  // namespace uw
