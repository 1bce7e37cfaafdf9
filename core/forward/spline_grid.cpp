#include "core/forward/spline_grid.h"

#include <algorithm>
#include <vector>

#include "core/base/parallel.h"

namespace uw {

void SplineGrid::means(const RowSource& pixels, Grid2D<float>& nodes) const {
    constexpr int k_block = 16;
    const double unit = 1.0 * columns() * rows() / (1.0 * width_ * height_);
    Grid2D<float> lines(columns(), height_);
    std::vector<char> lit(static_cast<std::size_t>(height_));
    parallel_for(lit.size(), [&](std::size_t y) {
        thread_local std::vector<double> row, line;
        row.assign(static_cast<std::size_t>(width_), 0.0);
        lit[y] = static_cast<char>(pixels(static_cast<int>(y), row));
        if (lit[y] == 0) return;
        line.assign(static_cast<std::size_t>(columns()), 0.0);
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
                const auto share = static_cast<float>(unit * weight);
                for (int x = begin; x < end; ++x) nodes(x, node) += share * lines(x, y);
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
        thread_local std::vector<double> line, pixels;
        line.assign(static_cast<std::size_t>(columns()), 0.0);
        y_.for_each_tap(static_cast<int>(row), [&](int node, double weight) {
            const std::span<const float> from = coefficients.row(node);
            for (std::size_t x = 0; x < line.size(); ++x)
                line[x] += weight * static_cast<double>(from[x]);
        });
        if (x_.is_identity()) {
            sink(static_cast<int>(row), line);
            return;
        }
        pixels.resize(static_cast<std::size_t>(width_));
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
