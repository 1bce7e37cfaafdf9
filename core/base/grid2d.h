#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace uw {

/// A rectangle of values, row by row from the top: an image, a map, a lattice. Positions are given
/// as (x, y), always in this order, with x to the right. Bounds are asserted.
template <class T>
class Grid2D {
  public:
    Grid2D() = default;
    /// `width` times `height` values, all `value`. Throws std::bad_alloc or std::length_error.
    Grid2D(int width, int height, const T& value = T{}) { assign(width, height, value); }

    /// Resizes and sets all values to `value`; storage is reused.
    void assign(int width, int height, const T& value = T{}) {
        values_.assign(area(width, height), value);
        width_ = width;
        height_ = height;
    }
    /// Resizes, leaving the values unspecified: storage that they own is reused.
    void resize(int width, int height) {
        values_.resize(area(width, height));
        width_ = width;
        height_ = height;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    /// Number of values.
    std::size_t size() const { return values_.size(); }
    bool empty() const { return values_.empty(); }

    /// Index of (x, y) among all values.
    std::size_t index(int x, int y) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    T& operator()(int x, int y) { return values_[index(x, y)]; }
    const T& operator()(int x, int y) const { return values_[index(x, y)]; }
    /// The value at `index`.
    T& operator[](std::size_t index) { return values_[index]; }
    const T& operator[](std::size_t index) const { return values_[index]; }

    /// The values of row `y`, from the left.
    std::span<T> row(int y) {
        return std::span(values_).subspan(begin_of_row(y), static_cast<std::size_t>(width_));
    }
    std::span<const T> row(int y) const {
        return std::span(values_).subspan(begin_of_row(y), static_cast<std::size_t>(width_));
    }
    /// All values, row by row.
    std::span<T> values() { return values_; }
    std::span<const T> values() const { return values_; }

    auto begin() { return values_.begin(); }
    auto begin() const { return values_.begin(); }
    auto end() { return values_.end(); }
    auto end() const { return values_.end(); }

  private:
    static std::size_t area(int width, int height) {
        assert(width >= 0 && height >= 0);
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::size_t begin_of_row(int y) const {
        assert(y >= 0 && y < height_);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<T> values_;
};

}  // namespace uw
