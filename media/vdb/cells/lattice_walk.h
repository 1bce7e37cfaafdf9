#pragma once

#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "media/vdb/cells/lattice_line.h"

namespace uw {

/// Walks a line through the cells of the interpolation lattice. The cell only ever advances along
/// each axis in the line's direction, so the walk terminates.
class LatticeWalk {
  public:
    LatticeWalk(const LatticeLine& line, double begin, double end, const Bounds& support)
        : line_(line) {
        t_ = begin;
        end_ = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = line.direction[axis];
            if (std::abs(d) < 1e-200) {  // parallel to this axis's faces
                const double p = line.origin[axis];
                if (!(p >= support.min[axis] && p <= support.max[axis]))
                    end_ = -std::numeric_limits<double>::infinity();
                continue;
            }
            sign_[axis] = d > 0 ? 1 : -1;
            inverse_[axis] = 1 / d;
            const double a = (support.min[axis] - line.origin[axis]) * inverse_[axis];
            const double b = (support.max[axis] - line.origin[axis]) * inverse_[axis];
            t_ = std::max(t_, std::min(a, b));
            end_ = std::min(end_, std::max(a, b));
        }
        if (done()) return;
        for (int axis = 0; axis < 3; ++axis) {
            first_[axis] = static_cast<int>(support.min[axis]);
            last_[axis] = static_cast<int>(support.max[axis]) - 1;
            const double p = line.origin[axis] + t_ * line.direction[axis];
            cell_[axis] = std::clamp(static_cast<int>(std::floor(std::clamp(p, -2e9, 2e9))),
                                     first_[axis], last_[axis]);
        }
    }

    bool done() const { return !(t_ < end_); }
    double t() const { return t_; }
    const nanovdb::Coord& cell() const { return cell_; }

    /// Advances to where the line leaves the cells [low, high), or ends, and returns that
    /// parameter.
    double leave(const nanovdb::Coord& low, const nanovdb::Coord& high) {
        double exit = std::numeric_limits<double>::infinity();
        int exit_axis = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (sign_[axis] == 0) continue;
            const int face = sign_[axis] > 0 ? high[axis] : low[axis];
            const double t = (face - line_.origin[axis]) * inverse_[axis];
            if (t < exit) {
                exit = t;
                exit_axis = axis;
            }
        }
        if (!(exit < end_)) {
            t_ = end_;
            return t_;
        }
        t_ = std::max(t_, exit);
        const bool one_cell = high[0] - low[0] == 1;
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == exit_axis)
                cell_[axis] = sign_[axis] > 0 ? high[axis] : low[axis] - 1;
            else if (!one_cell && sign_[axis] != 0)
                move_within(axis, low[axis], high[axis] - 1);
        }
        if (cell_[exit_axis] < first_[exit_axis] || cell_[exit_axis] > last_[exit_axis])
            end_ = t_;  // left the support
        return t_;
    }

  private:
    void move_within(int axis, int low, int high) {
        const double p = std::floor(line_.origin[axis] + t_ * line_.direction[axis]);
        if (sign_[axis] > 0)
            low = std::max(low, cell_[axis]);
        else
            high = std::min(high, cell_[axis]);
        cell_[axis] =
            static_cast<int>(std::clamp(p, static_cast<double>(low), static_cast<double>(high)));
    }

    const LatticeLine& line_;
    double t_ = 0, end_ = 0;
    nanovdb::Coord cell_{0}, first_{0}, last_{0};
    std::array<int, 3> sign_{};
    Vector3 inverse_{0};
};

}  // namespace uw
