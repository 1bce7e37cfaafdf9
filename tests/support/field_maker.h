#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "media/volumes/load_volumes.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {

/// Fields from fixtures: writes, loads with `per_unit` for constituent 0 (or as `loads` says).
class FieldMaker {
  public:
    std::unique_ptr<ConcentrationField> load(
        const std::vector<VolumeDesc>& volumes,
        const std::vector<std::vector<std::vector<GridLoad>>>& l, int constituents,
        std::size_t slab_bytes = k_default_slab_bytes) {
        reports.clear();
        warnings.clear();
        return load_volumes(volumes, l, constituents, reports, warnings, slab_bytes);
    }
    std::unique_ptr<ConcentrationField> field(const VdbFixture& fixture,
                                              Centering centering = Centering::node,
                                              UpAxis up = UpAxis::y,
                                              std::size_t slab_bytes = k_default_slab_bytes) {
        return load({volume(fixture, centering, up)}, {{{GridLoad{0, 1.0}}}}, 1, slab_bytes);
    }
    VolumeDesc volume(const VdbFixture& fixture, Centering centering = Centering::node,
                      UpAxis up = UpAxis::y) {
        VolumeDesc desc;
        desc.file = dir / std::to_string(++files);
        desc.file += ".vdb";
        write_fixture(desc.file, {fixture});
        desc.grids.resize(1);
        desc.grids[0].grid = fixture.name;
        desc.centering = centering;
        desc.up = up;
        return desc;
    }

    TempDir dir;
    int files = 0;
    std::vector<VolumeReport> reports;
    std::vector<std::string> warnings;
};

inline double value_at(const ConcentrationField& field, const Point3& x) {
    double value = 0;
    field.sample(x, {&value, 1});
    return value;
}
inline double column_of(const ConcentrationField& field, const Point3& a, const Point3& b) {
    double value = 0;
    field.column(a, b, {&value, 1});
    return value;
}
inline double profile_column(const ConcentrationField& field, const Point3& a, const Point3& b) {
    ConcentrationProfile profile;
    field.profile({a, glm::normalize(b - a)}, distance(a, b), profile);
    return profile.column.back();
}

/// The laws that every profile obeys, whatever the field.
inline void expect_lawful(const ConcentrationProfile& p, double s_end) {
    const auto count = static_cast<std::size_t>(p.constituent_count);
    ASSERT_GE(p.s.size(), 2U);
    ASSERT_EQ(p.concentration.size(), p.s.size() * count);
    ASSERT_EQ(p.column.size(), p.s.size() * count);
    EXPECT_EQ(p.s.front(), 0.0);
    EXPECT_EQ(p.s.back(), s_end);
    for (std::size_t i = 1; i < p.s.size(); ++i) {
        EXPECT_GT(p.s[i], p.s[i - 1]);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = i * count + k;
            EXPECT_GE(p.concentration[at], 0);
            const double trapezoid =
                0.5 * (p.concentration[at] + p.concentration[at - count]) * (p.s[i] - p.s[i - 1]);
            EXPECT_NEAR(p.column[at], p.column[at - count] + trapezoid, 1e-12 * (1 + p.column[at]));
        }
    }
}

/// Asymmetric values on 20 x 18 x 22 voxels that cross block boundaries and zero.
inline double bumpy(int i, int j, int k) {
    return 1.5 + std::sin(0.9 * i + 0.3 * k) + 0.4 * std::cos(1.3 * j - 0.5 * k);
}
inline VdbFixture bumpy_fixture() {
    VdbFixture fixture;
    fixture.min = {-9, -3, -6};
    fixture.max = {10, 14, 15};
    fixture.value = bumpy;
    return fixture;
}
inline double bumpy_or_zero(int i, int j, int k) {
    const bool inside = i >= -9 && i <= 10 && j >= -3 && j <= 14 && k >= -6 && k <= 15;
    return inside ? bumpy(i, j, k) : 0.0;
}
/// Trilinear interpolation straight from its definition: hat functions around each voxel.
inline double bumpy_trilinear(const Point3& u) {
    double sum = 0;
    for (int i = static_cast<int>(std::floor(u.x)); i <= std::floor(u.x) + 1; ++i)
        for (int j = static_cast<int>(std::floor(u.y)); j <= std::floor(u.y) + 1; ++j)
            for (int k = static_cast<int>(std::floor(u.z)); k <= std::floor(u.z) + 1; ++k)
                sum += bumpy_or_zero(i, j, k) * (1 - std::abs(u.x - i)) * (1 - std::abs(u.y - j)) *
                       (1 - std::abs(u.z - k));
    return sum;
}

// Half a quantum of a block whose values span at most 0 to 2.9, plus float rounding.
inline constexpr double k_quantum = 0.5 * 2.9 / 65535 + 1e-6;

struct NamedTransform {
    const char* name;
    Affine file_from_index;
};

inline std::vector<NamedTransform> transforms() {
    const Affine turned = Affine::rotation_xyz_degrees({20, -35, 50});
    const Matrix3 shear(1, 0, 0, 0.4, 1, 0, -0.2, 0.3, 1);
    const Vector3 offset(0.3, -0.2, 1.7);
    return {
        {"uniform", Affine::scale(Vector3(0.05))},
        {"moved", Affine::translation(offset) * Affine::scale(Vector3(0.05))},
        {"anisotropic", Affine::scale({0.04, 0.07, 0.02})},
        {"rotated", Affine::translation(offset) * turned * Affine::scale(Vector3(0.05))},
        {"sheared", Affine(shear * 0.05, offset)},
        {"negative", Affine::translation(offset) * turned * Affine::scale({-0.05, 0.06, -0.04})},
        {"mirrored", Affine::scale({0.05, -0.05, 0.05})}};
}

}  // namespace uw::test
