#include "media/volumes/stratified_field.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/scene/scene_limits.h"

namespace uw {

StratifiedField::StratifiedField(std::shared_ptr<const ConcentrationField> grids,
                                 std::shared_ptr<const Strata> strata)
    : grids_(std::move(grids)), strata_(std::move(strata)) {}

Bounds StratifiedField::bounds() const {
    return {at_origin_plus(Vector3(-k_max_coordinate)), at_origin_plus(Vector3(k_max_coordinate))};
}

void StratifiedField::sample(const Point3& x, std::span<double> concentration) const {
    grids_->sample(x, concentration);
    strata_->add_sample(x, concentration);
}

void StratifiedField::column(const Point3& a, const Point3& b, std::span<double> column) const {
    grids_->column(a, b, column);
    strata_->add_column(a, b, column);
}

void StratifiedField::profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const {
    grids_->profile(ray, s_end, profile);
    add_strata(ray, s_end, profile);
}

void StratifiedField::coarse_profile(const Ray& ray, double s_end,
                                     ConcentrationProfile& profile) const {
    grids_->coarse_profile(ray, s_end, profile);
    add_strata(ray, s_end, profile);
}

void StratifiedField::profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                                     ConcentrationProfile& profile) const {
    grids_->profile_within(tolerance, ray, s_end, profile);
    add_strata(ray, s_end, profile);
}

// Between the knots of both the sum is linear, and so its columns are exact.
void StratifiedField::add_strata(const Ray& ray, double s_end,
                                 ConcentrationProfile& profile) const {
    std::vector<double> breaks;
    strata_->append_breaks(ray, s_end, breaks);
    const ConcentrationProfile grids = std::move(profile);
    const auto count = static_cast<std::size_t>(grids.constituent_count);
    profile.constituent_count = grids.constituent_count;
    profile.s.clear();
    profile.concentration.clear();
    const auto add = [&](double s, std::size_t knot) {
        profile.s.push_back(s);
        const double begin = grids.s[knot], length = grids.s[knot + 1] - begin;
        const double t = length > 0 ? (s - begin) / length : 0;
        for (std::size_t k = 0; k < count; ++k) {
            const double first = grids.concentration[knot * count + k];
            const double last = grids.concentration[(knot + 1) * count + k];
            profile.concentration.push_back(first + t * (last - first));
        }
        strata_->add_sample(ray.at(s), std::span(profile.concentration).last(count));
    };
    std::size_t next = 0;
    for (std::size_t knot = 0; knot + 1 < grids.s.size(); ++knot) {
        add(grids.s[knot], knot);
        for (; next < breaks.size() && breaks[next] < grids.s[knot + 1]; ++next)
            if (breaks[next] > grids.s[knot]) add(breaks[next], knot);
    }
    add(grids.s.back(), grids.s.size() - 2);
    profile.integrate();
}

std::shared_ptr<const ConcentrationField> make_field(std::vector<GridVolume> grids,
                                                     int constituent_count,
                                                     std::shared_ptr<const Strata> strata) {
    auto field = std::make_shared<const GridField>(std::move(grids), constituent_count);
    if (!strata) return field;
    return std::make_shared<const StratifiedField>(std::move(field), std::move(strata));
}

}  // namespace uw
