#pragma once

#include <optional>
#include <string>
#include <vector>

namespace uw {

/// A value of the scene that is varied: `--set KEY.PATH=FIRST:LAST:STEP`.
struct SweepAxis {
    std::string key;
    std::vector<double> values;

    /// As an override of the scene, the value at `index`.
    std::string override_at(std::size_t index) const;
};

/// The axis that an override describes; none if its value is not such a range. Both ends are
/// included, up to rounding; the step's sign does not matter. Throws UsageError for a range that
/// makes no sense, or of more than 1000 values.
std::optional<SweepAxis> sweep_axis(const std::string& override);

}  // namespace uw
