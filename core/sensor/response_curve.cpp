#include "core/sensor/response_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/colour/colour.h"
#include "core/tables/csv_file.h"

namespace uw {
namespace {

SampledCurve read_curve_table(const ResponseCurveDesc& desc) {
    const SampledCurve curve = read_csv_file(desc.file, desc.where).curve("input", "output");
    const auto is_within = [](double value) { return value >= 0 && value <= 1; };
    if (curve.first() != 0 || curve.last() != 1 || !std::ranges::all_of(curve.y, is_within) ||
        !std::ranges::is_sorted(curve.y))
        throw InputError(
            fmt::format("{}: '{}' must have inputs from 0 to 1, and outputs from 0 to "
                        "1 that never fall; divide both by their greatest",
                        desc.where, desc.file.filename().string()));
    return curve;
}

}  // namespace

ResponseCurve::ResponseCurve(const ResponseCurveDesc& desc) : desc_(desc) {
    if (desc.type == ResponseCurveDesc::Type::file) table_ = read_curve_table(desc);
}

double ResponseCurve::operator()(double value) const {
    value = value > 0 ? std::min(value, 1.0) : 0.0;
    switch (desc_.type) {
        case ResponseCurveDesc::Type::linear:
            break;
        case ResponseCurveDesc::Type::srgb:
            return srgb_encode(value);
        case ResponseCurveDesc::Type::gamma:
            return std::pow(value, 1 / desc_.gamma);
        case ResponseCurveDesc::Type::file:
            return table_->value(value);
    }
    return value;
}

}  // namespace uw
