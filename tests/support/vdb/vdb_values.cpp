#include "tests/support/vdb/vdb_values.h"

#include <openvdb/openvdb.h>

namespace uw::test {

std::map<std::string, VdbValues> read_vdb_values(const std::filesystem::path& file) {
    openvdb::initialize();
    openvdb::io::File input(file.string());
    input.open();
    std::map<std::string, VdbValues> result;
    const openvdb::GridPtrVecPtr grids = input.getGrids();
    for (const auto& base : *grids) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        VdbValues& values = result[grid->getName()];
        for (auto entry = grid->beginMeta(); entry != grid->endMeta(); ++entry)
            values.metadata[entry->first] = entry->second->str();
        const auto accessor = grid->getConstAccessor();
        const openvdb::CoordBBox box = base->evalActiveVoxelBoundingBox();
        for (auto at = box.begin(); at != box.end(); ++at) {
            const openvdb::Vec3d p = grid->indexToWorld(*at);
            values.voxels.push_back({Point3{p.x(), p.y(), p.z()},
                                     static_cast<double>(accessor.getValue(*at)),
                                     accessor.isValueOn(*at)});
        }
    }
    return result;
}

}  // namespace uw::test
