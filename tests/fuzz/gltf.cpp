#include "tests/fuzz/mesh_fuzzing.h"

// Both kinds: a GLB begins with its mark.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    const std::string_view content = fuzz::text_of(data, size);
    const std::string name = content.starts_with("glTF") ? "mesh.glb" : "mesh.gltf";
    fuzz::read_mesh_file(folder.write(name, content));
    return 0;
}
