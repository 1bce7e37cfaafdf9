#include "core/paths/irradiance_cache.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>

#include "core/paths/path_segment.h"

namespace uw {

namespace {

// The number of nearest records that are interpolated, and their number if none of those applies.
constexpr std::size_t k_near = 8, k_max_near = 64;
// A record applies at a point if the normals agree, and if the point is no farther from the
// record's tangent plane than this, relative to its distance.
constexpr double k_min_cosine = 0.5, k_max_slope = 0.35;

}  // namespace

/// The nearest records, by ascending distance.
struct IrradianceCache::Near {
    std::array<std::size_t, k_max_near> index;
    std::array<double, k_max_near> square;  // of the distance [m^2]
    std::size_t count = 0;
};

class IrradianceCache::Tree {
  public:
    explicit Tree(std::vector<IrradianceRecord> records)
        : records_(std::move(records)),
          index_(3, *this, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {
        if (!records_.empty()) index_.buildIndex();
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    const IrradianceRecord& record(std::size_t index) const { return records_[index]; }

    void find(const Point3& x, std::size_t count, Near& near) const {
        near.count = 0;
        if (records_.empty()) return;
        const std::array<double, 3> at{x.x, x.y, x.z};
        nanoflann::KNNResultSet<double, std::size_t> result(count);
        result.init(near.index.data(), near.square.data());
        index_.findNeighbors(result, at.data(), {});
        near.count = result.size();
    }

    // The interface that nanoflann requires.
    std::size_t kdtree_get_point_count() const { return records_.size(); }
    double kdtree_get_pt(std::size_t index, std::size_t axis) const {
        return records_[index].position[static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }

  private:
    std::vector<IrradianceRecord> records_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3,
                                        std::size_t>
        index_;
};

namespace {

// The weight (0..1) of a record at this squared distance from the hit, apart from its distance.
double agreement(const IrradianceRecord& record, const SurfaceHit& hit, double square) {
    const double cosine = glm::dot(record.normal, hit.normal);
    if (!(cosine > k_min_cosine)) return 0;
    const double off = glm::dot(hit.position - record.position, record.normal);
    if (off * off > k_max_slope * k_max_slope * square + 1e-12) return 0;
    const double agreeing = (cosine - k_min_cosine) / (1 - k_min_cosine);
    return agreeing * agreeing;
}

}  // namespace

IrradianceCache::IrradianceCache(std::vector<IrradianceRecord> records, std::vector<float> radiance,
                                 std::size_t values)
    : tree_(std::make_unique<Tree>(std::move(records))),
      radiance_(std::move(radiance)),
      values_(values) {}

IrradianceCache::~IrradianceCache() = default;
IrradianceCache::IrradianceCache(IrradianceCache&&) noexcept = default;
IrradianceCache& IrradianceCache::operator=(IrradianceCache&&) noexcept = default;

// Local linear regression (Cleveland 1979) through the nearest records. A mean of them would be
// biased at the edges of a lit side, towards its inside, and too dark where it is brightest.
void IrradianceCache::find(const SurfaceHit& hit, std::span<double> radiance) const {
    std::ranges::fill(radiance, 0.0);
    Near near;
    tree_->find(hit.position, k_near, near);
    if (near.count == 0) return;
    std::array<double, k_max_near> coefficients;
    if (!find_coefficients(hit, near, coefficients)) {
        tree_->find(hit.position, k_max_near, near);
        if (!find_coefficients(hit, near, coefficients)) {
            // Falls back on the nearest record that faces the same half-space.
            const auto faces = [&](std::size_t index) {
                return glm::dot(tree_->record(index).normal, hit.normal) > 0;
            };
            const auto end = near.index.begin() + static_cast<std::ptrdiff_t>(near.count);
            const auto found = std::find_if(near.index.begin(), end, faces);
            if (found == end) return;
            std::fill(coefficients.begin(), coefficients.end(), 0.0);
            coefficients[static_cast<std::size_t>(found - near.index.begin())] = 1;
        }
    }
    for (std::size_t i = 0; i < near.count; ++i) {
        if (coefficients[i] == 0) continue;
        const float* record_values = &radiance_[near.index[i] * values_];
        for (std::size_t k = 0; k < values_; ++k)
            radiance[k] += coefficients[i] * static_cast<double>(record_values[k]);
    }
    for (double& value : radiance) value = std::max(value, 0.0);
}

bool IrradianceCache::find_coefficients(const SurfaceHit& hit, const Near& near,
                                        std::span<double> coefficients) const {
    // Regularises the slope where the records determine it poorly.
    constexpr double k_ridge = 0.005;
    const double farthest = std::sqrt(std::max(near.square[near.count - 1], 1e-24));
    std::array<double, k_max_near> weights{}, x{}, y{};
    const auto [u, v] = Tangents(hit.normal);
    double s0 = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (std::size_t i = 0; i < near.count; ++i) {
        const IrradianceRecord& record = tree_->record(near.index[i]);
        const double agreeing = agreement(record, hit, near.square[i]);
        if (!(agreeing > 0)) continue;
        // The farthest has nearly no weight, so that the result is continuous.
        const double nearness = 1 - std::sqrt(near.square[i]) / farthest;
        const double w = agreeing * (nearness * nearness + 1e-4);
        const Vector3 offset = (record.position - hit.position) / farthest;
        weights[i] = w;
        x[i] = glm::dot(offset, u);
        y[i] = glm::dot(offset, v);
        s0 += w;
        sx += w * x[i];
        sy += w * y[i];
        sxx += w * x[i] * x[i];
        sxy += w * x[i] * y[i];
        syy += w * y[i] * y[i];
    }
    if (!(s0 > 0)) return false;
    sxx += k_ridge * s0;
    syy += k_ridge * s0;
    const double determinant = sxx * syy - sxy * sxy;
    const double gx = (sx * syy - sy * sxy) / determinant;
    const double gy = (sy * sxx - sx * sxy) / determinant;
    const double all = s0 - gx * sx - gy * sy;
    for (std::size_t i = 0; i < near.count; ++i)
        coefficients[i] = weights[i] * (1 - gx * x[i] - gy * y[i]) / all;
    return true;
}

bool IrradianceCache::covers(const SurfaceHit& hit, double radius) const {
    Near near;
    tree_->find(hit.position, k_max_near, near);
    for (std::size_t i = 0; i < near.count && near.square[i] <= radius * radius; ++i)
        if (agreement(tree_->record(near.index[i]), hit, near.square[i]) > 0) return true;
    return false;
}

}  // namespace uw
