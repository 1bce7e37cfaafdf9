#include "core/forward/mirrored_blur.h"

#include <algorithm>
#include <atomic>
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

}  // namespace

MirroredBlur::MirroredBlur(int width, int height)
    : width_(width), height_(height), along_rows_(width), along_columns_(height) {
    try {
        image_.assign(width, height);
        spectrum_.assign(height, width);
    } catch (const std::bad_alloc&) {
        throw InputError(
            "forward scatter: not enough memory for an image of this size; render a "
            "smaller one, or set water.forward_scatter.K to 0");
    }
}

void MirroredBlur::add(const RowSource& image, const BlurKernel& kernel) {
    std::atomic<bool> any = false;
    parallel_blocks(height_, k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            std::fill(row.begin(), row.end(), 0.0);
            if (!image(y, row)) continue;
            along_rows_.forward(row.data());
            any = true;
        }
    });
    if (any) add_columns(kernel);
}

void MirroredBlur::add_columns(const BlurKernel& kernel) {
    parallel_blocks(kernel.column_count(), k_columns, [&](int begin, int end) {
        Grid2D<double> columns(height_, end - begin);
        for (int y = 0; y < height_; ++y) {
            const std::span<const double> row = std::as_const(image_).row(y);
            for (int x = begin; x < end; ++x)
                columns(y, x - begin) = row[static_cast<std::size_t>(x)];
        }
        std::vector<double> factors(static_cast<std::size_t>(height_));
        for (int x = begin; x < end; ++x) {
            const std::span<double> column = columns.row(x - begin), sum = spectrum_.row(x);
            along_columns_.forward(column.data());
            const int rows = kernel.fill_column(x, factors);
            for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y)
                sum[y] += factors[y] * column[y];
        }
    });
    any_ = true;
}

void MirroredBlur::finish(const RowSink& sink) {
    if (any_) {
        const double unit = 1 / (along_rows_.scale() * along_columns_.scale());
        parallel_blocks(width_, k_columns, [&](int begin, int end) {
            for (int x = begin; x < end; ++x) along_columns_.inverse(spectrum_.row(x).data());
            for (int y = 0; y < height_; ++y)
                for (int x = begin; x < end; ++x) image_(x, y) = unit * spectrum_(y, x);
            for (int x = begin; x < end; ++x) std::ranges::fill(spectrum_.row(x), 0.0);
        });
    } else {
        std::ranges::fill(image_, 0.0);
    }
    parallel_blocks(height_, k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const std::span<double> row = image_.row(y);
            if (any_) along_rows_.inverse(row.data());
            sink(y, row);
        }
    });
    any_ = false;
}

}  // namespace uw
