#pragma once

#include <memory>

namespace uw {

/// The cosine transform of one line of an image (DCT-II): the Fourier transform of the line
/// extended periodically by reflection, ... c b a | a b c ... z | z y x ... Frequency k of n is
/// k/(2n) cycles per pixel. The only user of FFTW. Its plans are deterministic, so that the same
/// line gives the same bits. Thread safe.
class CosineTransform {
  public:
    /// Plans the transform of lines of `length` >= 1 values.
    explicit CosineTransform(int length);

    int length() const { return length_; }

    /// y_k = 2 sum_j x_j cos(pi k (j + 1/2) / n), in place.
    void forward(double* line) const;
    /// Undoes `forward` up to the factor `scale()`, in place.
    void inverse(double* line) const;
    /// The factor by which `forward` followed by `inverse` scales a line: 2n.
    double scale() const { return 2.0 * length_; }

  private:
    struct Plans;
    int length_;
    std::shared_ptr<const Plans> plans_;
};

}  // namespace uw
