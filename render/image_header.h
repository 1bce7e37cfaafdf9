#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/output_files.h"
#include "core/geometry/surfaces.h"
#include "core/image/pixel_image.h"
#include "render/renderer.h"

namespace uw {

/// Whether --layers requests a layer of numbers that stand for names: `id` or `material`.
bool requests_ids(std::string_view layers);

/// Returns the file of the table of ids of an image: "out_ids.csv" for "out.exr".
std::filesystem::path id_table_beside(const std::filesystem::path& image);

/// Adds the names behind the numbers of those layers to an image's header: `uwvdb/id_names` and
/// `uwvdb/material_names`, JSON objects of names by number.
void add_id_names(const SurfaceNames& names, ImageMetadata& metadata);

/// Adds the manifests of an image's mattes, if its channels have any: identifiers by name, under
/// the keys of Cryptomatte's specification.
void add_matte_manifests(const SurfaceNames& names, const std::vector<std::string>& channel_names,
                         ImageMetadata& metadata);

/// Writes the names of ids as a CSV: layer, number, name, and the entry of `geometry` of the
/// object. out.commit() reports errors of writing.
void write_id_table(OutputFile& out, const SurfaceNames& names);

/// Returns the part of an image's header that follows from the scene's description alone; it is the
/// same for images of the same scene, frame, request and program.
ImageMetadata metadata_of(const ImageScene& image, std::optional<int> frame,
                          const PathRequest& paths = {});

/// Returns the whole header of an image, whose report is `report`.
ImageMetadata metadata_of(const AssembledScene& scene, std::optional<int> frame,
                          const PathRequest& paths = {}, const RenderReport& report = {});

}  // namespace uw
