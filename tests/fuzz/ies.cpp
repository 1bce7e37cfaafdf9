#include "core/light/photometric_files.h"
#include "tests/fuzz/fuzzing.h"

UWVDB_FUZZ(data, size) {
    using namespace uw;
    fuzz::parse([&] { parse_ies(fuzz::text_of(data, size), "lamp.ies"); });
    return 0;
}
