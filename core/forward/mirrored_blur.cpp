#include "core/forward/mirrored_blur.h"

#include <algorithm>
#include <atomic>
#include <new>

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
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    try {
        layer_.resize(pixels);
        spectrum_.resize(pixels);
    } catch (const std::bad_alloc&) {
        throw InputError(
            "forward scatter: not enough memory for an image of this size; render a "
            "smaller one, or set water.forward_scatter.K to 0");
    }
}

void MirroredBlur::add(const RowSource& layer, const BlurKernel& kernel) {
    const auto width = static_cast<std::size_t>(width_);
    std::atomic<bool> any = false;
    parallel_blocks(height_, k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const std::span row(layer_.data() + static_cast<std::size_t>(y) * width, width);
            std::fill(row.begin(), row.end(), 0.0);
            if (!layer(y, row)) continue;
            along_rows_.forward(row.data());
            any = true;
        }
    });
    if (any) add_columns(kernel);
}

void MirroredBlur::add_columns(const BlurKernel& kernel) {
    const auto width = static_cast<std::size_t>(width_);
    const auto height = static_cast<std::size_t>(height_);
    parallel_blocks(kernel.column_count(), k_columns, [&](int begin, int end) {
        const auto first = static_cast<std::size_t>(begin);
        const auto count = static_cast<std::size_t>(end - begin);
        std::vector<double> columns(count * height);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t i = 0; i < count; ++i)
                columns[i * height + y] = layer_[y * width + first + i];
        std::vector<double> factors(height);
        for (std::size_t i = 0; i < count; ++i) {
            const std::span column(columns.data() + i * height, height);
            along_columns_.forward(column.data());
            const int rows = kernel.fill_column(begin + static_cast<int>(i), factors);
            double* sum = spectrum_.data() + (first + i) * height;
            for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y)
                sum[y] += factors[y] * column[y];
        }
    });
    any_ = true;
}

void MirroredBlur::finish(const RowSink& sink) {
    const auto width = static_cast<std::size_t>(width_);
    const auto height = static_cast<std::size_t>(height_);
    if (any_) {
        const double unit = 1 / (along_rows_.scale() * along_columns_.scale());
        parallel_blocks(width_, k_columns, [&](int begin, int end) {
            const auto first = static_cast<std::size_t>(begin);
            const auto count = static_cast<std::size_t>(end - begin);
            double* columns = spectrum_.data() + first * height;
            for (std::size_t i = 0; i < count; ++i) along_columns_.inverse(columns + i * height);
            for (std::size_t y = 0; y < height; ++y)
                for (std::size_t i = 0; i < count; ++i)
                    layer_[y * width + first + i] = unit * columns[i * height + y];
            std::fill(columns, columns + count * height, 0.0);
        });
    } else {
        std::fill(layer_.begin(), layer_.end(), 0.0);
    }
    parallel_blocks(height_, k_rows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            double* row = layer_.data() + static_cast<std::size_t>(y) * width;
            if (any_) along_rows_.inverse(row);
            sink(y, std::span<const double>(row, width));
        }
    });
    any_ = false;
}

}  // namespace uw
