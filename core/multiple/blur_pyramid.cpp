#include "core/multiple/blur_pyramid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace uw {

namespace {

int halved(int size) {
    return (size + 1) / 2;
}

// 1/8 (1 3 3 1) around the middle of pixels 2 i and 2 i + 1, along x and then along y.
void reduce(const Grid2D<float>& fine, Grid2D<float>& rows, Grid2D<float>& coarse) {
    const int width = fine.width(), height = fine.height();
    rows.resize(halved(width), height);
    for (int y = 0; y < height; ++y) {
        const auto in = fine.row(y);
        const auto at = [&](int x) {
            return in[static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
        };
        const auto out = rows.row(y);
        const auto sum = [&](int i) {
            return 0.375F * (at(2 * i) + at(2 * i + 1)) + 0.125F * (at(2 * i - 1) + at(2 * i + 2));
        };
        const int inner = (width - 2) / 2;
        out[0] = sum(0);
        for (int i = 1; i < inner; ++i) {
            const float* pixel = &in[static_cast<std::size_t>(2 * i)];
            out[static_cast<std::size_t>(i)] =
                0.375F * (pixel[0] + pixel[1]) + 0.125F * (pixel[-1] + pixel[2]);
        }
        for (int i = std::max(1, inner); i < rows.width(); ++i)
            out[static_cast<std::size_t>(i)] = sum(i);
    }
    coarse.resize(rows.width(), halved(height));
    for (int j = 0; j < coarse.height(); ++j) {
        const auto row = [&](int y) { return rows.row(std::clamp(y, 0, height - 1)); };
        const auto before = row(2 * j - 1), first = row(2 * j), second = row(2 * j + 1),
                   after = row(2 * j + 2);
        const auto out = coarse.row(j);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = 0.375F * (first[i] + second[i]) + 0.125F * (before[i] + after[i]);
    }
}

// 1/4 (1 2 1), which leaves nothing of what the pixels of the level cannot tell from slower
// changes, along x and then along y.
void smooth(Grid2D<float>& image, Grid2D<float>& rows) {
    const int width = image.width(), height = image.height();
    rows.resize(width, height);
    for (int y = 0; y < height; ++y) {
        const auto in = image.row(y), out = rows.row(y);
        const std::size_t last = in.size() - 1;
        for (std::size_t i = 0; i <= last; ++i)
            out[i] = 0.5F * in[i] + 0.25F * (in[i > 0 ? i - 1 : 0] + in[std::min(i + 1, last)]);
    }
    for (int y = 0; y < height; ++y) {
        const auto before = rows.row(std::max(y - 1, 0)), middle = rows.row(y),
                   after = rows.row(std::min(y + 1, height - 1)), out = image.row(y);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = 0.5F * middle[i] + 0.25F * (before[i] + after[i]);
    }
}

// Linear interpolation, along y and then along x.
void add_expanded(const Grid2D<float>& coarse, Grid2D<float>& rows, Grid2D<float>& fine) {
    const int height = fine.height();
    rows.resize(coarse.width(), 1);
    const auto row = rows.row(0);
    for (int y = 0; y < height; ++y) {
        const auto near = coarse.row(y / 2);
        const auto far =
            coarse.row(std::clamp(y / 2 + (y % 2 == 0 ? -1 : 1), 0, coarse.height() - 1));
        for (std::size_t i = 0; i < row.size(); ++i) row[i] = 0.75F * near[i] + 0.25F * far[i];
        const auto out = fine.row(y);
        const std::size_t last = row.size() - 1;
        for (std::size_t i = 0; i <= last; ++i) {
            const float before = row[i > 0 ? i - 1 : 0], after = row[std::min(i + 1, last)];
            out[2 * i] += 0.75F * row[i] + 0.25F * before;
            if (2 * i + 1 < out.size()) out[2 * i + 1] += 0.75F * row[i] + 0.25F * after;
        }
    }
}

}  // namespace

// Each step down and each step up adds 1/4 of the squared pixel of the finer image and 1/2 that of
// its own, smoothing 1/2 of the squared pixel of the level.
double BlurPyramid::deviation(int level) {
    return level == 0 ? 0 : std::sqrt(std::exp2(2 * (level - 1)) - 0.5);
}

// Each step down and each step up is cos(w / 2)^3 at its own w, which doubles from step to step,
// and smoothing cos(w / 2)^2: cos x cos 2x … cos 2^(n-1) x = sin(2^n x) / (2^n sin x).
double BlurPyramid::transfer(int level, double omega) {
    if (level == 0) return 1;
    const double x = 0.5 * omega, wide = std::exp2(level - 1), sine = wide * std::sin(x);
    const double steps = sine == 0 ? 1 : std::sin(wide * x) / sine;
    const double smoothing = std::cos(wide * x);
    return std::pow(steps, 6) * smoothing * smoothing;
}

int BlurPyramid::level_count(int width, int height) {
    return 2 + std::bit_width(static_cast<unsigned>(std::max(1, std::max(width, height)) - 1));
}

void BlurPyramid::begin(int width, int height) {
    unblurred_.assign(width, height);
    levels_.resize(static_cast<std::size_t>(level_count(width, height)) - 1);
    for (Grid2D<float>& level : levels_) {
        level.assign(width, height);
        width = halved(width);
        height = halved(height);
    }
}

void BlurPyramid::add(int level, Grid2D<float>& image) {
    for (int l = 1; l < level; ++l) {
        reduce(image, rows_, coarse_);
        std::swap(image, coarse_);
    }
    if (level > 0) smooth(image, rows_);
    Grid2D<float>& sum = level == 0 ? unblurred_ : levels_[static_cast<std::size_t>(level) - 1];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += image[i];
}

const Grid2D<float>& BlurPyramid::sum() {
    for (std::size_t l = levels_.size(); --l > 0;) add_expanded(levels_[l], rows_, levels_[l - 1]);
    for (std::size_t i = 0; i < unblurred_.size(); ++i) unblurred_[i] += levels_.front()[i];
    return unblurred_;
}

}  // namespace uw
