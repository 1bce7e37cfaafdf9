#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace uw {

/// The word for `value` in a table of those that scenes and options accept, which has it.
template <class T, std::size_t N>
std::string word_of(T value, const std::array<std::pair<std::string_view, T>, N>& table) {
    return std::string(
        std::ranges::find(table, value, &std::pair<std::string_view, T>::second)->first);
}

}  // namespace uw
