#include "core/scene/scene_desc.h"
#include "core/scene/scene_limits.h"
#include "tests/fuzz/fuzzing.h"

// The scene file, and the limits that its values are held to.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    fuzz::parse([&] { check_limits(read_scene_text(fuzz::text_of(data, size), "scene.yaml")); });
    return 0;
}
