#pragma once

#include <optional>
#include <span>
#include <string>

namespace uw {

/// How numbers are written into a scene file. They are the shortest that read back as the same
/// number, after rounding to `decimals` digits behind the point if that is given.
struct NumberStyle {
    std::optional<int> decimals;
};

/// A number as a person writes it: 0.25, 12, 1e-9.
std::string number_text(double value, const NumberStyle& style = {});

/// "[1, 2.5, 3]": a list of numbers as the value of SceneText::set.
std::string numbers_text(std::span<const double> values, const NumberStyle& style = {});

}  // namespace uw
