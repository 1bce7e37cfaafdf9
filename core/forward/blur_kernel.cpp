#include "core/forward/blur_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_negligible = 1e-15;
const double k_largest_exponent = -std::log(k_negligible);

// Beyond this sigma a Gaussian's spectrum at half a cycle per pixel is below 3e-9: no aliases.
constexpr double k_alias_free_sigma = 2;
// Nor does an exponential have any that matter where its spectrum is below e^-18, 1.5e-8.
constexpr double k_alias_free_exponent = 18;
// In the mixture of Gaussians that makes up the exponential (below), a fraction of 2e-9 is narrower
// than s / 6.
constexpr double k_largest_deviate = 6;

// The table of aliases: nodes over 0 to half a cycle per pixel, and one beyond either end.
constexpr int k_steps = 64;
constexpr int k_nodes = k_steps + 3;
constexpr double k_step = 0.5 / k_steps;

double sinc(double f) {
    return f == 0 ? 1.0 : std::sin(k_pi * f) / (k_pi * f);
}

// Spectrum of a Gaussian averaged over a pixel, before sampling at the pixel centres.
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
    std::vector<double> weights_;  // of the pixel itself, and of both neighbours i pixels away
};

// Weights of cubic interpolation at `t` in [0, 1] between the middle two of four nodes.
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
        const double last = k_largest_exponent * width / (k_pi * blur.x);
        if (aliases_.empty() && last < columns) column_count_ = static_cast<int>(last) + 1;
    }
}

BlurKernel::TablePosition BlurKernel::table_position(double f) {
    const double at = f / k_step;
    const double node = std::min(std::floor(at), k_steps - 1.0);
    return {static_cast<std::size_t>(node), cubic_weights(at - node)};
}

/// The exponential kernel is a mixture of Gaussians of sigma = s/|z|, z standard normal (a Cauchy
/// distribution in the plane), and the aliases of a sampled Gaussian's spectrum are known. The
/// mixture is integrated over ln z, where the integrand is smooth and decays to zero at both ends:
/// the trapezoidal rule is accurate to 1e-9.
void BlurKernel::tabulate_aliases() {
    const double narrow = std::min(blur_.x, blur_.y);
    // In the lower half of the spectrum, aliases are those of 3/4 cycles per pixel at least.
    if (2 * column_count_ <= width_ && 2 * row_count_ <= height_ &&
        1.5 * k_pi * narrow > k_alias_free_exponent)
        return;
    const double least_deviate = narrow / k_alias_free_sigma;
    if (least_deviate >= k_largest_deviate) return;
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
    // Below this width no light leaves the pixel, and the mixture would be endless.
    constexpr double k_least_deviate = 1e-7;
    constexpr double k_log_step = 0.1;
    table_rows_.reserve(static_cast<std::size_t>(row_count_));
    for (int row = 0; row < row_count_; ++row)
        table_rows_.push_back(table_position(0.5 * row / height_));
    const double begin = std::log(std::max(least_deviate, k_least_deviate));
    const int count = static_cast<int>((std::log(k_largest_deviate) - begin) / k_log_step) + 1;
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
        if (aliases_.empty() && exponent > k_largest_exponent) return row;
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

}  // namespace uw
