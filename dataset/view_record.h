#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json/json.h"
#include "core/scene/camera_desc.h"
#include "dataset/definition.h"
#include "dataset/set_files.h"

namespace uw {

/// What a data set knows of a view that has been written: everything that its tables of cameras,
/// poses and files are made of. Its file is written last, so that a view which has one is complete.
struct ViewRecord {
    View view;
    std::string set;    // the sum of the definition (sum_of)
    double time = 0;    // [s]
    CameraDesc camera;  // resolution, intrinsics, distortion, port, pose: no more of it
    std::vector<SetFile> files;

    /// The file with a role; null if there is none.
    const SetFile* file(std::string_view role) const;
};

/// By which records know their set.
std::string sum_of(const DatasetDefinition& definition);

/// The name of a view's record, relative to the set's folder.
std::string record_file(const DatasetDefinition& definition, const View& view);

std::string record_text(const ViewRecord& record);

/// The record of a view in the set's folder; none if there is none, or it is damaged or of another
/// set than that with this sum.
std::optional<ViewRecord> read_record(const std::filesystem::path& folder,
                                      const DatasetDefinition& definition, const std::string& sum,
                                      const View& view);

}  // namespace uw
