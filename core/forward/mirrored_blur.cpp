#include "core/forward/mirrored_blur.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

constexpr int k_rows = 16;    // of a parallel block
constexpr int k_columns = 8;  // of a parallel block: a cache line of each row

// Runs `body(begin, end)` over blocks of [0, count).
void parallel_blocks(int count, int block, const std::function<void(int, int)>& body) {
    const auto blocks = static_cast<std::size_t>((count + block - 1) / block);
    parallel_for(blocks, [&](std::size_t i) {
        const int begin = static_cast<int>(i) * block;
        body(begin, std::min(begin + block, count));
    });
}

std::vector<double> responses(const SplineLine& line) {
    std::vector<double> result;
    for (int k = 0; k < line.nodes(); ++k) result.push_back(line.response(k));
    return result;
}

}  // namespace

MirroredBlur::MirroredBlur(int width, int height, double spacing)
    : grid_(width, height, spacing),
      along_rows_(grid_.columns()),
      along_columns_(grid_.rows()),
      response_x_(responses(grid_.x())),
      response_y_(responses(grid_.y())) {
    try {
        image_.assign(grid_.columns(), height);
        spectrum_.assign(grid_.rows(), grid_.columns());
    } catch (const std::bad_alloc&) {
        throw InputError(
            "forward scatter: not enough memory for an image of this size; render a "
            "smaller one, or set water.forward_scatter.K to 0");
    }
}

void MirroredBlur::add(const RowSource& image, const BlurKernel& kernel) {
    std::atomic<bool> any = false;
    parallel_blocks(grid_.height(), k_rows, [&](int begin, int end) {
        std::vector<double> pixels(
            grid_.x().is_identity() ? 0 : static_cast<std::size_t>(grid_.width()));
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            std::fill(row.begin(), row.end(), 0.0);
            std::fill(pixels.begin(), pixels.end(), 0.0);
            if (!image(y, pixels.empty() ? row : std::span(pixels))) continue;
            if (!pixels.empty()) grid_.x().spread(pixels, row);
            along_rows_.forward(row.data());
            any = true;
        }
    });
    if (any) add_columns(kernel, Input::pixels);
}

void MirroredBlur::add_nodes(const RowSource& nodes, bool means, const BlurKernel& kernel) {
    std::atomic<bool> any = false;
    parallel_blocks(grid_.rows(), k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            std::fill(row.begin(), row.end(), 0.0);
            if (!nodes(y, row)) continue;
            along_rows_.forward(row.data());
            any = true;
        }
    });
    if (any) add_columns(kernel, means ? Input::node_means : Input::node_values);
}

void MirroredBlur::add_columns(const BlurKernel& kernel, Input input) {
    const bool spread = input == Input::pixels && !grid_.y().is_identity();
    const int given = input == Input::pixels ? grid_.height() : grid_.rows();
    // What the input was multiplied by on its way to the nodes, and what the interpolation from
    // them is going to multiply the sum by.
    const bool twice = input != Input::node_values;
    const auto undone = [&](double response) {
        return 1 / (twice ? response * response : response);
    };
    const double unit = input == Input::pixels ? 1
                                               : (1.0 * grid_.width() / grid_.columns()) *
                                                     (1.0 * grid_.height() / grid_.rows());
    const int count = std::min(kernel.column_count(), grid_.columns());
    parallel_blocks(count, k_columns, [&](int begin, int end) {
        Grid2D<double> nodes(grid_.rows(), end - begin);
        for (int y = 0; y < given; ++y) {
            const std::span<const double> row = std::as_const(image_).row(y);
            for (int x = begin; x < end; ++x) {
                const double value = row[static_cast<std::size_t>(x)];
                if (!spread) {
                    nodes(y, x - begin) = value;
                    continue;
                }
                grid_.y().for_each_tap(
                    y, [&](int node, double weight) { nodes(node, x - begin) += weight * value; });
            }
        }
        std::vector<double> factors(static_cast<std::size_t>(grid_.rows()));
        for (int x = begin; x < end; ++x) {
            const std::span<double> column = nodes.row(x - begin), sum = spectrum_.row(x);
            along_columns_.forward(column.data());
            const int filled = kernel.fill_column(x, factors);
            const double across = unit * undone(response_x_[static_cast<std::size_t>(x)]);
            for (std::size_t y = 0; y < static_cast<std::size_t>(filled); ++y)
                sum[y] += across * undone(response_y_[y]) * factors[y] * column[y];
        }
    });
    any_ = true;
}

void MirroredBlur::finish_columns(bool pixels) {
    const bool interpolate = pixels && !grid_.y().is_identity();
    const double unit = 0.25 / (1.0 * grid_.width() * grid_.height());
    parallel_blocks(grid_.columns(), k_columns, [&](int begin, int end) {
        std::vector<double> line(interpolate ? static_cast<std::size_t>(grid_.height()) : 0);
        for (int x = begin; x < end; ++x) {
            std::span<double> column = spectrum_.row(x);
            along_columns_.inverse(column.data());
            if (interpolate) {
                grid_.y().interpolate(column, line);
                column = line;
            }
            for (std::size_t y = 0; y < column.size(); ++y)
                image_(x, static_cast<int>(y)) = unit * column[y];
            std::ranges::fill(spectrum_.row(x), 0.0);
        }
    });
}

void MirroredBlur::finish(const RowSink& sink) {
    if (any_)
        finish_columns(true);
    else
        std::ranges::fill(image_, 0.0);
    parallel_blocks(grid_.height(), k_rows, [&](int begin, int end) {
        std::vector<double> pixels(
            grid_.x().is_identity() ? 0 : static_cast<std::size_t>(grid_.width()));
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            if (any_) along_rows_.inverse(row.data());
            if (!pixels.empty()) grid_.x().interpolate(row, pixels);
            sink(y, pixels.empty() ? row : std::span(pixels));
        }
    });
    any_ = false;
}

void MirroredBlur::finish_nodes(const RowSink& sink) {
    if (any_)
        finish_columns(false);
    else
        std::ranges::fill(image_, 0.0);
    parallel_blocks(grid_.rows(), k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            if (any_) along_rows_.inverse(row.data());
            sink(y, row);
        }
    });
    any_ = false;
}

}  // namespace uw
