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

/// Whether --layers asks for numbers that stand for names: `id` or `material`.
bool requests_ids(std::string_view layers);

/// The table's file beside an image: "out_ids.csv" beside "out.exr".
std::filesystem::path id_table_beside(const std::filesystem::path& image);

/// Adds what the numbers of those layers stand for to an image's header: `uwvdb/id_names` and
/// `uwvdb/material_names`, JSON objects of names by number.
void add_id_names(const SurfaceNames& names, ImageMetadata& metadata);

/// Adds the manifests of an image's mattes, if its channels have any: identifiers by name, under
/// the keys of Cryptomatte's specification.
void add_matte_manifests(const SurfaceNames& names, const std::vector<std::string>& channel_names,
                         ImageMetadata& metadata);

/// Writes the ids' names as a CSV: layer, number, name, and the entry of `geometry` it comes from.
/// What cannot be written is for out.commit() to report.
void write_id_table(OutputFile& out, const SurfaceNames& names);

/// The part of an image's header that follows from the scene's description alone: images of the
/// same scene, frame, request and program have the same.
ImageMetadata metadata_of(const ImageScene& image, std::optional<int> frame,
                          const PathRequest& paths = {});

/// The whole header of an image; `report` is about it.
ImageMetadata metadata_of(const AssembledScene& scene, std::optional<int> frame,
                          const PathRequest& paths = {}, const RenderReport& report = {});

}  // namespace uw
