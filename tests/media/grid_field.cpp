// ctest labels: analytic metamorphic
#include "media/grid_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb_fixtures.h"

namespace uw {
namespace {

using test::TempDir;
using test::VdbBox;
using test::VdbFixture;

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
        test::write_fixture(desc.file, {fixture});
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

double value_at(const ConcentrationField& field, const Point3& x) {
    double value = 0;
    field.sample(x, {&value, 1});
    return value;
}
double column_of(const ConcentrationField& field, const Point3& a, const Point3& b) {
    double value = 0;
    field.column(a, b, {&value, 1});
    return value;
}
double profile_column(const ConcentrationField& field, const Point3& a, const Point3& b) {
    ConcentrationProfile profile;
    field.profile({a, glm::normalize(b - a)}, distance(a, b), profile);
    return profile.column.back();
}

/// The laws every profile keeps, whatever the field.
void expect_lawful(const ConcentrationProfile& p, double s_end) {
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

/// Values without symmetry on 20 x 18 x 22 voxels that cross block boundaries and zero.
double bumpy(int i, int j, int k) {
    return 1.5 + std::sin(0.9 * i + 0.3 * k) + 0.4 * std::cos(1.3 * j - 0.5 * k);
}
VdbFixture bumpy_fixture() {
    VdbFixture fixture;
    fixture.min = {-9, -3, -6};
    fixture.max = {10, 14, 15};
    fixture.value = bumpy;
    return fixture;
}
double bumpy_or_zero(int i, int j, int k) {
    const bool inside = i >= -9 && i <= 10 && j >= -3 && j <= 14 && k >= -6 && k <= 15;
    return inside ? bumpy(i, j, k) : 0.0;
}
/// Trilinear interpolation straight from its definition: hat functions around each voxel.
double bumpy_trilinear(const Point3& u) {
    double sum = 0;
    for (int i = static_cast<int>(std::floor(u.x)); i <= std::floor(u.x) + 1; ++i)
        for (int j = static_cast<int>(std::floor(u.y)); j <= std::floor(u.y) + 1; ++j)
            for (int k = static_cast<int>(std::floor(u.z)); k <= std::floor(u.z) + 1; ++k)
                sum += bumpy_or_zero(i, j, k) * (1 - std::abs(u.x - i)) * (1 - std::abs(u.y - j)) *
                       (1 - std::abs(u.z - k));
    return sum;
}

// Half a quantum of a block whose values span at most 0 to 2.9, plus float rounding.
constexpr double k_quantum = 0.5 * 2.9 / 65535 + 1e-6;

struct NamedTransform {
    const char* name;
    Affine file_from_index;
};

std::vector<NamedTransform> transforms() {
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

TEST(GridField, SamplesAreTrilinearUnderAnyTransform) {
    FieldMaker maker;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(-12, 18);
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        for (int n = 0; n < 2000; ++n) {
            const Point3 u{anywhere(random), anywhere(random), anywhere(random)};
            EXPECT_NEAR(value_at(*field, file_from_index * u), bumpy_trilinear(u), k_quantum)
                << name;
        }
    }
}

TEST(GridField, CellsSitHalfAVoxelFurther) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = Affine::scale({0.04, 0.07, -0.02});
    const auto node = maker.field(fixture, Centering::node);
    EXPECT_EQ(maker.reports[0].placement.centering, Centering::node);
    const Bounds node_bounds = maker.reports[0].bounds;
    const auto cell = maker.field(fixture, Centering::cell);
    EXPECT_EQ(maker.reports[0].placement.centering, Centering::cell);
    const Vector3 shift(0.02, 0.035, -0.01);
    EXPECT_NEAR(glm::length(maker.reports[0].bounds.min - node_bounds.min - shift), 0, 1e-12);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    for (int n = 0; n < 500; ++n) {
        const Point3 x{anywhere(random), anywhere(random), anywhere(random)};
        EXPECT_NEAR(value_at(*cell, x + shift), value_at(*node, x), 1e-9);
    }
    // Centred on nodes, voxel (0, 0, 0) itself.
    EXPECT_NEAR(value_at(*node, {0, 0, 0}), bumpy(0, 0, 0), k_quantum);
}

TEST(GridField, UpZIsTurnedUpright) {
    FieldMaker maker;
    VolumeDesc desc = maker.volume(bumpy_fixture(), Centering::node, UpAxis::z);
    desc.world_from_upright = Affine::translation({10, 20, 30}) * Affine::scale(Vector3(2.0));
    const auto field = maker.load({desc}, {{{GridLoad{0, 1.0}}}}, 1);
    // The file's (1, 2, 3) is upright (1, 3, -2).
    EXPECT_NEAR(value_at(*field, {10 + 2, 20 + 6, 30 - 4}), bumpy(1, 2, 3), k_quantum);
    EXPECT_EQ(maker.reports[0].metres_per_voxel, Vector3(2.0));
}

TEST(GridField, AutomaticPlacementKnowsBlender) {
    FieldMaker maker;
    const auto place = [&](const VdbFixture& fixture, const std::string& creator) {
        test::write_fixture(maker.dir / "auto.vdb", {fixture}, creator);
        return decide_placement(read_vdb_header(maker.dir / "auto.vdb", "here"), VolumeDesc{});
    };
    VdbFixture fixture = bumpy_fixture();
    EXPECT_EQ(place(fixture, "Houdini").centering, Centering::node);
    EXPECT_EQ(place(fixture, "Houdini").up, UpAxis::y);
    EXPECT_EQ(place(fixture, "").centering, Centering::node);  // "density" is everyone's name
    fixture.blender_metadata = true;
    EXPECT_EQ(place(fixture, "").centering, Centering::cell);
    EXPECT_EQ(place(fixture, "").up, UpAxis::z);
    EXPECT_TRUE(place(fixture, "").automatic_centering);
    EXPECT_EQ(place(fixture, "Houdini").centering, Centering::node);  // converted by Houdini
    fixture.blender_metadata = false;
    fixture.name = "density_noise";
    EXPECT_EQ(place(fixture, "").centering, Centering::cell);
}

/// Composite midpoint rule over the definition of the interpolant.
double bumpy_column(const Affine& file_from_index, const Point3& a, const Point3& b) {
    const Affine index_from_file = file_from_index.inverse();
    constexpr int n = 40000;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        sum += bumpy_trilinear(index_from_file * (a + (i + 0.5) / n * (b - a)));
    return sum / n * distance(a, b);
}

TEST(GridField, ColumnsAreTheIntegralsOfTheInterpolant) {
    FieldMaker maker;
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        const std::array<std::array<Point3, 2>, 6> index_segments{
            {{{{-20, -9, -15}, {21, 19, 24}}},       // across, from outside to outside
             {{{0.3, 1.1, 2.7}, {6.2, 3.3, 14.9}}},  // inside
             {{{-20, 4.3, 5.2}, {20, 4.3, 5.2}}},    // along an axis
             {{{3, 5, -20}, {3, 5, 30}}},            // along voxel faces
             {{{16, 7, 40}, {16, 7, -40}}},          // in the empty half of a block, misses
             {{{30, 20, -9}, {-12, 6, 0}}}}};        // grazes
        for (const auto& [u, v] : index_segments) {
            const Point3 a = file_from_index * u, b = file_from_index * v;
            const double expected = bumpy_column(file_from_index, a, b);
            // Quantisation, and the midpoint rule over 40000 steps of at most 2e-3 voxels.
            const double tolerance = k_quantum * distance(a, b) + 1e-6;
            EXPECT_NEAR(column_of(*field, a, b), expected, tolerance) << name;
            EXPECT_NEAR(column_of(*field, b, a), expected, tolerance) << name;
            // The profile's linear pieces differ by O(step^2) of the field's curvature.
            EXPECT_NEAR(profile_column(*field, a, b), expected, 4e-3 * expected + 1e-6) << name;
        }
    }
}

TEST(GridField, ColumnsAdd) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.boxes = {{{40, 0, 0}, {359, 150, 150}, 0.7}};  // with tiles of 128^3
    fixture.file_from_index = transforms()[4].file_from_index;
    const auto field = maker.field(fixture);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(-40, 400), fraction(0, 1);
    for (int n = 0; n < 500; ++n) {
        const Point3 a =
            fixture.file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 c =
            fixture.file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 b = a + fraction(random) * (c - a);
        const double whole = column_of(*field, a, c);
        // Exact in each part; what is left is double rounding over some hundred cells.
        EXPECT_NEAR(column_of(*field, a, b) + column_of(*field, b, c), whole, 1e-10 * (1 + whole));
    }
    EXPECT_EQ(column_of(*field, {1, 2, 3}, {1, 2, 3}), 0);
}

TEST(GridField, ConstantGridIsMetricUnderAnyTransform) {
    FieldMaker maker;
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture;
        fixture.boxes = {{{0, 0, 0}, {199, 139, 99}, 0.25}};
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture);
        const Point3 a = file_from_index * Point3{3, 2, 5},
                     b = file_from_index * Point3{190, 130, 91};
        EXPECT_NEAR(column_of(*field, a, b), 0.25 * distance(a, b), 1e-12) << name;
        EXPECT_NEAR(profile_column(*field, a, b), 0.25 * distance(a, b), 1e-12) << name;
    }
}

TEST(GridField, ConstantGridForgetsItsVoxelSize) {
    FieldMaker maker;
    VdbFixture fine;
    fine.boxes = {{{0, 0, 0}, {63, 63, 63}, 2.0}};
    fine.file_from_index = Affine::scale(Vector3(0.01));
    VdbFixture coarse = fine;
    coarse.boxes[0].max = {31, 31, 31};
    coarse.file_from_index = Affine::scale(Vector3(0.02));
    const auto a = maker.field(fine, Centering::cell);
    const auto b = maker.field(coarse, Centering::cell);
    // A cell-centred constant box of side L ramps from 0 to its value over one voxel, centred on
    // the box's face: straight through, the integral is value * L whatever the voxel.
    for (const Vector3 along : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, -1)}) {
        const Point3 middle{0.32, 0.31, 0.33};
        EXPECT_NEAR(column_of(*a, middle - along, middle + along), 2 * 0.64, 1e-12);
        EXPECT_NEAR(column_of(*b, middle - along, middle + along), 2 * 0.64, 1e-12);
        EXPECT_NEAR(profile_column(*a, middle - along, middle + along), 2 * 0.64, 1e-9);
    }
}

/// exp(-r^2 / 2 sigma^2) about the origin, cut off where it falls below 1e-7.
VdbFixture gaussian(int voxels_per_sigma, double sigma) {
    const int radius = static_cast<int>(5.7 * voxels_per_sigma);
    VdbFixture fixture;
    fixture.min = {-radius, -radius, -radius};
    fixture.max = {radius, radius, radius};
    const double h = 1.0 / voxels_per_sigma;
    fixture.value = [h](int i, int j, int k) {
        return std::exp(-0.5 * h * h * (i * i + j * j + k * k));
    };
    fixture.file_from_index = Affine::scale(Vector3(sigma * h));
    return fixture;
}

TEST(GridField, GaussianColumnConvergesWithTheSquareOfTheVoxel) {
    FieldMaker maker;
    const double sigma = 0.3;
    std::array<double, 3> error{};
    for (std::size_t level = 0; level < 3; ++level) {
        const auto field = maker.field(gaussian(2 << level, sigma));
        const Vector3 direction = glm::normalize(Vector3(0.3, 0.8, -0.5));
        const Vector3 aside = glm::normalize(glm::cross(direction, Vector3(1, 0, 0)));
        for (const double miss : {0.0, 0.11, 0.35}) {  // distance of the line from the centre
            const Point3 middle = at_origin_plus(miss * aside);
            const double expected = sigma * std::sqrt(2 * std::numbers::pi) *
                                    std::exp(-0.5 * miss * miss / (sigma * sigma));
            const double column =
                column_of(*field, middle - 3.0 * direction, middle + 3.0 * direction);
            error[level] = std::max(error[level], std::abs(column - expected) / expected);
        }
    }
    // Linear interpolation: the error falls by 4 per halving of the voxel.
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.35) << error[0] << " " << error[1];
    EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.35) << error[1] << " " << error[2];
    EXPECT_LT(error[2], 0.01);
}

TEST(GridField, HalvesAddToTheWhole) {
    FieldMaker maker;
    VdbFixture whole = bumpy_fixture(), left = whole, right = whole;
    left.max[0] = 2;
    right.min[0] = 3;
    const auto one = maker.field(whole);
    const auto two = maker.load({maker.volume(left), maker.volume(right)},
                                {{{GridLoad{0, 1.0}}}, {{GridLoad{0, 1.0}}}}, 1);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> anywhere(-14, 20);
    for (int n = 0; n < 300; ++n) {
        const Point3 a{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 b{anywhere(random), anywhere(random), anywhere(random)};
        // Exact but for the blocks through which the cut goes: these are quantised anew.
        EXPECT_NEAR(value_at(*two, a), value_at(*one, a), 2 * k_quantum);
        EXPECT_NEAR(column_of(*two, a, b), column_of(*one, a, b), 2 * k_quantum * distance(a, b));
        EXPECT_NEAR(profile_column(*two, a, b), profile_column(*one, a, b),
                    5e-3 * column_of(*one, a, b) + 1e-4);
    }
}

TEST(GridField, SlabsAreTheWhole) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.min = {-40, -3, -6};
    fixture.max = {70, 14, 15};
    fixture.boxes = {{{80, -20, -20}, {239, 150, 150}, 0.6}};  // tiles to be cut, too
    const auto whole = maker.field(fixture);
    EXPECT_EQ(maker.reports[0].bricks, 1U);
    const GridStatistics statistics = maker.reports[0].statistics;
    const auto slabs = maker.field(fixture, Centering::node, UpAxis::y, /*slab_bytes=*/1);
    EXPECT_GT(maker.reports[0].bricks, 4U);
    EXPECT_EQ(maker.reports[0].statistics.active_voxels, statistics.active_voxels);
    EXPECT_EQ(maker.reports[0].statistics.min, statistics.min);
    EXPECT_EQ(maker.reports[0].statistics.max, statistics.max);
    EXPECT_NEAR(maker.reports[0].statistics.mean, statistics.mean, 1e-12);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(-60, 260);
    for (int n = 0; n < 300; ++n) {
        const Point3 a{anywhere(random), 0.1 * anywhere(random), 0.1 * anywhere(random)};
        const Point3 b{anywhere(random), 0.1 * anywhere(random), 0.1 * anywhere(random)};
        const double column = column_of(*whole, a, b);
        EXPECT_NEAR(value_at(*slabs, a), value_at(*whole, a), 1e-12);
        EXPECT_NEAR(column_of(*slabs, a, b), column, 1e-10 * (1 + column));
    }
}

TEST(GridField, OverlappingVolumesAndConstituentsAdd) {
    FieldMaker maker;
    VdbFixture box;
    box.boxes = {{{0, 0, 0}, {31, 31, 31}, 1.0}};
    VdbFixture fine = box;  // half the voxel, the same corner
    fine.file_from_index = Affine::scale(Vector3(0.5));
    const auto field =
        maker.load({maker.volume(box), maker.volume(fine)},
                   {{{GridLoad{0, 2.0}, GridLoad{1, 10.0}}}, {{GridLoad{1, 5.0}}}}, 2);
    EXPECT_EQ(field->finest_voxel(), 0.5);
    std::array<double, 2> c{};
    field->sample({10, 10, 10}, c);
    EXPECT_EQ(c[0], 2.0);
    EXPECT_EQ(c[1], 15.0);
    field->column({2, 10, 10}, {22, 10, 10}, c);
    EXPECT_NEAR(c[0], 40, 1e-10);
    // The fine box ends at 15.5 and falls to 0 at 16: 13.5 + 0.25 of it lies on the way.
    EXPECT_NEAR(c[1], 200 + 5 * 13.75, 1e-10);
    ConcentrationProfile profile;
    field->profile({{-9, 10, 10}, {1, 0, 0}}, 60, profile);
    expect_lawful(profile, 60);
    EXPECT_NEAR(profile.column[profile.column.size() - 2], 2 * 32, 1e-9);
    EXPECT_NEAR(profile.column.back(), 10 * 32 + 5 * 16, 1e-9);
    ASSERT_EQ(maker.reports.size(), 2U);
    EXPECT_EQ(maker.reports[0].constituents[1].max, 10);
    EXPECT_NEAR(maker.reports[1].constituents[0].column[0], 5 * 16, 1e-9);
    EXPECT_EQ(maker.reports[1].metres_per_voxel, Vector3(0.5));
    EXPECT_EQ(maker.reports[1].bounds.min, Point3(-0.25, -0.25, -0.25));
    EXPECT_EQ(maker.reports[1].bounds.max, Point3(15.75, 15.75, 15.75));
}

TEST(GridField, ProfileFollowsTheInterpolant) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = transforms()[3].file_from_index;
    const auto field = maker.field(fixture);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> anywhere(-30, 30), inside(0, 9);
    ConcentrationProfile profile;
    for (int n = 0; n < 300; ++n) {
        const Point3 from =
            fixture.file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
        const Point3 to =
            fixture.file_from_index * Point3{inside(random), inside(random), inside(random)};
        // Far beyond the grid; and from inside it, as a camera in the plume.
        for (const Ray& ray :
             {Ray{from, glm::normalize(to - from)}, Ray{to, glm::normalize(from - to)}}) {
            field->profile(ray, 1e4, profile);
            expect_lawful(profile, 1e4);
            for (std::size_t i = 0; i < profile.s.size(); ++i)
                EXPECT_NEAR(profile.concentration[i], value_at(*field, ray.at(profile.s[i])), 1e-9);
            EXPECT_EQ(profile.concentration.back(), 0);
            EXPECT_LT(profile.s.size(), 200U);
            const double exact = column_of(*field, ray.origin, ray.at(100));
            // Half-voxel trapezoids over a field that changes by its own size within 3 voxels.
            EXPECT_NEAR(profile.column.back(), exact, 1e-2 * exact + 1e-4);
        }
    }
}

TEST(GridField, KnotsAreHalfAVoxelApartWhereThereIsSomething) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = Affine::scale(Vector3(0.05));
    const auto field = maker.field(fixture);
    ConcentrationProfile profile;
    field->profile({{-3, 0.2, 0.1}, {1, 0, 0}}, 20, profile);
    expect_lawful(profile, 20);
    int wide = 0;
    for (std::size_t i = 1; i < profile.s.size(); ++i) {
        if (profile.empty_between(i - 1))
            ++wide;
        else
            EXPECT_LE(profile.s[i] - profile.s[i - 1], 0.025 + 1e-12);
    }
    EXPECT_GE(wide, 2);
    EXPECT_TRUE(profile.empty_between(0));
    EXPECT_TRUE(profile.empty_between(profile.s.size() - 2));
}

TEST(GridField, RaysThatMissCostTwoKnots) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    const auto field = maker.field(fixture);
    ConcentrationProfile profile;
    const std::array<Ray, 5> rays{{{{0, 100, 0}, {1, 0, 0}},
                                   {{50, 0, 0}, {1, 0, 0}},  // starts beyond
                                   {{-1e5, 0, 0}, {0, 0, 1}},
                                   {{11, -50, 0}, {0, 1, 0}},   // along the support's last face
                                   {{0, -50, 0}, {0, 1, 0}}}};  // ends before
    for (const Ray& ray : rays) {
        field->profile(ray, 30, profile);
        EXPECT_EQ(profile.s.size(), 2U);
        expect_lawful(profile, 30);
        EXPECT_EQ(profile.column.back(), 0);
        EXPECT_EQ(column_of(*field, ray.origin, ray.at(30)), 0);
    }
    // Grazing the last layer of voxels is no miss.
    EXPECT_GT(column_of(*field, {10.5, -50, 0}, {10.5, 50, 0}), 1);
}

TEST(GridField, WithoutVoxelsAllIsZero) {
    FieldMaker maker;
    const auto empty = maker.field(VdbFixture{});
    EXPECT_EQ(maker.warnings.size(), 1U);
    const auto none = maker.load({}, {}, 3);
    EXPECT_EQ(none->constituent_count(), 3);
    EXPECT_TRUE(none->bounds().empty());
    EXPECT_TRUE(empty->bounds().empty());
    EXPECT_EQ(empty->finest_voxel(), 0);
    EXPECT_EQ(value_at(*empty, {0, 0, 0}), 0);
    EXPECT_EQ(column_of(*empty, {-1, 0, 0}, {1, 0, 0}), 0);
    ConcentrationProfile profile;
    none->profile({{0, 0, 0}, {0, 0, 1}}, 5, profile);
    expect_lawful(profile, 5);
}

TEST(GridField, TransformWithoutExtentIsRefused) {
    FieldMaker maker;
    VolumeDesc desc = maker.volume(bumpy_fixture());
    desc.where = "scene.yaml:9:9: volumes[0]";
    desc.world_from_upright = Affine::scale({1, 0, 1});
    EXPECT_THROW(maker.load({desc}, {{{GridLoad{0, 1.0}}}}, 1), InputError);
}

TEST(GridField, NothingLiesOutsideTheBounds) {
    FieldMaker maker;
    for (const auto& [name, file_from_index] : transforms()) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = file_from_index;
        const auto field = maker.field(fixture, Centering::cell);
        const Bounds bounds = field->bounds();
        std::mt19937 random(7);
        std::uniform_real_distribution<double> anywhere(-14, 20);
        for (int n = 0; n < 2000; ++n) {
            const Point3 x =
                file_from_index * Point3{anywhere(random), anywhere(random), anywhere(random)};
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis)
                inside &= x[axis] >= bounds.min[axis] && x[axis] <= bounds.max[axis];
            if (!inside) {
                EXPECT_EQ(value_at(*field, x), 0) << name;
            }
        }
    }
}

}  // namespace
}  // namespace uw
