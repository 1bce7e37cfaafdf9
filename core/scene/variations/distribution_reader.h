#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/scene/variations/variations_desc.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// What messages advise where a distribution is missing.
inline constexpr std::string_view k_distribution_mend =
    "give a distribution, such as {uniform: [0, 1]}";

/// The shares of `count` > 0 things with these weights >= 0, or without any all alike. Throws
/// InputError at `where` if no weight is above 0.
Shares shares_of(std::size_t count, std::vector<double> weights, const ConfigValue& where);
/// The same of weights in the scene, of which there may be none; `of` are the things.
Shares read_shares(std::size_t count, const std::optional<ConfigValue>& weights,
                   const ConfigValue& of);

/// Whether a value names a distribution, rather than being one that stays as it is.
bool is_distribution(const ConfigNode& node);
/// Reads a distribution (docs/scene-file.md). Throws InputError.
DrawnFrom read_distribution(const ConfigValue& value);

}  // namespace uw
