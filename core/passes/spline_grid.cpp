#include "core/passes/spline_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/base/parallel.h"

namespace uw {

namespace {

bool has_small_factors(int count) {
    for (const int prime : {2, 3, 5})
        while (count % prime == 0) count /= prime;
    return count == 1;
}

// Returns the quintic B-spline at a distance of `x` nodes.
double quintic(double x) {
    const auto power = [x](double extent) {
        const double t = std::max(0.0, extent - x);
        return t * t * t * t * t;
    };
    return (power(3) - 6 * power(2) + 15 * power(1)) / 120;
}

}  // namespace

SplineLine::SplineLine(int pixels, int nodes) : nodes_(nodes) {
    if (nodes == pixels) return;
    for (int i = 0; i < pixels; ++i) {
        const double at = (i + 0.5) * nodes / pixels - 0.5;
        const double before = std::floor(at);
        Taps taps;
        for (std::size_t n = 0; n < k_taps; ++n) {
            const int node = static_cast<int>(before) - 2 + static_cast<int>(n);
            taps.nodes[n] = reflected(node);
            taps.weights[n] = quintic(std::abs(at - node));
        }
        taps_.push_back(taps);
    }
}

/// Returns the node of which `node`, which may lie beyond either end, is the mirror image.
int SplineLine::reflected(int node) const {
    const int position = ((node % (2 * nodes_)) + 2 * nodes_) % (2 * nodes_);
    return position < nodes_ ? position : 2 * nodes_ - 1 - position;
}

void SplineLine::spread(std::span<const double> pixels, std::span<double> nodes) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (pixels[i] == 0) continue;
        const Taps& taps = taps_[i];
        for (std::size_t n = 0; n < k_taps; ++n)
            nodes[static_cast<std::size_t>(taps.nodes[n])] += taps.weights[n] * pixels[i];
    }
}

void SplineLine::interpolate(std::span<const double> nodes, std::span<double> pixels) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Taps& taps = taps_[i];
        double sum = 0;
        for (std::size_t n = 0; n < k_taps; ++n)
            sum += taps.weights[n] * nodes[static_cast<std::size_t>(taps.nodes[n])];
        pixels[i] = sum;
    }
}

double SplineLine::response(int k) const {
    if (is_identity() || k == 0) return 1;
    const double x = 0.5 * std::numbers::pi * k / nodes_;
    const double sinc = std::sin(x) / x;
    return sinc * sinc * sinc * sinc * sinc * sinc;
}

int SplineLine::node_count(int pixels, double spacing) {
    constexpr int k_min = 16;
    int count = std::max(k_min, static_cast<int>(std::ceil(pixels / spacing)));
    while (count < pixels && !has_small_factors(count)) ++count;
    return std::min(count, pixels);
}

void SplineGrid::means(const RowSource& pixels, Grid2D<float>& nodes) const {
    constexpr int k_block = 16;
    const double unit = 1.0 * columns() * rows() / (1.0 * width_ * height_);
    Grid2D<float> lines(columns(), height_);
    std::vector<char> lit(static_cast<std::size_t>(height_));
    parallel_for(lit.size(), [&](std::size_t y) {
        std::vector<double> row(static_cast<std::size_t>(width_));
        lit[y] = static_cast<char>(pixels(static_cast<int>(y), row));
        if (lit[y] == 0) return;
        std::vector<double> line(static_cast<std::size_t>(columns()));
        if (x_.is_identity())
            line = row;
        else
            x_.spread(row, line);
        std::ranges::transform(line, lines.row(static_cast<int>(y)).begin(),
                               [](double value) { return static_cast<float>(value); });
    });
    nodes.assign(columns(), rows());
    const auto blocks = static_cast<std::size_t>((columns() + k_block - 1) / k_block);
    parallel_for(blocks, [&](std::size_t block) {
        const int begin = static_cast<int>(block) * k_block;
        const int end = std::min(begin + k_block, columns());
        for (int y = 0; y < height_; ++y) {
            if (lit[static_cast<std::size_t>(y)] == 0) continue;
            y_.for_each_tap(y, [&](int node, double weight) {
                const auto scale = static_cast<float>(unit * weight);
                for (int x = begin; x < end; ++x) nodes(x, node) += scale * lines(x, y);
            });
        }
    });
}

void SplineGrid::values(const Grid2D<float>& coefficients, Grid2D<float>& nodes) const {
    nodes.resize(columns(), rows());
    Grid2D<float> across(columns(), rows());
    parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < columns(); ++x) {
            double sum = 0;
            x_.for_each_node_tap(x, [&](int node, double weight) {
                sum += weight * static_cast<double>(coefficients(node, y));
            });
            across(x, y) = static_cast<float>(sum);
        }
    });
    parallel_for(static_cast<std::size_t>(rows()), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        const std::span<float> out = nodes.row(y);
        std::ranges::fill(out, 0.0F);
        y_.for_each_node_tap(y, [&](int node, double weight) {
            const std::span<const float> line = across.row(node);
            for (std::size_t x = 0; x < out.size(); ++x)
                out[x] += static_cast<float>(weight) * line[x];
        });
    });
}

void SplineGrid::interpolate(const Grid2D<float>& coefficients, const RowSink& sink) const {
    parallel_for(static_cast<std::size_t>(height_), [&](std::size_t row) {
        std::vector<double> line(static_cast<std::size_t>(columns()));
        y_.for_each_tap(static_cast<int>(row), [&](int node, double weight) {
            const std::span<const float> from = coefficients.row(node);
            for (std::size_t x = 0; x < line.size(); ++x)
                line[x] += weight * static_cast<double>(from[x]);
        });
        if (x_.is_identity()) {
            sink(static_cast<int>(row), line);
            return;
        }
        std::vector<double> pixels(static_cast<std::size_t>(width_));
        x_.interpolate(line, pixels);
        sink(static_cast<int>(row), pixels);
    });
}

std::array<float, 2> SplineGrid::at(const Grid2D<float>& first, const Grid2D<float>& second, int x,
                                    int y) const {
    std::array<float, 2> sums{};
    y_.for_each_tap(y, [&](int row, double down) {
        const float* const of_first = first.row(row).data();
        const float* const of_second = second.row(row).data();
        float line = 0, other = 0;
        x_.for_each_tap(x, [&](int column, double across) {
            line += static_cast<float>(across) * of_first[column];
            other += static_cast<float>(across) * of_second[column];
        });
        sums[0] += static_cast<float>(down) * line;
        sums[1] += static_cast<float>(down) * other;
    });
    return sums;
}

}  // namespace uw
