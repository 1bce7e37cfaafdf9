#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// The files of a vehicle's sensors, which follow from a scene without its images.

/// A text file by its name, relative to the folder of the files.
struct NamedText {
    std::string name, text;
};

/// The most readings of a sensor that are written, which are held in memory.
inline constexpr double k_max_readings = 5'000'000;

/// The files of the sensors from the first to the last of the times `span` [s]:
///
/// - NAME.csv: of each sensor, with `stamp_ns` of the clock of the poses (FrameStamps)
/// - NAME.yaml: of each IMU, as Kalibr reads it
/// - trajectory.tum: world_from_body, `rate` poses a second; 0: as many as the fastest sensor, or
///   the scene has frames
/// - trajectory.csv: the same with velocities, in EuRoC's columns; not of a trajectory whose
///   velocity has steps
/// - sensors.json: the poses of sensors and cameras in the body's axes
///
/// `whole`: as it was read. Throws as record_sensor and FrameStamps; InputError for more than
/// k_max_readings, and if the vehicle has no pose in the span.
std::vector<NamedText> sensor_files(const SceneDesc& whole, const TimeRange& span, double rate = 0);

/// Whether the scene has an IMU.
bool has_imu(const SceneDesc& scene);

/// EuRoC's folders of the IMUs, imu0 and so on, each with data.csv and sensor.yaml, and
/// state_groundtruth_estimate0 of the first, which is EuRoC's body. Throws as sensor_files;
/// InputError for stamps that EuRoC cannot tell (euroc_stamp).
std::vector<NamedText> euroc_imu_files(const SceneDesc& whole, const TimeRange& span);

/// The first line of EuRoC's state_groundtruth_estimate0/data.csv.
extern const char* const k_euroc_truth_header;

/// EuRoC's T_BS, with its name: body_from_sensor.
std::string euroc_pose_yaml(const Affine& body_from_sensor);

/// The times of the first and the last frame of a set [s], in the scene of one of its draws.
TimeRange span_of_frames(const DatasetDefinition& definition, const SceneDesc& whole);

/// The poses of a draw's cameras in the axes of the first IMU, imu_from_camera; none without an
/// IMU. They are a file of each draw, relative to the set's folder, from which its tables are made.
std::string imu_mounts_file(const DatasetDefinition& definition, std::size_t draw);
std::string imu_mounts_text(const DatasetDefinition& definition, const SceneDesc& whole);
/// Throws IoError, and InputError for anything but imu_mounts_text's of as many cameras.
std::vector<Affine> read_imu_mounts(const std::filesystem::path& file, std::size_t cameras);

}  // namespace uw
