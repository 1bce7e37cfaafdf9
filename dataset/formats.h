#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/scene_desc.h"
#include "core/scene/trajectory.h"
#include "dataset/definition.h"
#include "dataset/pinhole_fit.h"
#include "dataset/sensor_files.h"
#include "dataset/set_files.h"
#include "dataset/view.h"

namespace uw {

/// All views of one draw, in their order, once they are written, from which formats make tables.
struct CompleteSequence {
    const DatasetDefinition& definition;
    std::size_t draw = 0;
    std::string folder;  // DatasetDefinition::folder
    std::vector<ViewRecord> records;
    /// The fit to each camera with a port (fit_pinholes); none if no format asks for it.
    PinholeFits fits;
    /// The set's cameras in the axes of the first IMU (imu_mounts_file); none if no format asks for
    /// them or the scene has no IMU.
    std::vector<Affine> imu_from_cameras;

    /// A camera of the set without its port, for formats that cannot describe ports.
    CameraDesc portless(std::size_t camera) const {
        return without_port(at(0, camera).camera,
                            camera < fits.size() ? fits[camera] : std::nullopt,
                            definition.pinhole_fit);
    }
    /// The view of a frame and a camera, by their places.
    const ViewRecord& at(std::size_t frame, std::size_t camera) const {
        return records[frame * definition.cameras.size() + camera];
    }
};

/// A file of a view as a table in the folder `from` of the sequence names it: "images/000012.png".
inline std::string within(const CompleteSequence& sequence, const std::string& from,
                          const SetFile& file) {
    return file.path.substr(sequence.folder.size() + from.size());
}

/// The points of COLMAP's model as nerfstudio takes them, beside its transforms.json; of sets in
/// both formats.
inline constexpr const char* k_point_cloud_file = "sparse_pc.ply";

/// A camera's pose in the world, its quaternion with w >= 0.
inline Pose camera_pose(const CameraDesc& camera) {
    Pose pose = pose_of(camera.world_from_camera);
    Rotation& q = pose.rotation;
    if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
    return pose;
}

/// A format of data sets: what is rendered for it, and which files it has.
struct DatasetFormat {
    std::string_view name;     // as --format takes it
    std::string_view summary;  // one line, for --help
    /// Its paragraph in a set's data card, in Markdown: folders, units, conventions.
    std::string_view card;
    /// The layers that it is made of, as LayerPlan takes them; empty: the image alone.
    std::string_view layers = {};
    bool needs_points = false;  // ViewImages::points
    bool needs_images = false;  // those of png, which is then written as well
    /// How it represents a camera behind a port: it describes the port (or has no cameras); it
    /// cannot describe ports, and has the camera in air, or fitted with --pinhole-fit; or it always
    /// has the camera in air, because one of its files has no room for the distortion of a fit.
    enum class Ports { described, fitted, in_air };
    Ports ports = Ports::described;
    /// Throws UsageError of one line for a set that it cannot express. `scene` is that of the first
    /// view, with its rig. May be null.
    void (*check)(const DatasetDefinition& definition, const SceneDesc& scene) = nullptr;
    /// Returns the files of a draw that follow from its scene alone, as it was read, by their names
    /// relative to the set's folder. They are written before the views. May be null.
    std::vector<NamedText> (*share)(const DatasetDefinition& definition, std::size_t draw,
                                    const SceneDesc& scene) = nullptr;
    /// Writes the files of one view; called from several threads for different views. May be null.
    void (*write_view)(const ViewImages& images, SetFiles& files) = nullptr;
    /// Writes the files that need all views of a draw. May be null.
    void (*complete)(const CompleteSequence& sequence, SetFiles& files) = nullptr;
};

/// Each format is in the file of its family. Private to this folder.

DatasetFormat png_format();
DatasetFormat depth_format();
DatasetFormat mask_format();
DatasetFormat ids_format();
DatasetFormat plume_format();
DatasetFormat clean_format();
DatasetFormat exr_format();
DatasetFormat numpy_format();
DatasetFormat flow_format();
DatasetFormat disparity_format();
DatasetFormat kitti_format();
DatasetFormat colmap_format();
DatasetFormat nerfstudio_format();
DatasetFormat tum_format();
DatasetFormat euroc_format();
DatasetFormat sensors_format();
DatasetFormat mcap_format();
DatasetFormat calibration_format();

/// Every format, in the order in which --help lists them.
std::span<const DatasetFormat> dataset_formats();

/// The format of a name. Throws UsageError that lists the existing ones.
const DatasetFormat& dataset_format(std::string_view name);

/// The layers that a set's formats are made of, as LayerPlan takes them.
std::string layers_of(const DatasetDefinition& definition);

/// Whether any of its formats needs ViewImages::points.
bool needs_points(const DatasetDefinition& definition);

/// The set's formats whose cameras know no port and can be fitted by --pinhole-fit, as --format
/// takes them; empty if there are none.
std::string fittable_formats(const DatasetDefinition& definition);

/// The set's formats that have cameras behind ports as they are in air, likewise.
std::string formats_in_air(const DatasetDefinition& definition);

/// Writes the files of a view in every format of its set, then its record. Throws IoError and
/// InputError.
void write_view(const std::filesystem::path& folder, const std::string& sum,
                const ViewImages& images);

/// The record of a view if all of its files are unchanged, by their checksums; else none.
std::optional<ViewRecord> complete_record(const std::filesystem::path& folder,
                                          const DatasetDefinition& definition,
                                          const std::string& sum, const View& view);

}  // namespace uw
