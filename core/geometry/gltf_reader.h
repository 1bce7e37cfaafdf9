#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/mesh.h"
#include "core/scene/geometry_desc.h"

namespace uw {

/// The external files that a glTF file refers to: buffers and images, in its order. None for a file
/// that cannot be read or is damaged; the actual reader reports what is wrong.
std::vector<std::filesystem::path> files_named_by_gltf(const std::filesystem::path& file);

/// The keys of the animations that move nodes of a glTF file.
struct GltfKeys {
    TimeRange range;            ///< from the first to the last
    std::vector<double> times;  ///< of all, ascending, each once [s]; none if they cannot be read
};

/// The keys of a file; none if nothing in it moves. A file that cannot be read has none: loading it
/// reports the error.
std::optional<GltfKeys> gltf_keys(const std::filesystem::path& file);

/// The usual frame rate at which all keys of a file are at whole frames; none if there is no such
/// rate, or if the keys are so few that they would fit many rates. The format gives times in
/// seconds and does not define frames.
std::optional<double> frame_rate_of(const std::vector<double>& key_times);

/// Whether all of these times [s] are at whole frames of a rate, up to the rounding of files.
bool are_whole_frames(const std::vector<double>& times, double rate);

/// file_from_node of everything that a glTF file counts as an object, in the order of
/// MeshFile::objects, where its animations have it at `time` [s]. Throws IoError, InputError.
std::vector<Affine> gltf_placements(const std::filesystem::path& file, double time);

/// Reads the meshes that a glTF file's scene shows, and names its nodes and materials; degenerate
/// triangles and invalid corners are kept. A mesh that several nodes show is shared unless it is
/// small (MeshFile::shared). Points and lines are skipped. Adds one warning that lists the unused
/// features of the file, and one that names what would move. Throws IoError; InputError for damaged
/// files, for unknown required extensions, and for images that cannot be read.
MeshFile read_gltf(const std::filesystem::path& file, const GltfUse& use,
                   std::vector<std::string>& warnings);

}  // namespace uw
