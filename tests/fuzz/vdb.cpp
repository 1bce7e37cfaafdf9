#include "tests/fuzz/volume_fuzzing.h"

UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    fuzz::read_volume_file(folder.write("volume.vdb", fuzz::text_of(data, size)));
    return 0;
}
