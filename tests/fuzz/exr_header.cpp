#include "core/image/exr_file.h"
#include "tests/fuzz/fuzzing.h"

// The headers of images, which --resume reads.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    const std::filesystem::path file = folder.write("frame.exr", fuzz::text_of(data, size));
    read_exr_header(file);  // does not throw
    return 0;
}
