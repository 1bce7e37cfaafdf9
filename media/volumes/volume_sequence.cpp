#include "media/volumes/volume_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "media/vdb/vdb_file.h"
#include "media/vdb/vdb_header_reader.h"
#include "media/volumes/adaptive_domain.h"
#include "media/volumes/voxel_size.h"

namespace uw {

namespace {

// Programs may round the transforms of individual frames differently [voxels].
constexpr double k_tolerance = 1e-4;

bool same_place(const Affine& a, const Affine& b) {
    const double voxel = std::cbrt(std::abs(a.determinant()));
    double difference = glm::length(a.offset() - b.offset());
    for (int axis = 0; axis < 3; ++axis)
        difference = std::max(difference, glm::length(a.linear()[axis] - b.linear()[axis]));
    return difference <= k_tolerance * voxel;
}

std::string describe(const Affine& file_from_index) {
    const Matrix3& m = file_from_index.linear();
    const Vector3& origin = file_from_index.offset();
    return fmt::format("voxels of {:.6g} x {:.6g} x {:.6g} from ({:.6g}, {:.6g}, {:.6g})",
                       glm::length(m[0]), glm::length(m[1]), glm::length(m[2]), origin.x, origin.y,
                       origin.z);
}

}  // namespace

void VolumeSequenceCheck::take(const VolumeDesc& frame) {
    const VdbHeader header = read_vdb_header(frame.file, frame.where);
    // Frames of an adaptive domain may lie at different places: each is moved to its own.
    std::optional<AdaptiveDomain> domain = find_adaptive_domain(header);
    if (domain) domain->first = Vector3(0);
    std::vector<Affine> transforms;
    for (const GridMappingDesc& mapping : frame.grids)
        transforms.push_back(with_voxel_size(
            read_file_from_index(header, mapping.grid, mapping.where), frame, domain));
    if (transforms_.empty()) {
        first_ = frame;
        transforms_ = std::move(transforms);
        return;
    }
    for (std::size_t g = 0; g < transforms.size(); ++g) {
        if (same_place(transforms_.at(g), transforms[g])) continue;
        if (domain)
            throw InputError(fmt::format("{}: '{}': {}", frame.grids[g].where, frame.file.string(),
                                         domain->description()));
        throw InputError(
            fmt::format("{}: grid '{}' of '{}' has {}, but that of '{}' has {}; export all frames "
                        "with one transform, or render them in separate runs",
                        frame.grids[g].where, frame.grids[g].grid, frame.file.string(),
                        describe(transforms[g]), first_.file.string(), describe(transforms_[g])));
    }
}

}  // namespace uw
