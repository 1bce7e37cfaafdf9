#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/grid2d.h"
#include "core/geometry/depth_mesh.h"
#include "core/scene/camera_desc.h"

/// Pictures with depth (RGB-D) as surfaces of scenes.
namespace uw {

/// What an image of depths holds: the depth along the optical axis, the distance from the camera's
/// centre, or the disparity to a second camera beside it, fx * baseline / z [pixels].
enum class DepthKind : std::uint8_t { z, range, disparity };
inline constexpr std::array<std::pair<std::string_view, DepthKind>, 3> k_depth_kinds{
    {{"z", DepthKind::z}, {"range", DepthKind::range}, {"disparity", DepthKind::disparity}}};

/// What the user says of the images of depths; what a file says itself need not be said.
struct DepthReading {
    std::optional<DepthKind> kind;
    /// Units of the file per metre or, for disparities, per pixel. Needed for files of whole
    /// numbers.
    std::optional<double> scale;
    std::optional<double> baseline;  // [m]; needed for disparities
    std::optional<double> farthest;  // depths beyond are left out [m]
    std::string channel;             // of an OpenEXR; empty: the one that is known or alone
};

/// Reads an image of depths as 1/z [1/m], 0 where there is none: where the file has 0, less, no
/// finite number, or 1e9 m and more. PNG of 8 or 16 bits, OpenEXR, TIFF and Radiance HDR of floats.
/// In an OpenEXR the channels depth.Z and range.V, as `uwvdb render` writes them, are known.
/// `camera` has the image's size; where its lens has no ray with z > 0 there is no depth. Throws
/// InputError for a wrong file, another size, or an image without depths, UsageError that names the
/// option which is missing, IoError.
Grid2D<double> read_inverse_depth(const std::filesystem::path& file, const DepthReading& reading,
                                  const CameraDesc& camera);

/// A picture and the image of its depths.
struct RgbdPair {
    std::filesystem::path picture, depth;
};

/// The pairs of two folders, in the order of the pictures' names: files of the same name without
/// ending or, where all names are times in seconds, as in sequences of TUM's benchmark, of the
/// nearest time, at most 0.02 s away; pictures without one are left out. Two files are one pair.
/// Throws InputError if there is none, or a name lacks its other half; UsageError for a file and a
/// folder.
std::vector<RgbdPair> rgbd_pairs(const std::filesystem::path& pictures,
                                 const std::filesystem::path& depths);

/// Pixels without depth.
struct DepthHoles {
    std::size_t count = 0;         // connected regions
    std::size_t pixels = 0;        // in all of them
    std::array<int, 4> largest{};  // x, y, width, height of the region with the most pixels
};
DepthHoles find_holes(const Grid2D<double>& inverse_depth);

/// A picture with depth, read.
struct RgbdSurface {
    std::vector<std::byte> picture;  // the file's bytes
    std::string picture_type;        // "image/png"
    DepthMesh mesh;                  // x right, y up, -z forward, as glTF's cameras look [m]
    DepthHoles holes;
    double nearest = 0, median = 0, farthest = 0;  // z [m]
};

/// The width and height of a PNG, JPEG or OpenEXR picture. Throws as read_image.
std::array<int, 2> picture_size(const std::filesystem::path& file);

/// Reads a pair. Throws as read_inverse_depth; InputError for a picture of another size than the
/// camera's, or in a format that a mesh cannot contain.
RgbdSurface read_rgbd(const RgbdPair& pair, const DepthReading& reading, const CameraDesc& camera,
                      const DepthMeshOptions& options);

/// What the colours of the pictures are taken for: diffuse reflectance, or radiance that the
/// surface gives off, as in formulas that fade a picture through water.
enum class PictureMeaning : std::uint8_t { reflectance, emission };
inline constexpr std::array<std::pair<std::string_view, PictureMeaning>, 2> k_picture_meanings{
    {{"reflectance", PictureMeaning::reflectance}, {"emission", PictureMeaning::emission}}};

/// The text of a scene that shows the mesh file `mesh` through the pictures' camera, in water.
/// Where the pictures are reflectance two lamps beside the camera light the `median` depth [m].
std::string rgbd_scene_text(const CameraDesc& camera, const std::string& mesh,
                            PictureMeaning meaning, double median);

}  // namespace uw
