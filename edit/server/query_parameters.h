#pragma once

#include <cstdint>
#include <string>

#include "edit/server/http_message.h"
#include "edit/session/session_measures.h"

namespace uw {

/// @name Parameters of an address, "?min=3"
/// Each is `otherwise` where there is none, and throws UsageError where it is of another kind.
/// @{
std::int64_t integer_parameter(const HttpRequest& request, const std::string& name,
                               std::int64_t otherwise);
double number_parameter(const HttpRequest& request, const std::string& name, double otherwise);
/// x0, y0, x1, y1, ratio and curves.
NumbersRequest numbers_request(const HttpRequest& request);
/// @}

}  // namespace uw
