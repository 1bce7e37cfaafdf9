#include "core/geometry/gltf_reader.h"
#include "tests/fuzz/mesh_fuzzing.h"

// Both kinds: a GLB begins with its mark.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    const std::string_view content = fuzz::text_of(data, size);
    const std::string name = content.starts_with("glTF") ? "mesh.glb" : "mesh.gltf";
    const auto file = folder.write(name, content);
    fuzz::read_mesh_file(file);
    // As its animations have it, with the vertices that flow compares.
    fuzz::read_mesh_file(file, 0.5);
    fuzz::parse([&] {
        const GltfMoment moment = GltfSource(file, {}).moment(0.25);
        if (moment.deforms.size() != moment.file_from_object.size()) __builtin_trap();
    });
    return 0;
}
