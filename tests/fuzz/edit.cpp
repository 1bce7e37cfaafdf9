#include "edit/document/scene_text.h"
#include "tests/fuzz/fuzzing.h"

// What windows of the editor send: changes of a scene's text, lines "set PATH VALUE",
// "remove PATH", "append PATH VALUE", "duplicate PATH NAME", "rename PATH NAME", up to a line "%%"
// after which the scene follows.
namespace {

constexpr std::string_view k_scene = R"(uwvdb: 1
camera: {resolution: [16, 9], intrinsics: {fov_x: 60}}  # small
lamps:
  - &left {name: left, position: [-1, 0, 0], intensity: 50}
  - name: right  # the other
    position: [1, 0, 0]
    intensity: *left
)";

std::string_view take_word(std::string_view& line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    return word;
}

void change(uw::SceneText& scene, std::string_view line) {
    const std::string_view operation = take_word(line);
    const std::string_view path = take_word(line);
    if (operation == "set") scene.set(path, line);
    if (operation == "remove") scene.remove(path);
    if (operation == "append") scene.append(path, line);
    if (operation == "duplicate") scene.duplicate(path, line);
    if (operation == "rename") scene.rename(path, line);
}

}  // namespace

UWVDB_FUZZ(data, size) {
    using namespace uw;
    std::string_view text = fuzz::text_of(data, size);
    fuzz::parse([&] {
        constexpr std::string_view k_border = "%%\n";
        const std::size_t border = text.find(k_border);
        const std::string_view own =
            border == std::string_view::npos ? k_scene : text.substr(border + k_border.size());
        SceneText scene{std::string(own), "scene.yaml"};
        std::string_view changes = text.substr(0, border);
        while (!changes.empty()) {
            const auto [line, rest] = fuzz::split_line(changes);
            fuzz::parse([&, line = line] { change(scene, line); });
            changes = rest;
        }
    });
    return 0;
}
