#include "render/measures/lamp_numbers.h"

#include <utility>

namespace uw {

std::vector<PartNumbers> part_numbers(const MeasuredImage& image,
                                      const std::vector<PicturePart>& parts,
                                      const std::string& lamp) {
    std::vector<PartNumbers> numbers;
    for (const PicturePart& part : parts)
        numbers.push_back({part.name, lamp, light_numbers(image, part.pixels)});
    return numbers;
}

std::vector<PartNumbers> lamp_numbers(Renderer& renderer, const ResolvedScene& scene,
                                      const RenderOptions& options,
                                      const std::vector<PicturePart>& parts,
                                      const std::function<void(std::size_t image)>& begin) {
    RenderOptions measured = options;
    measured.layers = layers_to_measure(scene.desc());
    const auto render = [&](std::vector<LampDesc> lamps, std::size_t image) {
        if (begin) begin(image);
        ResolvedScene part = scene;
        part.edit().lamps = std::move(lamps);
        renderer.set_scene(std::move(part));
        renderer.render(measured);
        return renderer.release_film();
    };
    const Film emitted = render({}, 0);
    std::vector<PartNumbers> numbers;
    std::size_t image = 0;
    for (const LampDesc& lamp : scene.desc().lamps) {
        const Film film = render({lamp}, ++image);
        const LayerPlan plan = layer_plan(renderer.scene(), measured.layers, measured.paths);
        for (PartNumbers& of_part : part_numbers({film, plan, &emitted}, parts, lamp.name))
            numbers.push_back(std::move(of_part));
    }
    return numbers;
}

}  // namespace uw
