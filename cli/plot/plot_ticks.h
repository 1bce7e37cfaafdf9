#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace uw {

enum class AxisScale { linear, log };

/// A mark on an axis; a minor one has no label.
struct AxisTick {
    double value;
    std::string label;
};

/// The range of an axis and its ticks, ascending, all within the range.
struct AxisTicks {
    double min, max;
    std::vector<AxisTick> ticks;
};

/// The requested properties of an axis; those left out follow from the data.
struct AxisRequest {
    AxisScale scale = AxisScale::linear;
    std::optional<double> min, max;   // log: > 0
    std::optional<double> tick_step;  // linear: spacing of labelled ticks; else a round one
};

/// Chooses range and ticks for `values`. Those that are not finite, or not positive on a log axis,
/// are ignored; with none left the axis is 0 to 1, or 1 to 10. Unless limits are requested, the
/// range ends on round numbers: labelled ticks of a linear axis, powers of ten of a log axis. At
/// most about ten ticks are labelled; log axes have minor ticks at 2 to 9 times the powers of ten,
/// unless they span so much that these would merge.
AxisTicks choose_ticks(const AxisRequest& request, std::span<const double> values);

}  // namespace uw
