#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "camera/camera.h"
#include "core/base/json.h"
#include "core/base/vector_math.h"

namespace uw {

/// @name Members of requests
/// Each throws UsageError of one line for a member that is missing, unless it is optional, or of
/// another kind.
/// @{
const Json& member(const Json& request, const char* key);
std::string text_member(const Json& request, const char* key);
/// "" where there is none; else fit for a message.
std::string optional_text_member(const Json& request, const char* key);
/// `otherwise` where there is none.
bool flag_member(const Json& request, const char* key, bool otherwise);
double number_member(const Json& request, const char* key);
double number_member(const Json& request, const char* key, double otherwise);
ImagePoint pixel_member(const Json& request, const char* key);
Vector3 vector_member(const Json& request, const char* key);
/// The name of a scene file in the scene's folder.
std::string new_file_member(const Json& request);
/// @}

}  // namespace uw
