#include "core/scene/meter_desc.h"

#include <fmt/format.h>

namespace uw {

namespace {

constexpr auto k_example =
    "write {name: station, position: [0, -5, 0]}, or {name: cast, from: [0, 0, 0], to: [0, -30, "
    "0], "
    "count: 16}";
constexpr int k_max_points = 1000;

Point3 read_point(const ConfigValue& value) {
    return at_origin_plus(value.vector("give a point in the world, three lengths in metres"));
}

}  // namespace

MeterDesc read_meter(const ConfigValue& value, std::size_t number, const SceneContext& context) {
    ConfigMap map(value, {"type", "name", "position", "from", "to", "count", "up"}, k_example);
    MeterDesc meter;
    map.find("type");  // which is light
    meter.where = value.location();
    meter.name = fmt::format("sensor{}", number);
    if (const auto name = map.find("name"))
        meter.name = read_short_name(*name, "a sensor's name", "write name: station");
    if (context.water_surface) meter.up = context.water_surface->normal;
    if (const auto up = map.find("up")) meter.up = up->direction("give the direction that is up");
    if (const auto position = map.find("position")) {
        for (const auto* const other : {"from", "to", "count"})
            if (const auto entry = map.find(other))
                entry->fail("a sensor is at one position or on a line; remove one of the two");
        meter.points = {read_point(*position)};
        return meter;
    }
    const Point3 from = read_point(map.require("from", k_example));
    const Point3 to = read_point(map.require("to", k_example));
    const int count = map.require("count", k_example)
                          .integer(2, k_max_points, "give how many points of the line, 2 to 1000");
    for (int i = 0; i < count; ++i)
        meter.points.push_back(from + static_cast<double>(i) / (count - 1) * (to - from));
    return meter;
}

}  // namespace uw
