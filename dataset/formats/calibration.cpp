#include <fmt/format.h>

#include <array>
#include <string>

#include "camera/calibration/calibration.h"
#include "dataset/formats/formats.h"

namespace uw {

namespace {

void write_camera_files(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        const CameraDesc& desc = sequence.at(0, camera).camera;
        const std::string& name = definition.cameras[camera];
        for (const CalibrationFormat format : calibration_formats()) {
            if (!calibration_obstacle(format, desc).empty()) continue;
            const char* const ending = format == CalibrationFormat::colmap ? "txt" : "yaml";
            files.add_bytes("calibration",
                            fmt::format("{}calibration/{}{}.{}", sequence.folder,
                                        name.empty() ? "" : name + ".", word_of(format), ending),
                            write_calibration(format, desc));
        }
    }
}

}  // namespace

DatasetFormat calibration_format() {
    return {
        .name = "calibration",
        .summary = "calibration/: the cameras as OpenCV, ROS, Kalibr, COLMAP and others have them",
        .card =
            "`calibration/`: each camera's resolution, intrinsics, distortion and port in the "
            "formats that can express them, as `uwvdb calibration` writes them.",
        .complete = write_camera_files};
}

}  // namespace uw
