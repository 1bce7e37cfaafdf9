#pragma once

#include <string>
#include <vector>

#include "core/scene/camera_desc.h"
#include "dataset/view_record.h"

namespace uw {

/// All views of one draw, in their order, once they are written: what formats make tables of.
struct CompleteSequence {
    const DatasetDefinition& definition;
    std::size_t draw = 0;
    std::string folder;  // DatasetDefinition::folder
    std::vector<ViewRecord> records;

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

}  // namespace uw
