#include "core/passes/mirrored_blur.h"

#include <fftw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <new>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/fourier.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_negligible = 1e-15;
const double k_max_exponent = -std::log(k_negligible);

// Beyond this sigma, the spectrum of a Gaussian at half a cycle per pixel is below 3e-9, so that
// there are no aliases.
constexpr double k_alias_free_sigma = 2;
// The aliases of an exponential are negligible where its spectrum is below e^-18, 1.5e-8.
constexpr double k_alias_free_exponent = 18;
// In the mixture of Gaussians that equals the exponential (below), a fraction of 2e-9 is narrower
// than s / 6.
constexpr double k_max_deviate = 6;

// The table of aliases has nodes from 0 to half a cycle per pixel, and one beyond each end.
constexpr int k_steps = 64;
constexpr int k_nodes = k_steps + 3;
constexpr double k_step = 0.5 / k_steps;

double sinc(double f) {
    return f == 0 ? 1.0 : std::sin(k_pi * f) / (k_pi * f);
}

// Returns the spectrum of a Gaussian averaged over a pixel, before sampling at pixel centres.
double smooth_gaussian(double sigma, double f) {
    const double x = k_pi * sigma * f;
    return std::exp(-2 * x * x) * sinc(f);
}

// The weights of a Gaussian on the pixels of a line, and their spectrum.
class PixelGaussian {
  public:
    explicit PixelGaussian(double sigma) : sigma_(sigma) {
        if (sigma == 0 || sigma > k_alias_free_sigma) return;
        const double unit = 1 / (sigma * std::numbers::sqrt2);
        double below = -1;
        for (double cumulated = 0; cumulated < 1; below = cumulated) {
            cumulated = std::erf((static_cast<double>(weights_.size()) + 0.5) * unit);
            weights_.push_back(weights_.empty() ? cumulated : cumulated - below);
        }
    }

    double spectrum(double f) const {
        if (sigma_ > k_alias_free_sigma) return smooth_gaussian(sigma_, f);
        if (weights_.empty()) return 1;
        const double twice = 2 * std::cos(2 * k_pi * f);
        double before = 0.5 * twice, cosine = 1, sum = 0;
        for (const double weight : weights_) {
            sum += weight * cosine;
            const double next = twice * cosine - before;  // cos(n + 1)x from cos nx, cos(n - 1)x
            before = cosine;
            cosine = next;
        }
        return sum;
    }

  private:
    double sigma_;
    std::vector<double> weights_;  // [i]: of each of the two pixels at a distance of i
};

// Returns the weights of cubic interpolation at `t` in [0, 1] between the middle two of four nodes.
std::array<double, 4> cubic_weights(double t) {
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6};
}

}  // namespace

BlurKernel::BlurKernel(ForwardScatterDesc::Shape shape, BlurWidth blur, int width, int height,
                       int columns, int rows)
    : shape_(shape),
      blur_(blur),
      width_(width),
      height_(height),
      column_count_(columns),
      row_count_(rows),
      across_(static_cast<std::size_t>(columns)),
      down_(static_cast<std::size_t>(rows)) {
    const bool gaussian = shape == ForwardScatterDesc::Shape::gaussian;
    const auto fill = [&](std::vector<double>& factors, double s, int side) {
        const PixelGaussian line(std::numbers::sqrt2 * s);
        const double step = 0.5 / side;
        for (std::size_t i = 0; i < factors.size(); ++i) {
            const double f = static_cast<double>(i) * step;
            factors[i] = gaussian ? line.spectrum(f) : sinc(f);
        }
    };
    fill(across_, blur.x, width);
    fill(down_, blur.y, height);
    if (gaussian) {
        while (column_count_ > 1 &&
               across_[static_cast<std::size_t>(column_count_) - 1] < k_negligible)
            --column_count_;
    } else {
        tabulate_aliases();
        const double last = k_max_exponent * width / (k_pi * blur.x);
        if (aliases_.empty() && last < columns) column_count_ = static_cast<int>(last) + 1;
    }
}

BlurKernel::TablePosition BlurKernel::table_position(double f) {
    const double at = f / k_step;
    const double node = std::min(std::floor(at), k_steps - 1.0);
    return {static_cast<std::size_t>(node), cubic_weights(at - node)};
}

/// Tabulates the aliases of the exponential kernel. It is a mixture of Gaussians of sigma = s/|z|,
/// z standard normal (a Cauchy distribution in the plane), and the aliases of a sampled Gaussian's
/// spectrum are known. The mixture is integrated over ln z, where the integrand is smooth and
/// decays to zero at both ends, so that the trapezoidal rule is accurate to 1e-9.
void BlurKernel::tabulate_aliases() {
    const double narrow = std::min(blur_.x, blur_.y);
    // In the lower half of the spectrum, aliases come from frequencies of at least 3/4 cycles per
    // pixel.
    if (2 * column_count_ <= width_ && 2 * row_count_ <= height_ &&
        1.5 * k_pi * narrow > k_alias_free_exponent)
        return;
    const double min_deviate = narrow / k_alias_free_sigma;
    if (min_deviate >= k_max_deviate) return;
    aliases_.assign(static_cast<std::size_t>(k_nodes) * k_nodes, 0.0);
    const auto add = [&](double sigma_x, double sigma_y, double weight) {
        const PixelGaussian x(sigma_x), y(sigma_y);
        std::array<std::array<double, k_nodes>, 4> lines{};
        for (std::size_t i = 0; i < k_nodes; ++i) {
            const double f = (static_cast<double>(i) - 1) * k_step;
            lines[0][i] = weight * x.spectrum(f);
            lines[1][i] = y.spectrum(f);
            lines[2][i] = weight * smooth_gaussian(sigma_x, f);
            lines[3][i] = smooth_gaussian(sigma_y, f);
        }
        for (std::size_t i = 0; i < k_nodes; ++i)
            for (std::size_t j = 0; j < k_nodes; ++j)
                aliases_[i * k_nodes + j] += lines[0][i] * lines[1][j] - lines[2][i] * lines[3][j];
    };
    // This bounds the mixture for kernels so narrow that no light leaves the pixel.
    constexpr double k_min_deviate = 1e-7;
    constexpr double k_log_step = 0.1;
    table_rows_.reserve(static_cast<std::size_t>(row_count_));
    for (int row = 0; row < row_count_; ++row)
        table_rows_.push_back(table_position(0.5 * row / height_));
    const double begin = std::log(std::max(min_deviate, k_min_deviate));
    const int count = static_cast<int>((std::log(k_max_deviate) - begin) / k_log_step) + 1;
    for (int q = 0; q <= count; ++q) {
        const double z = std::exp(begin + q * k_log_step);
        const double density = std::sqrt(2 / k_pi) * std::exp(-0.5 * z * z);
        add(blur_.x / z, blur_.y / z, k_log_step * z * density);
    }
}

int BlurKernel::fill_exponential(double across, std::span<double> spectrum) const {
    std::array<double, k_nodes> table{};
    if (!aliases_.empty()) {
        const TablePosition position = table_position(across);
        for (std::size_t n = 0; n < 4; ++n)
            for (std::size_t j = 0; j < k_nodes; ++j)
                table[j] += position.weights[n] * aliases_[(position.first + n) * k_nodes + j];
    }
    const double x = 2 * k_pi * blur_.x * across;
    const double step = k_pi * blur_.y / height_;
    const double factor = sinc(across);
    for (int row = 0; row < row_count_; ++row) {
        const double y = step * row;
        const double exponent = std::sqrt(x * x + y * y);
        if (aliases_.empty() && exponent > k_max_exponent) return row;
        const auto at = static_cast<std::size_t>(row);
        double value = std::exp(-exponent) * factor * down_[at];
        if (!aliases_.empty()) {
            const TablePosition& position = table_rows_[at];
            for (std::size_t n = 0; n < 4; ++n)
                value += position.weights[n] * table[position.first + n];
        }
        spectrum[at] = value;
    }
    return row_count_;
}

int BlurKernel::fill_column(int column, std::span<double> spectrum) const {
    if (shape_ == ForwardScatterDesc::Shape::exponential)
        return fill_exponential(0.5 * column / width_, spectrum);
    const double across = across_[static_cast<std::size_t>(column)];
    for (int row = 0; row < row_count_; ++row) {
        const double value = across * down_[static_cast<std::size_t>(row)];
        if (value < k_negligible) return row;
        spectrum[static_cast<std::size_t>(row)] = value;
    }
    return row_count_;
}

struct CosineTransform::Plans {
    struct Destroy {
        void operator()(fftw_plan_s* plan) const {
            const std::lock_guard lock(fourier_planner());
            fftw_destroy_plan(plan);
        }
    };
    using Plan = std::unique_ptr<fftw_plan_s, Destroy>;

    explicit Plans(int length)
        : forward(plan_line(length, FFTW_REDFT10)), inverse(plan_line(length, FFTW_REDFT01)) {}

    Plan forward, inverse;

  private:
    static Plan plan_line(int length, fftw_r2r_kind kind) {
        std::vector<double> line(static_cast<std::size_t>(length));
        const std::lock_guard lock(fourier_planner());
        // FFTW estimates the best plan instead of measuring it, so that the plan, and thus the
        // rounding, is the same in every run. The lines of an image differ in alignment.
        Plan plan(fftw_plan_r2r_1d(length, line.data(), line.data(), kind,
                                   FFTW_ESTIMATE | FFTW_UNALIGNED));
        if (!plan) throw std::bad_alloc();
        return plan;
    }
};

CosineTransform::CosineTransform(int length) : length_(length) {
    if (length < 1) throw std::invalid_argument("a cosine transform needs at least one value");
    plans_ = std::make_shared<Plans>(length);
}

void CosineTransform::forward(double* line) const {
    fftw_execute_r2r(plans_->forward.get(), line, line);
}

void CosineTransform::inverse(double* line) const {
    fftw_execute_r2r(plans_->inverse.get(), line, line);
}

namespace {

constexpr int k_rows = 16;    // of a parallel block
constexpr int k_columns = 8;  // of a parallel block: one cache line of each row

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
    const double bytes =
        1.0 * sizeof(double) * grid_.columns() * (static_cast<double>(height) + grid_.rows());
    require_memory(bytes, fmt::format("water.forward_scatter: {} x {} pixels need", width, height),
                   "render a smaller --size, or set K to 0");
    image_.assign(grid_.columns(), height);
    spectrum_.assign(grid_.rows(), grid_.columns());
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
    // Divide by the response of the spline: that of spreading the input to the nodes, if it was
    // spread, and that of interpolating the sum from them.
    const bool twice = input != Input::node_values;
    const auto inverse_response = [&](double response) {
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
            const double across = unit * inverse_response(response_x_[static_cast<std::size_t>(x)]);
            for (std::size_t y = 0; y < static_cast<std::size_t>(filled); ++y)
                sum[y] += across * inverse_response(response_y_[y]) * factors[y] * column[y];
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
