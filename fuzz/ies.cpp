#include "core/lamps/ies_file.h"
#include "fuzz/fuzzing.h"

UWVDB_FUZZ(data, size) {
    using namespace uw;
    fuzz::parse([&] { parse_ies(fuzz::text_of(data, size), "lamp.ies"); });
    return 0;
}
