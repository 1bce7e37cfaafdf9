#include "core/base/json.h"

#include <cmath>

namespace uw {

Json number_json(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json list_json(std::span<const double> values) {
    Json out = Json::array();
    for (const double value : values) out.push_back(number_json(value));
    return out;
}

Json vector_json(const Vector3& v) {
    return Json::array({number_json(v.x), number_json(v.y), number_json(v.z)});
}

Json point_json(const Point3& p) {
    return vector_json(from_origin(p));
}

Json bounds_json(const Bounds& bounds) {
    if (bounds.empty()) return nullptr;
    return {{"min", point_json(bounds.min)}, {"max", point_json(bounds.max)}};
}

std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string json_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace uw
