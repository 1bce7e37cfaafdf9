// ctest labels: analytic metamorphic
#include "media/volumes/grid_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/base/error.h"
#include "tests/support/field_maker.h"

namespace uw {
namespace {

using test::bumpy_fixture;
using test::column_of;
using test::expect_lawful;
using test::FieldMaker;
using test::transforms;
using test::value_at;
using test::VdbFixture;

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

struct ColumnErrors {
    double mean = 0, deviation = 0;  // relative to the mean of the exact columns
    double knots = 0;                // relative to those of fine profiles
};

/// The errors of coarse profiles along rays in all directions from points in `box` where there is
/// something.
ColumnErrors coarse_columns(const ConcentrationField& field, const Bounds& box) {
    constexpr int k_rays = 20'000;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> inside(0, 1);
    std::normal_distribution<double> component;
    const double reach = field.bounds().diagonal();
    const Vector3 extent = box.max - box.min;
    ConcentrationProfile coarse, fine;
    double error = 0, squares = 0, exact = 0;
    std::size_t coarse_knots = 0, fine_knots = 0;
    for (int used = 0; used < k_rays;) {
        const Vector3 place(inside(random), inside(random), inside(random));
        const Vector3 direction(component(random), component(random), component(random));
        const Ray ray{box.min + place * extent, glm::normalize(direction)};
        if (value_at(field, ray.origin) == 0) continue;
        ++used;
        field.coarse_profile(ray, reach, coarse);
        field.profile(ray, reach, fine);
        coarse_knots += coarse.s.size();
        fine_knots += fine.s.size();
        const double column = column_of(field, ray.origin, ray.at(reach));
        const double difference = coarse.column.back() - column;
        error += difference;
        squares += difference * difference;
        exact += column;
    }
    return {error / exact, std::sqrt(squares * k_rays) / exact,
            static_cast<double>(coarse_knots) / static_cast<double>(fine_knots)};
}

TEST(GridField, CoarseProfilesAreRightOnAverage) {
    FieldMaker maker;
    VolumeDesc plume;
    plume.file = UWVDB_SOURCE_DIR "/assets/grids/plume128_blosc_half_0030.vdb";
    plume.grids.resize(1);
    plume.grids[0].grid = "density";
    const auto smoke = maker.load({plume}, {{{GridLoad{0, 1.0}}}}, 1);
    const ColumnErrors of_smoke = coarse_columns(*smoke, smoke->bounds());
    // The light of plumes is to be right within 0.3 %.
    EXPECT_NEAR(of_smoke.mean, 0, 1e-3);
    EXPECT_LT(of_smoke.deviation, 0.01);
    EXPECT_LT(of_smoke.knots, 0.35);
    // Ten voxels across, and as much at its sharp edges as anywhere: h^2 f' / 12 is left out there,
    // of f about 1 and f' up to 1 per voxel, where a column is 5 to 10.
    const auto bumps = maker.field(bumpy_fixture());
    const ColumnErrors of_bumps = coarse_columns(*bumps, {{0, 0, 0}, {9, 9, 9}});
    EXPECT_NEAR(of_bumps.mean, 0, 1e-2);
    EXPECT_LT(of_bumps.deviation, 0.02);
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
