#include "edit/session/suggest_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "edit/session/picture_mix.h"
#include "edit/session/request_members.h"

namespace uw {

namespace {

constexpr std::array<std::pair<std::string_view, SuggestRequest::Objective>, 3> k_objectives{
    {{"contrast", SuggestRequest::Objective::contrast},
     {"signal_to_backscatter", SuggestRequest::Objective::signal_to_backscatter},
     {"irradiance", SuggestRequest::Objective::irradiance}}};

SuggestRequest::Objective objective_member(const Json& request) {
    if (!request.contains("objective")) return SuggestRequest::Objective::contrast;
    const std::string name = text_member(request, "objective");
    for (const auto& [known, objective] : k_objectives)
        if (name == known) return objective;
    throw UsageError("objective: use contrast, signal_to_backscatter or irradiance");
}

std::size_t lamp_member(const Json& request, const char* key, const ResolvedScene& scene) {
    const std::string name = text_member(request, key);
    const auto& lamps = scene.desc().lamps;
    const auto found = std::ranges::find(lamps, name, &LampDesc::name);
    if (found == lamps.end())
        throw UsageError(fmt::format("{}: there is no lamp of that name that is on", key));
    return static_cast<std::size_t>(found - lamps.begin());
}

// {"from", "to"} or {"min", "max"}.
std::pair<Point3, Point3> range_member(const Json& request, const char* key, const char* from,
                                       const char* to) {
    const Json& range = member(request, key);
    if (!range.is_object()) throw UsageError(fmt::format("{}: expected two points", key));
    return {at_origin_plus(vector_member(range, from)), at_origin_plus(vector_member(range, to))};
}

Json lamp_place_json(const LampDesc& lamp) {
    return {{"lamp", lamp.name},
            {"position", point_json(lamp.position)},
            {"direction", vector_json(lamp.direction)}};
}

}  // namespace

SuggestRequest suggest_request(const Json& request, const ResolvedScene& scene) {
    SuggestRequest wanted;
    wanted.lamp = lamp_member(request, "lamp", scene);
    if (request.contains("mirror") && !request["mirror"].is_null())
        wanted.partner = lamp_member(request, "mirror", scene);
    wanted.in_box = request.contains("box");
    std::tie(wanted.from, wanted.to) = wanted.in_box ? range_member(request, "box", "min", "max")
                                                     : range_member(request, "along", "from", "to");
    wanted.distance = number_member(request, "distance", wanted.distance);
    wanted.objective = objective_member(request);
    wanted.aim = flag_member(request, "aim", false) ? SuggestRequest::Aim::target
                                                    : SuggestRequest::Aim::keep;
    wanted.least_light = number_member(request, "least_light", wanted.least_light);
    const double samples = number_member(request, "samples", static_cast<double>(wanted.samples));
    if (!(samples >= 12 && samples <= 10000)) throw UsageError("samples: expected 12 to 10000");
    wanted.samples = static_cast<std::size_t>(samples);
    return wanted;
}

Json suggest_point_json(const SuggestPoint& point) {
    return {{"position", point_json(point.position)},
            {"value", number_json(point.value)},
            {"allowed", point.allowed},
            {"numbers", target_numbers_json(point.numbers)}};
}

Json suggestion_json(const Suggestion& found) {
    Json map = Json::array();
    for (const SuggestPoint& point : found.map)
        map.push_back({{"position", point_json(point.position)},
                       {"value", number_json(point.value)},
                       {"allowed", point.allowed}});
    Json lamps = Json::array({lamp_place_json(found.lamp)});
    if (found.partner) lamps.push_back(lamp_place_json(*found.partner));
    return {{"map", {{"counts", found.counts}, {"points", std::move(map)}}},
            {"before", suggest_point_json(found.before)},
            {"best", suggest_point_json(found.best)},
            {"lamps", std::move(lamps)},
            {"tried", found.tried}};
}

}  // namespace uw
