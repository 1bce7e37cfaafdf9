#include "dataset/formats/observations.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/image/preview.h"
#include "render/seen_point.h"

namespace uw {

namespace {

constexpr const char* k_observation_columns = "point,x,y,r,g,b";

std::array<int, 3> colour_at(const ViewImages& images, const Preview& preview, double x, double y) {
    const int column = std::min(static_cast<int>(x), images.width() - 1);
    const int row = std::min(static_cast<int>(y), images.height() - 1);
    const Srgb8& rgb = preview(column, row);
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace

std::vector<Observation> observations(const ViewImages& images) {
    const Camera camera(images.camera);
    const Preview preview = make_preview(images.film, images.exposures.image);
    std::vector<Observation> seen;
    for (std::size_t i = 0; i < images.points->size(); ++i) {
        const SeenPoint point = seen_point((*images.points)[i].position, camera, *images.surfaces);
        if (!point.visible) continue;
        seen.push_back({static_cast<std::uint32_t>(i), point.pixel.x, point.pixel.y,
                        colour_at(images, preview, point.pixel.x, point.pixel.y)});
    }
    return seen;
}

std::string observations_csv(const std::vector<Observation>& observations) {
    std::string text = fmt::format("{}\n", k_observation_columns);
    for (const Observation& o : observations)
        text += fmt::format("{},{},{},{},{},{}\n", o.point, o.x, o.y, o.rgb[0], o.rgb[1], o.rgb[2]);
    return text;
}

std::vector<Observation> read_observations(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    std::string columns;
    std::getline(in, columns);
    std::vector<Observation> all;
    Observation o;
    char comma = 0;
    while (in >> o.point >> comma >> o.x >> comma >> o.y >> comma >> o.rgb[0] >> comma >>
           o.rgb[1] >> comma >> o.rgb[2])
        all.push_back(o);
    if (columns != k_observation_columns || !in.eof())
        throw InputError(
            fmt::format("{}: is not a table of {}", file.string(), k_observation_columns));
    return all;
}

}  // namespace uw
