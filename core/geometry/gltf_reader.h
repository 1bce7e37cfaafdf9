#pragma once

#include <filesystem>
#include <memory>
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

/// Where what a glTF file counts as objects is at a moment.
struct GltfMoment {
    std::vector<Affine> file_from_object;  ///< by object, in the order of MeshFile::objects
    std::vector<bool> deforms;             ///< by object: its vertices are not where that says
    /// x, y, z in the file's space of the vertices of all objects that deform: the first ones of
    /// MeshFile::mesh, at all times the same.
    std::vector<float> vertices;
};

/// A glTF file that is open, so that it can be read as it is at several times: it keeps what it has
/// read of buffers and textures.
class GltfSource {
  public:
    /// Throws IoError; InputError for damaged files and unknown required extensions.
    GltfSource(std::filesystem::path file, const GltfUse& use);
    GltfSource(const GltfSource&) = delete;
    GltfSource& operator=(const GltfSource&) = delete;
    ~GltfSource();

    /// Reads the meshes that the file's scene shows, and names its nodes and materials; degenerate
    /// triangles and invalid corners are kept. `time` [s] is that of its animations; without one,
    /// nodes are as they are written. Vertices of morph targets and skins are where these have
    /// them; they come first. A mesh that several nodes show is shared unless it is small or
    /// deforms (MeshFile::shared). Points and lines are skipped. Adds one warning that lists the
    /// unused features of the file, and one that names what would move. Throws InputError for
    /// damaged files, and for images that cannot be read.
    MeshFile read(const std::optional<double>& time, std::vector<std::string>& warnings);

    /// The same without meshes, and without vertices. Throw likewise.
    GltfMoment moment(double time);
    std::vector<Affine> placements(double time);

  private:
    struct Parts;

    GltfUse use_;
    std::filesystem::path file_;
    std::unique_ptr<Parts> parts_;
};

}  // namespace uw
