#include "core/passes/forward_scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

/// The maximum ratios of offset + s between neighbouring widths s [pixels] for which interpolation
/// between two, three or four of them misplaces less than 0.25 % of the light.
struct LadderRule {
    std::array<double, 3> ratios;
    double offset;
};

LadderRule ladder_rule(ForwardScatterDesc::Shape shape) {
    if (shape == ForwardScatterDesc::Shape::exponential) return {{1.2, 1.4, 1.5}, 0.1};
    return {{1.1, 1.18, 1.22}, 0.06};
}

}  // namespace

WidthLadder::WidthLadder(ForwardScatterDesc::Shape shape, double least, double greatest) {
    const LadderRule rule = ladder_rule(shape);
    offset_ = rule.offset;
    begin_ = std::log(least + offset_);
    const double extent = std::log(greatest + offset_) - begin_;
    widths_.push_back(least);
    if (!(extent > 1e-9)) return;
    int steps = 1;
    while (extent > steps * std::log(rule.ratios[static_cast<std::size_t>(std::min(steps, 3)) - 1]))
        ++steps;
    neighbours_ = std::min(steps, 3) + 1;
    for (int n = 0; n < neighbours_; ++n)
        for (int i = 0; i < neighbours_; ++i)
            if (i != n) inverse_[static_cast<std::size_t>(n)] /= n - i;
    per_step_ = extent / steps;
    for (int i = 1; i < steps; ++i) widths_.push_back(std::exp(begin_ + per_step_ * i) - offset_);
    widths_.push_back(greatest);
}

double WidthLadder::position(double width) const {
    if (widths_.size() == 1) return 0;
    const double last = static_cast<double>(widths_.size()) - 1;
    return std::clamp((std::log(width + offset_) - begin_) / per_step_, 0.0, last);
}

namespace {

/// Returns the width s in pixels of the kernel for a blur length of 1 m along an axis of focal
/// length `focal`.
double width_along(double blur, double focal) {
    return focal * blur / (2 * std::numbers::pi);
}

// Number of grids, whose spacings are powers of two.
constexpr std::size_t k_levels = 10;

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

/// The blur length of each pixel, and the factor on the light that it spreads.
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
    /// Returns K [e^{-(G/c) tau} - e^{-tau}], without cancellation for small tau.
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

ForwardScatter::ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane)
    : desc_(desc), plane_(plane) {
    if (plane.width < 1 || plane.height < 1 || !(plane.focal_x > 0) || !(plane.focal_y > 0))
        throw std::invalid_argument("forward scatter needs pixels and a positive focal length");
    check_forward_scatter(desc, {}, "water.forward_scatter");
    if (desc.K == 0) return;
    levels_.resize(k_levels);
    given_.assign(plane.width, plane.height);
    position_.assign(plane.width, plane.height);
}

ForwardScatter::ForwardScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                               double spacing)
    : desc_(desc), plane_(plane), at_nodes_(true) {
    levels_.emplace_back(std::in_place, plane.width, plane.height, spacing);
    given_.assign(grid().columns(), grid().rows());
    position_.assign(grid().columns(), grid().rows());
}

double ForwardScatter::nodes_per_width(ForwardScatterDesc::Shape shape) {
    return shape == ForwardScatterDesc::Shape::exponential ? 0.5 : 1.25;
}

double ForwardScatter::width_per_metre(const ForwardScatterDesc& desc, const ScatterPlane& plane) {
    return width_along(desc.B, std::min(plane.focal_x, plane.focal_y));
}

/// Returns the width [pixels] beyond which kernels spread light evenly over the image.
double ForwardScatter::max_width() const {
    const double sides = desc_.shape == ForwardScatterDesc::Shape::exponential ? 6 : 1.5;
    return sides * std::max(plane_.width, plane_.height);
}

void ForwardScatter::add(const ScatterSource& source, bool means) {
    if (levels_.empty()) return;
    check_forward_scatter(desc_, std::span(&source.attenuation, 1), "water.forward_scatter");
    if (source.blur_length.size() != source.light.size() ||
        (!source.optical_depth.empty() && source.optical_depth.size() != source.light.size()))
        throw std::invalid_argument("forward scatter needs a path for every pixel");
    spread(source.light, Paths(desc_, source), means);
}

void ForwardScatter::add(std::span<const float> light, double range, double attenuation) {
    if (levels_.empty()) return;
    check_forward_scatter(desc_, std::span(&attenuation, 1), "water.forward_scatter");
    spread(light, Paths(desc_, range, attenuation), false);
}

WidthLadder ForwardScatter::prepare_light(std::span<const float> light, const Paths& paths) {
    if (light.size() != given_.size())
        throw std::invalid_argument("forward scatter: the light is not of the plane's size");
    struct Extent {
        double least = std::numeric_limits<double>::infinity();
        double greatest = -std::numeric_limits<double>::infinity();
    };
    const auto columns = static_cast<std::size_t>(given_.width());
    const double per_metre = width_per_metre(desc_, plane_), max = max_width();
    const auto each_row = [&](const auto& body) {
        parallel_for(static_cast<std::size_t>(given_.height()), [&](std::size_t y) {
            for (std::size_t i = y * columns; i < (y + 1) * columns; ++i) body(y, i);
        });
    };
    std::vector<Extent> rows(static_cast<std::size_t>(given_.height()));
    each_row([&](std::size_t y, std::size_t i) {
        given_[i] = 0;
        if (light[i] == 0) return;
        const double length = paths.length(i), depth = paths.depth(i);
        if (!(light[i] > 0 && std::isfinite(light[i]) && length >= 0 && depth >= 0 &&
              std::isfinite(length) && std::isfinite(depth)))
            throw std::invalid_argument("forward scatter: light or path is not a number >= 0");
        const double width = std::min(per_metre * length, max);
        given_[i] = static_cast<float>(paths.factor(i) * static_cast<double>(light[i]));
        rows[y].least = std::min(rows[y].least, width);
        rows[y].greatest = std::max(rows[y].greatest, width);
    });
    Extent all;
    for (const Extent& row : rows) {
        all.least = std::min(all.least, row.least);
        all.greatest = std::max(all.greatest, row.greatest);
    }
    if (all.least > all.greatest) return {};
    WidthLadder ladder(desc_.shape, all.least, all.greatest);
    each_row([&](std::size_t, std::size_t i) {
        if (given_[i] != 0)
            position_[i] =
                static_cast<float>(ladder.position(std::min(per_metre * paths.length(i), max)));
    });
    return ladder;
}

void ForwardScatter::spread(std::span<const float> light, const Paths& paths, bool means) {
    const WidthLadder ladder = prepare_light(light, paths);
    const double per_metre = width_per_metre(desc_, plane_);
    const double x = width_along(desc_.B, plane_.focal_x), y = width_along(desc_.B, plane_.focal_y);
    for (int step = 0; step < static_cast<int>(ladder.widths().size()); ++step) {
        const double width = ladder.widths()[static_cast<std::size_t>(step)];
        const auto part = [&](int row, std::span<double> values) {
            const std::span<const float> given = std::as_const(given_).row(row);
            const std::span<const float> position = std::as_const(position_).row(row);
            bool any = false;
            for (std::size_t i = 0; i < given.size(); ++i) {
                if (given[i] == 0) continue;
                const double weight = ladder.weight(step, static_cast<double>(position[i]));
                if (weight == 0) continue;
                values[i] = weight * static_cast<double>(given[i]);
                any = true;
            }
            return any;
        };
        MirroredBlur& level = level_for(width);
        const double metres = per_metre > 0 ? width / per_metre : 0;
        const BlurKernel kernel(desc_.shape, {metres * x, metres * y}, plane_.width, plane_.height,
                                level.grid().columns(), level.grid().rows());
        if (at_nodes_)
            level.add_nodes(part, means, kernel);
        else
            level.add(part, kernel);
    }
}

/// Returns the grid for a kernel of this width, which is made if there is none yet.
MirroredBlur& ForwardScatter::level_for(double width) {
    if (at_nodes_) return *levels_.front();
    const double spacing = nodes_per_width(desc_.shape) * width;
    std::size_t level = 0;
    while (level + 1 < k_levels && 2 << level <= spacing) ++level;
    if (!levels_[level]) levels_[level].emplace(plane_.width, plane_.height, 1 << level);
    return *levels_[level];
}

namespace {

// Returns a sink that adds rows to an image of `columns` columns.
RowSink adder(std::span<float> image, int columns) {
    return [=](int y, std::span<const double> row) {
        float* out = image.data() + static_cast<std::ptrdiff_t>(y) * columns;
        for (std::size_t x = 0; x < row.size(); ++x) out[x] += static_cast<float>(row[x]);
    };
}

}  // namespace

void ForwardScatter::finish(std::span<float> added) {
    if (!at_nodes_) {
        finish_pixels(added);
        return;
    }
    if (added.size() != given_.size())
        throw std::invalid_argument("forward scatter: the result is not of the grid's size");
    std::fill(added.begin(), added.end(), 0.0F);
    levels_.front()->finish_nodes(adder(added, grid().columns()));
}

void ForwardScatter::finish_pixels(std::span<float> added) {
    if (added.size() !=
        static_cast<std::size_t>(plane_.width) * static_cast<std::size_t>(plane_.height))
        throw std::invalid_argument("forward scatter: the result is not of the plane's size");
    std::fill(added.begin(), added.end(), 0.0F);
    for (std::optional<MirroredBlur>& level : levels_)
        if (level && level->any()) level->finish(adder(added, plane_.width));
    // Light is never negative: such values are errors of the transforms and of the ladder.
    for (float& value : added) value = std::max(value, 0.0F);
}

}  // namespace uw
