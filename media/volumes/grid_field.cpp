#include "media/volumes/grid_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace uw {

namespace {

/// World bounds of a lattice box; an affine map takes its corners to those of its image.
Bounds bounds_of_image(const Affine& map, const Bounds& box, double shrink) {
    Bounds image;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis & 1U) != 0 ? box.max[axis] - shrink : box.min[axis] + shrink;
        image.extend(map * p);
    }
    return image;
}

}  // namespace

GridVolume::GridVolume(std::vector<NanoGrid> bricks, const Affine& world_from_index,
                       Centering centering, std::vector<GridLoad> loads)
    : bricks_(std::move(bricks)), loads_(std::move(loads)) {
    const double shift = centering == Centering::cell ? 0.5 : 0.0;
    const Affine world_from_lattice = world_from_index * Affine::translation(Vector3(shift));
    lattice_from_world_ = world_from_lattice.inverse();
    const Matrix3& linear = world_from_lattice.linear();
    voxel_size_ = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    for (const NanoGrid& brick : bricks_) {
        bounds_.extend(bounds_of_image(world_from_lattice, brick.support(), 0.0));
        voxel_bounds_.extend(bounds_of_image(world_from_lattice, brick.support(), 0.5));
    }
}

GridVolume GridVolume::scaled(double factor) const {
    GridVolume other = *this;
    for (GridLoad& load : other.loads_) load.per_unit *= factor;
    return other;
}

double GridVolume::value(const Point3& x) const {
    const Point3 p = lattice_from_world_ * x;
    double sum = 0;
    for (const NanoGrid& brick : bricks_) sum += brick.sample(p);
    return sum;
}

double GridVolume::column(const Point3& a, const Point3& b) const {
    const LatticeLine line = lattice_line(a, b - a);
    double sum = 0;
    for (const NanoGrid& brick : bricks_) sum += brick.integrate(line);
    return sum * distance(a, b);
}

std::size_t GridVolume::regions_along(const Point3& a, const Point3& b) const {
    const LatticeLine line = lattice_line(a, b - a);
    std::size_t count = 0;
    for (const NanoGrid& brick : bricks_) count += brick.regions_along(line);
    return count;
}

namespace {

// An interval is split if its halves are not much shorter than the least length.
constexpr double k_splittable = 1.25;

/// Makes a coarse profile as fine as a tolerance requires: intervals are halved where a sample
/// halfway, or halfway through the next interval, differs from linear interpolation by more than
/// the tolerance. The sample stays, so that the error left is about a quarter of the one allowed
/// where concentrations are smooth. Sheets as thin as half an interval are not missed.
class ProfileRefinement {
  public:
    /// Writes the concentrations at the distances `s`, one per constituent each.
    using Sample = std::function<void(std::span<const double> s, std::vector<double>& values)>;

    /// Refines `profile`, whose knots and concentrations are given, and computes its columns.
    /// `least[i]`: interval i is not split into any shorter than about this [m]; infinite where
    /// nothing varies.
    void run(const DepthTolerance& tolerance, const Sample& sample, std::vector<double>& least,
             ConcentrationProfile& profile);

  private:
    void merge(const DepthTolerance& tolerance, std::vector<double>& least,
               ConcentrationProfile& profile);
    void find_refused(const DepthTolerance& tolerance);
    bool confirmed(const DepthTolerance& tolerance, std::size_t interval, const double* middle);

    std::vector<char> open_, open_before_;  // intervals that a sample halfway must confirm
    std::vector<char> refused_;             // by interval, one more at either end
    std::vector<double> middles_, values_;  // their midpoints, and the concentrations there
    std::vector<double> error_;
    ConcentrationProfile before_;
    std::vector<double> min_before_;
};

void ProfileRefinement::run(const DepthTolerance& tolerance, const Sample& sample,
                            std::vector<double>& least, ConcentrationProfile& profile) {
    profile.integrate();
    open_.clear();
    for (std::size_t i = 0; i + 1 < profile.s.size(); ++i)
        open_.push_back(profile.s[i + 1] - profile.s[i] > k_splittable * least[i] ? 1 : 0);
    while (true) {
        middles_.clear();
        for (std::size_t i = 0; i < open_.size(); ++i)
            if (open_[i] != 0) middles_.push_back(0.5 * (profile.s[i] + profile.s[i + 1]));
        if (middles_.empty()) return;
        sample(middles_, values_);
        merge(tolerance, least, profile);
    }
}

// Adds the samples halfway as knots, and decides which intervals between them stay open. A sheet of
// one voxel can pass two samples as a straight line, but then the next interval detects it.
void ProfileRefinement::merge(const DepthTolerance& tolerance, std::vector<double>& least,
                              ConcentrationProfile& profile) {
    std::swap(profile, before_);
    std::swap(least, min_before_);
    std::swap(open_, open_before_);
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    find_refused(tolerance);
    profile.constituent_count = before_.constituent_count;
    profile.s.clear();
    profile.concentration.clear();
    least.clear();
    open_.clear();
    std::size_t middle = 0;
    const auto add_knot = [&](double s, const double* concentration) {
        profile.s.push_back(s);
        profile.concentration.insert(profile.concentration.end(), concentration,
                                     concentration + count);
    };
    for (std::size_t i = 0; i < open_before_.size(); ++i) {
        add_knot(before_.s[i], &before_.concentration[i * count]);
        least.push_back(min_before_[i]);
        open_.push_back(0);
        if (open_before_[i] == 0) continue;
        const double half = middles_[middle] - before_.s[i];
        // refused_[i + 1] is the interval's own.
        const bool refused = refused_[i] != 0 || refused_[i + 1] != 0 || refused_[i + 2] != 0;
        const bool split = refused && half > k_splittable * min_before_[i];
        open_.back() = split ? 1 : 0;
        add_knot(middles_[middle], &values_[middle * count]);
        ++middle;
        least.push_back(min_before_[i]);
        open_.push_back(split ? 1 : 0);
    }
    add_knot(before_.s.back(), &before_.concentration[open_before_.size() * count]);
    profile.integrate();
}

// Finds the open intervals whose sample halfway refuses the interpolation. The list has one
// interval more at either end.
void ProfileRefinement::find_refused(const DepthTolerance& tolerance) {
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    refused_.assign(open_before_.size() + 2, 0);
    std::size_t middle = 0;
    for (std::size_t i = 0; i < open_before_.size(); ++i) {
        if (open_before_[i] == 0) continue;
        if (!confirmed(tolerance, i, &values_[middle * count])) refused_[i + 1] = 1;
        ++middle;
    }
}

bool ProfileRefinement::confirmed(const DepthTolerance& tolerance, std::size_t interval,
                                  const double* middle) {
    const auto count = static_cast<std::size_t>(before_.constituent_count);
    const double* const begin = &before_.concentration[interval * count];
    const double length = before_.s[interval + 1] - before_.s[interval];
    error_.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        error_[k] = length * (middle[k] - 0.5 * (begin[k] + begin[count + k]));
    return tolerance.allows(error_, before_.s[interval],
                            std::span(before_.column).subspan(interval * count, count));
}

constexpr double k_infinity = std::numeric_limits<double>::infinity();
// The interpolant is a cubic in each cell; linear interpolation with four knots per voxel has an
// error of 0.06 % in the in-scatter of a rough plume, with two knots 0.2 %.
constexpr double k_voxels_per_knot = 0.25;
// coarse_profile has intervals of this many such steps, one voxel.
constexpr double k_steps_of_voxel = 4;
// profile_within starts with intervals of this many such steps, two voxels, and samples halfway.
constexpr double k_coarse_steps = 8;

/// An interval of the ray with the step that one brick requires.
struct PacedStretch {
    double begin = 0, end = 0;
    double step = 0;  // infinite where the value is constant
};

/// What the profile of a ray is made in.
struct Scratch {
    std::vector<GridStretch> intervals;
    std::vector<PacedStretch> paced;
    std::vector<std::size_t> cursor, list_end;  // one list of intervals per brick within `paced`
    std::vector<double> boundaries;
    std::vector<char> at_empty;  // knots next to an empty piece, where the concentration is zero
    std::vector<double> least;   // that of sample_profile
    std::vector<double> at_knots;
    ProfileRefinement refinement;
};

// It belongs to the thread, since whoever asks a field for a profile need not know that it has
// grids: allocating this for each ray takes a tenth of the instructions of
// assets/scenes/plume.yaml.
Scratch& scratch_of_thread() {
    thread_local Scratch scratch;
    return scratch;
}

void gather_intervals(const std::vector<GridVolume>& volumes, const Ray& ray, double s_end,
                      Scratch& scratch) {
    scratch.paced.clear();
    scratch.cursor.clear();
    scratch.list_end.clear();
    scratch.boundaries.assign({0.0, s_end});
    for (const GridVolume& volume : volumes) {
        const LatticeLine line = volume.lattice_line(ray.origin, ray.direction);
        const double pace = k_voxels_per_knot / glm::length(line.direction);
        for (const NanoGrid& brick : volume.bricks()) {
            scratch.intervals.clear();
            brick.append_intervals(line, 0, s_end, scratch.intervals);
            scratch.cursor.push_back(scratch.paced.size());
            for (const GridStretch& interval : scratch.intervals) {
                scratch.paced.push_back(
                    {interval.begin, interval.end, interval.constant ? k_infinity : pace});
                scratch.boundaries.push_back(interval.begin);
                scratch.boundaries.push_back(interval.end);
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
                  ConcentrationProfile& profile, Scratch& scratch, std::vector<double>& least) {
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
    least.resize(profile.s.size() - 1, step == 0 ? k_infinity : step);
}

// Intervals are `coarsening` times as long as the bricks require.
void place_knots(double s_end, double coarsening, ConcentrationProfile& profile, Scratch& scratch,
                 std::vector<double>& least) {
    profile.s.assign(1, 0.0);
    scratch.at_empty.assign(1, 0);
    least.clear();
    double piece_begin = 0, piece_step = -1;
    for (std::size_t i = 0; i + 1 < scratch.boundaries.size(); ++i) {
        const double begin = scratch.boundaries[i];
        const double step = step_of_piece(begin, scratch);
        if (piece_step >= 0 && (step != piece_step || step == k_infinity)) {
            append_piece(piece_begin, begin, piece_step, coarsening, profile, scratch, least);
            piece_begin = begin;
        }
        piece_step = step;
    }
    append_piece(piece_begin, s_end, std::max(piece_step, 0.0), coarsening, profile, scratch,
                 least);
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
    const auto count = static_cast<std::size_t>(constituent_count_);
    concentration.assign(s.size() * count, 0.0);
    std::vector<double>& at_knots = scratch_of_thread().at_knots;
    for (const GridVolume& volume : volumes_) {
        const LatticeLine line = volume.lattice_line(ray.origin, ray.direction);
        at_knots.assign(s.size(), 0.0);
        for (const NanoGrid& brick : volume.bricks()) brick.add_samples(line, s, at_knots);
        for (std::size_t knot = 0; knot < s.size(); ++knot) {
            if (at_knots[knot] == 0) continue;
            for (const GridLoad& load : volume.loads())
                concentration[knot * count + static_cast<std::size_t>(load.constituent)] +=
                    load.per_unit * at_knots[knot];
        }
    }
}

bool GridField::sample_profile(const Ray& ray, double s_end, double steps,
                               ConcentrationProfile& profile, std::vector<double>& least) const {
    Scratch& scratch = scratch_of_thread();
    profile.constituent_count = constituent_count_;
    gather_intervals(volumes_, ray, s_end, scratch);
    place_knots(s_end, steps, profile, scratch, least);
    if (scratch.paced.empty()) {
        profile.concentration.assign(
            profile.s.size() * static_cast<std::size_t>(constituent_count_), 0.0);
        profile.column = profile.concentration;
        return false;
    }
    sample_knots(ray, profile.s, profile.concentration);
    clear_at_empty(scratch, profile);
    return true;
}

void GridField::profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
    if (sample_profile(ray, s_end, 1, profile, scratch_of_thread().least)) profile.integrate();
}

void GridField::coarse_profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
    std::vector<double>& least = scratch_of_thread().least;
    if (sample_profile(ray, s_end, k_steps_of_voxel, profile, least)) profile.integrate();
}

void GridField::profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                               ConcentrationProfile& profile) const {
    if (tolerance.exact()) {
        this->profile(ray, s_end, profile);
        return;
    }
    Scratch& scratch = scratch_of_thread();
    if (!sample_profile(ray, s_end, k_coarse_steps, profile, scratch.least)) return;
    scratch.refinement.run(
        tolerance,
        [&](std::span<const double> s, std::vector<double>& values) {
            sample_knots(ray, s, values);
        },
        scratch.least, profile);
}

}  // namespace uw
