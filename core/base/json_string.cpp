#include "core/base/json_string.h"

#include "core/base/json.h"

namespace uw {

std::string json_string(const std::string& text) {
    return json_line(Json(text));
}

}  // namespace uw
