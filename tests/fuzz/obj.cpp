#include "tests/fuzz/mesh_fuzzing.h"

// The mesh up to a line "%%", then its library of materials.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    constexpr std::string_view k_border = "\n%%\n";
    std::string_view mesh = fuzz::text_of(data, size), library;
    if (const std::size_t border = mesh.find(k_border); border != std::string_view::npos) {
        library = mesh.substr(border + k_border.size());
        mesh = mesh.substr(0, border + 1);
    }
    folder.write("mesh.mtl", library);
    fuzz::read_mesh_file(folder.write("mesh.obj", mesh));
    return 0;
}
