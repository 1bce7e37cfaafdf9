#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cli/render/output_files.h"
#include "core/image/film.h"
#include "core/image/image_writer.h"
#include "render/scene_assembly.h"

namespace uw {

/// What an image's header says that follows from the scene's description alone: an image of the
/// same scene, frame and program has the same.
ImageMetadata metadata_of(const SceneDesc& scene, std::optional<int> frame);

/// All that an image's header says.
ImageMetadata metadata_of(const AssembledScene& scene, std::optional<int> frame);

/// Prints one line.
using SayCallback = std::function<void(const std::string& line)>;

/// Writes the EXR and its preview, each whole or not at all; says where they are and what exposure
/// the preview has, and warns of an image that is black or empty in part. Throws IoError.
void write_images(const OutputFiles& files, const Film& film, ImageMetadata metadata,
                  const SayCallback& say, const SayCallback& warn);

}  // namespace uw
