#include "core/forward/forward_scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

/// The widths s [pixels] for which kernels are made: offset + s grows by `ratio` from one to the
/// next. A mixture of two neighbours misplaces less than 0.25 % of the light compared with the
/// exact kernel between them. Beyond `widest` image sides, all kernels spread light evenly.
struct LadderRule {
    double ratio, offset, widest;
};

LadderRule ladder_rule(ForwardScatterDesc::Shape shape) {
    if (shape == ForwardScatterDesc::Shape::exponential) return {0.16, 0.1, 6};
    return {0.085, 0.06, 1.5};
}

/// Width s in pixels of the kernel for a blur length of 1 m along an axis of focal length `focal`.
double width_per_metre(double blur, double focal) {
    return focal * blur / (2 * std::numbers::pi);
}

double weight_between(double from, double to, double length) {
    return (length - from) / (to - from);
}

}  // namespace

void check_forward_scatter(const ForwardScatterDesc& desc, std::span<const double> attenuation,
                           const SourceLocation& where) {
    if (!(desc.K >= 0 && std::isfinite(desc.K)))
        throw InputError(
            fmt::format("{}: K must not be negative, found {}; 0 turns it off", where, desc.K));
    if (!(desc.B >= 0 && std::isfinite(desc.B)))
        throw InputError(fmt::format("{}: B must not be negative, found {}; give a width in rad/m",
                                     where, desc.B));
    for (const double c : attenuation)
        if (!(std::abs(desc.G) <= c))
            throw InputError(
                fmt::format("{}: G must be within -c and c in every band, found {} where the "
                            "water's c is {} 1/m; give a smaller G",
                            where, desc.G, c));
}

/// Each pixel's blur length and the factor on its spread light.
class ForwardScatter::Paths {
  public:
    Paths(const ForwardScatterDesc& desc, const ScatterSource& source)
        : lengths_(source.blur_length.data()),
          depths_(source.optical_depth.empty() ? nullptr : source.optical_depth.data()),
          attenuation_(source.attenuation),
          strength_(desc.K),
          fraction_of_depth_(source.attenuation > 0 ? desc.G / source.attenuation : 0.0) {}
    Paths(const ForwardScatterDesc& desc, double range, double attenuation)
        : Paths(desc, ScatterSource{{}, {}, {}, attenuation}) {
        range_ = range;
        lengths_ = nullptr;
    }

    double length(std::size_t pixel) const {
        return lengths_ != nullptr ? static_cast<double>(lengths_[pixel]) : range_;
    }
    double depth(std::size_t pixel) const {
        return depths_ != nullptr ? static_cast<double>(depths_[pixel])
                                  : attenuation_ * length(pixel);
    }
    /// K [e^{-(G/c) tau} - e^{-tau}], without cancellation for small tau.
    double factor(std::size_t pixel) const {
        const double tau = depth(pixel);
        return strength_ * std::exp(-fraction_of_depth_ * tau) *
               -std::expm1(-(1 - fraction_of_depth_) * tau);
    }

  private:
    const float* lengths_;
    const float* depths_;
    double attenuation_, strength_, fraction_of_depth_;
    double range_ = 0;
};

/// The least and the greatest blur length of lit pixels; empty if none is lit.
struct ForwardScatter::Extent {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void include(const Extent& other) {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

ForwardScatter::ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane)
    : desc_(desc), plane_(plane) {
    if (plane.width < 1 || plane.height < 1 || !(plane.focal_x > 0) || !(plane.focal_y > 0))
        throw std::invalid_argument("forward scatter needs pixels and a positive focal length");
    check_forward_scatter(desc, {}, "water.forward_scatter");
    if (desc.K > 0) sum_.emplace(plane.width, plane.height);
}

void ForwardScatter::add(const ScatterSource& source) {
    if (!sum_) return;
    check_forward_scatter(desc_, std::span(&source.attenuation, 1), "water.forward_scatter");
    if (source.blur_length.size() != source.light.size() ||
        (!source.optical_depth.empty() && source.optical_depth.size() != source.light.size()))
        throw std::invalid_argument("forward scatter needs a path for every pixel");
    spread(source.light, Paths(desc_, source));
}

void ForwardScatter::add(std::span<const float> light, double range, double attenuation) {
    if (!sum_) return;
    check_forward_scatter(desc_, std::span(&attenuation, 1), "water.forward_scatter");
    spread(light, Paths(desc_, range, attenuation));
}

void ForwardScatter::spread(std::span<const float> light, const Paths& paths) {
    const auto width = static_cast<std::size_t>(plane_.width);
    const auto height = static_cast<std::size_t>(plane_.height);
    if (light.size() != width * height)
        throw std::invalid_argument("forward scatter: the light is not of the plane's size");
    std::vector<Extent> rows(height);
    parallel_for(height, [&](std::size_t y) {
        for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
            if (light[i] == 0) continue;
            const double length = paths.length(i), depth = paths.depth(i);
            if (!(light[i] > 0 && std::isfinite(light[i]) && length >= 0 && depth >= 0 &&
                  std::isfinite(length) && std::isfinite(depth)))
                throw std::invalid_argument("forward scatter: light or path is not a number >= 0");
            rows[y].include({length, length});
        }
    });
    Extent all;
    for (const Extent& row : rows) all.include(row);
    if (all.least > all.greatest) return;

    const std::vector<double> lengths = ladder(all);
    for (std::size_t k = 0; k < lengths.size(); ++k) {
        const double here = lengths[k];
        const double below = k > 0 ? lengths[k - 1] : -1;
        const double above =
            k + 1 < lengths.size() ? lengths[k + 1] : std::numeric_limits<double>::infinity();
        const auto has_part = [&](const Extent& row) {
            return row.greatest > below && row.least < above;
        };
        if (std::none_of(rows.begin(), rows.end(), has_part)) continue;
        const auto part = [&](int row, std::span<double> values) {
            const auto y = static_cast<std::size_t>(row);
            bool any = false;
            if (!has_part(rows[y])) return any;
            for (std::size_t x = 0; x < width; ++x) {
                const std::size_t i = y * width + x;
                const double length = paths.length(i);
                if (light[i] == 0 || length <= below || length >= above) continue;
                double weight = 1;
                if (length < here && k > 0) weight = weight_between(below, here, length);
                if (length > here && k + 1 < lengths.size())
                    weight = weight_between(above, here, length);
                values[x] = weight * paths.factor(i) * static_cast<double>(light[i]);
                any = true;
            }
            return any;
        };
        sum_->add(part, kernel(here));
    }
}

std::vector<double> ForwardScatter::ladder(const Extent& lengths) const {
    const double width = std::sqrt(width_per_metre(desc_.B, plane_.focal_x) *
                                   width_per_metre(desc_.B, plane_.focal_y));
    const LadderRule rule = ladder_rule(desc_.shape);
    const double widest = rule.widest * std::max(plane_.width, plane_.height);
    const double least = std::min(width * lengths.least, widest);
    const double greatest = std::min(width * lengths.greatest, widest);
    const double begin = std::log1p(least / rule.offset);
    const double end = std::log1p(greatest / rule.offset);
    // Greater lengths than the last use its kernel.
    std::vector<double> result{lengths.least};
    if (!(end - begin > 1e-9)) return result;
    const int steps = static_cast<int>(std::ceil((end - begin) / std::log1p(rule.ratio)));
    for (int i = 1; i < steps; ++i)
        result.push_back(rule.offset * std::expm1(begin + (end - begin) * i / steps) / width);
    result.push_back(greatest / width);
    return result;
}

BlurKernel ForwardScatter::kernel(double length) const {
    return {desc_.shape,
            {length * width_per_metre(desc_.B, plane_.focal_x),
             length * width_per_metre(desc_.B, plane_.focal_y)},
            plane_.width,
            plane_.height};
}

void ForwardScatter::finish(std::span<float> added) {
    const auto width = static_cast<std::size_t>(plane_.width);
    if (added.size() != width * static_cast<std::size_t>(plane_.height))
        throw std::invalid_argument("forward scatter: the result is not of the plane's size");
    if (!sum_) {
        std::fill(added.begin(), added.end(), 0.0F);
        return;
    }
    sum_->finish([&](int y, std::span<const double> row) {
        float* out = added.data() + static_cast<std::size_t>(y) * width;
        // Light is never negative; negative values are rounding errors of the transforms.
        for (std::size_t x = 0; x < width; ++x) out[x] = static_cast<float>(std::max(row[x], 0.0));
    });
}

}  // namespace uw
