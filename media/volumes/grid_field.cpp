#include "media/volumes/grid_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "media/volumes/profile_refinement.h"

namespace uw {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
// The interpolant is a cubic in each cell; linear interpolation with four knots per voxel has an
// error of 0.06 % in the in-scatter of a rough plume, with two knots 0.2 %.
constexpr double k_voxels_per_knot = 0.25;
// profile_within starts with intervals of this many such steps, two voxels, and samples halfway.
constexpr double k_coarse_steps = 8;

/// An interval of the ray with the step that one brick requires.
struct PacedStretch {
    double begin = 0, end = 0;
    double step = 0;  // infinite where the value is constant
};

/// Per-thread storage of profile(), kept so that the hot loop does not allocate.
struct Scratch {
    std::vector<GridStretch> stretches;
    std::vector<PacedStretch> paced;
    std::vector<std::size_t> cursor, list_end;  // one list of intervals per brick within `paced`
    std::vector<double> boundaries;
    std::vector<double> values;
    std::vector<char> at_empty;  // knots next to an empty piece, where the concentration is zero
    std::vector<double> least;   // by interval between knots: the step of its piece, or infinity
    ProfileRefinement refinement;
};

Scratch& scratch_of_thread() {
    thread_local Scratch scratch;
    return scratch;
}

void gather_stretches(const std::vector<GridVolume>& volumes, const Ray& ray, double s_end,
                      Scratch& scratch) {
    scratch.paced.clear();
    scratch.cursor.clear();
    scratch.list_end.clear();
    scratch.boundaries.assign({0.0, s_end});
    for (const GridVolume& volume : volumes) {
        const LatticeLine line = volume.lattice_line(ray.origin, ray.direction);
        const double pace = k_voxels_per_knot / glm::length(line.direction);
        for (const NanoGrid& brick : volume.bricks()) {
            scratch.stretches.clear();
            brick.append_stretches(line, 0, s_end, scratch.stretches);
            scratch.cursor.push_back(scratch.paced.size());
            for (const GridStretch& stretch : scratch.stretches) {
                scratch.paced.push_back(
                    {stretch.begin, stretch.end, stretch.constant ? k_infinity : pace});
                scratch.boundaries.push_back(stretch.begin);
                scratch.boundaries.push_back(stretch.end);
            }
            scratch.list_end.push_back(scratch.paced.size());
        }
    }
    std::sort(scratch.boundaries.begin(), scratch.boundaries.end());
    const auto unique_end = std::unique(scratch.boundaries.begin(), scratch.boundaries.end());
    scratch.boundaries.erase(unique_end, scratch.boundaries.end());
}

/// The finest step that any brick requires in the piece that begins at `begin`; 0 if all are empty.
double step_of_piece(double begin, Scratch& scratch) {
    double step = 0;
    for (std::size_t list = 0; list < scratch.cursor.size(); ++list) {
        std::size_t& at = scratch.cursor[list];
        while (at < scratch.list_end[list] && scratch.paced[at].end <= begin) ++at;
        if (at == scratch.list_end[list] || scratch.paced[at].begin > begin) continue;
        step = step == 0 ? scratch.paced[at].step : std::min(step, scratch.paced[at].step);
    }
    return step;
}

void append_piece(double begin, double end, double step, double coarsening,
                  ConcentrationProfile& profile, Scratch& scratch) {
    if (step == 0) scratch.at_empty.back() = 1;
    if (step > 0 && coarsening * step < end - begin) {
        const double count = std::ceil((end - begin) / (coarsening * step));
        for (double n = 1; n < count; ++n) {
            profile.s.push_back(begin + n * ((end - begin) / count));
            scratch.at_empty.push_back(0);
        }
    }
    profile.s.push_back(end);
    scratch.at_empty.push_back(step == 0 ? 1 : 0);
    scratch.least.resize(profile.s.size() - 1, step == 0 ? k_infinity : step);
}

// Intervals are `coarsening` times as long as the bricks require.
void place_knots(double s_end, double coarsening, ConcentrationProfile& profile, Scratch& scratch) {
    profile.s.assign(1, 0.0);
    scratch.at_empty.assign(1, 0);
    scratch.least.clear();
    double piece_begin = 0, piece_step = -1;
    for (std::size_t i = 0; i + 1 < scratch.boundaries.size(); ++i) {
        const double begin = scratch.boundaries[i];
        const double step = step_of_piece(begin, scratch);
        if (piece_step >= 0 && (step != piece_step || step == k_infinity)) {
            append_piece(piece_begin, begin, piece_step, coarsening, profile, scratch);
            piece_begin = begin;
        }
        piece_step = step;
    }
    append_piece(piece_begin, s_end, std::max(piece_step, 0.0), coarsening, profile, scratch);
}

// The interpolant is continuous: next to an empty interval it is exactly zero.
void clear_at_empty(const Scratch& scratch, ConcentrationProfile& profile) {
    const auto count = static_cast<std::ptrdiff_t>(profile.constituent_count);
    for (std::size_t knot = 0; knot < scratch.at_empty.size(); ++knot) {
        if (scratch.at_empty[knot] != 0)
            std::fill_n(profile.concentration.begin() + static_cast<std::ptrdiff_t>(knot) * count,
                        count, 0.0);
    }
}

}  // namespace

GridField::GridField(std::vector<GridVolume> volumes, int constituent_count)
    : volumes_(std::move(volumes)), constituent_count_(constituent_count) {
    for (const GridVolume& volume : volumes_) {
        if (volume.bricks().empty()) continue;
        bounds_.extend(volume.bounds());
        const Vector3& size = volume.voxel_size();
        const double edge = std::min({size.x, size.y, size.z});
        finest_voxel_ = finest_voxel_ == 0 ? edge : std::min(finest_voxel_, edge);
    }
}

void GridField::sample(const Point3& x, std::span<double> concentration) const {
    std::fill(concentration.begin(), concentration.end(), 0.0);
    for (const GridVolume& volume : volumes_) {
        const double value = volume.value(x);
        if (value == 0) continue;
        for (const GridLoad& load : volume.loads())
            concentration[static_cast<std::size_t>(load.constituent)] += load.per_unit * value;
    }
}

void GridField::column(const Point3& a, const Point3& b, std::span<double> column) const {
    std::fill(column.begin(), column.end(), 0.0);
    for (const GridVolume& volume : volumes_) {
        const double value = volume.column(a, b);
        if (value == 0) continue;
        for (const GridLoad& load : volume.loads())
            column[static_cast<std::size_t>(load.constituent)] += load.per_unit * value;
    }
}

void GridField::sample_knots(const Ray& ray, std::span<const double> s,
                             std::vector<double>& concentration) const {
    Scratch& scratch = scratch_of_thread();
    const auto count = static_cast<std::size_t>(constituent_count_);
    concentration.assign(s.size() * count, 0.0);
    for (const GridVolume& volume : volumes_) {
        const LatticeLine line = volume.lattice_line(ray.origin, ray.direction);
        scratch.values.assign(s.size(), 0.0);
        for (const NanoGrid& brick : volume.bricks()) brick.add_samples(line, s, scratch.values);
        for (std::size_t knot = 0; knot < s.size(); ++knot) {
            if (scratch.values[knot] == 0) continue;
            for (const GridLoad& load : volume.loads())
                concentration[knot * count + static_cast<std::size_t>(load.constituent)] +=
                    load.per_unit * scratch.values[knot];
        }
    }
}

void GridField::profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
    profile_within({}, ray, s_end, profile);
}

void GridField::profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                               ConcentrationProfile& profile) const {
    Scratch& scratch = scratch_of_thread();
    profile.constituent_count = constituent_count_;
    gather_stretches(volumes_, ray, s_end, scratch);
    place_knots(s_end, tolerance.exact() ? 1 : k_coarse_steps, profile, scratch);
    if (scratch.paced.empty()) {
        profile.concentration.assign(
            profile.s.size() * static_cast<std::size_t>(constituent_count_), 0.0);
        profile.column = profile.concentration;
        return;
    }
    sample_knots(ray, profile.s, profile.concentration);
    clear_at_empty(scratch, profile);
    if (tolerance.exact()) {
        profile.integrate();
        return;
    }
    scratch.refinement.run(
        tolerance,
        [&](std::span<const double> s, std::vector<double>& values) {
            sample_knots(ray, s, values);
        },
        scratch.least, profile);
}

}  // namespace uw
