#include "dataset/surface_points.h"

#include <fmt/format.h>

#include <fstream>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr const char* k_point_columns = "x,y,z";

}  // namespace

std::string points_file(const DatasetDefinition& definition, std::size_t draw) {
    return definition.folder(draw) + "views/points.csv";
}

std::string points_csv(const std::vector<SurfacePoint>& points) {
    std::string text = fmt::format("{}\n", k_point_columns);
    for (const SurfacePoint& point : points)
        text += fmt::format("{},{},{}\n", point.position.x, point.position.y, point.position.z);
    return text;
}

std::vector<SurfacePoint> read_points(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    std::string columns;
    std::getline(in, columns);
    std::vector<SurfacePoint> points;
    Point3 p;
    char comma = 0;
    while (in >> p.x >> comma >> p.y >> comma >> p.z) points.push_back({p});
    if (columns != k_point_columns || !in.eof())
        throw InputError(fmt::format("{}: is not a table of {}", file.string(), k_point_columns));
    return points;
}

}  // namespace uw
