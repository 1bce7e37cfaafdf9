#include "edit/session/request_members.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr std::size_t k_longest_text = 200, k_longest_name = 100;

template <std::size_t N>
std::array<double, N> numbers_member(const Json& request, const char* key) {
    const Json& value = member(request, key);
    if (!value.is_array() || value.size() != N)
        throw UsageError(fmt::format("{}: expected {} numbers", key, N));
    std::array<double, N> numbers{};
    for (std::size_t i = 0; i < N; ++i) {
        if (!value[i].is_number()) throw UsageError(fmt::format("{}: expected {} numbers", key, N));
        numbers[i] = value[i].get<double>();
    }
    return numbers;
}

}  // namespace

const Json& member(const Json& request, const char* key) {
    const auto found = request.find(key);
    if (found == request.end()) throw UsageError(fmt::format("{}: missing", key));
    return *found;
}

std::string text_member(const Json& request, const char* key) {
    const Json& value = member(request, key);
    if (!value.is_string()) throw UsageError(fmt::format("{}: expected text", key));
    return value.get<std::string>();
}

std::string optional_text_member(const Json& request, const char* key) {
    return request.contains(key) ? printable(text_member(request, key), k_longest_text) : "";
}

bool flag_member(const Json& request, const char* key, bool otherwise) {
    if (!request.contains(key)) return otherwise;
    const Json& value = request[key];
    if (!value.is_boolean()) throw UsageError(fmt::format("{}: expected true or false", key));
    return value.get<bool>();
}

double number_member(const Json& request, const char* key) {
    const Json& value = member(request, key);
    if (!value.is_number()) throw UsageError(fmt::format("{}: expected a number", key));
    return value.get<double>();
}

double number_member(const Json& request, const char* key, double otherwise) {
    return request.contains(key) ? number_member(request, key) : otherwise;
}

ImagePoint pixel_member(const Json& request, const char* key) {
    const auto [x, y] = numbers_member<2>(request, key);
    return {x, y};
}

Vector3 vector_member(const Json& request, const char* key) {
    const auto [x, y, z] = numbers_member<3>(request, key);
    return {x, y, z};
}

std::string new_file_member(const Json& request) {
    const std::string name = text_member(request, "file");
    const bool is_plain = !name.empty() && name.front() != '.' && name.size() <= k_longest_name &&
                          printable(name, k_longest_name) == name &&
                          name.find_first_of("/\\") == std::string::npos;
    if (!is_plain || !(name.ends_with(".yaml") || name.ends_with(".yml")))
        throw UsageError("file: give a name such as rig.yaml, in the scene's folder");
    return name;
}

}  // namespace uw
