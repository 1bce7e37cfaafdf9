#include "tests/fuzz/mesh_fuzzing.h"

UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    fuzz::read_mesh_file(folder.write("mesh.ply", fuzz::text_of(data, size)));
    return 0;
}
