#include "core/multiple/cholesky.h"

#include <cmath>

namespace uw {

bool CholeskyFactor::factor(std::span<const double> matrix, std::size_t size, double least_pivot) {
    size_ = size;
    lower_.assign(matrix.begin(), matrix.end());
    for (std::size_t i = 0; i < size; ++i) {
        double* row = &lower_[i * size];
        for (std::size_t j = 0; j <= i; ++j) {
            const double* other = &lower_[j * size];
            double sum = row[j];
            for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
            if (i != j) {
                row[j] = sum / other[j];
                continue;
            }
            if (!(sum > least_pivot * row[i])) return false;
            row[i] = std::sqrt(sum);
        }
    }
    return true;
}

void CholeskyFactor::solve(std::span<double> x) const {
    for (std::size_t i = 0; i < size_; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= lower_[i * size_ + k] * x[k];
        x[i] /= lower_[i * size_ + i];
    }
    for (std::size_t i = size_; i-- > 0;) {
        for (std::size_t k = i + 1; k < size_; ++k) x[i] -= lower_[k * size_ + i] * x[k];
        x[i] /= lower_[i * size_ + i];
    }
}

}  // namespace uw
