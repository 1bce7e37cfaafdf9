#include "media/vdb/openvdb_grids.h"

namespace uw {

void initialize_openvdb() {
    static const bool done = (openvdb::initialize(), true);
    static_cast<void>(done);
}

}  // namespace uw
