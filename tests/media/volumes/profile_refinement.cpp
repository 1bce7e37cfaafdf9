// ctest labels: analytic metamorphic
#include "media/volumes/grid_field.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/field_maker.h"
#include "tests/support/tolerance.h"

namespace uw {
namespace {

using test::bumpy_fixture;
using test::column_of;
using test::column_tolerance;
using test::expect_lawful;
using test::FieldMaker;
using test::transforms;
using test::value_at;
using test::VdbFixture;

TEST(ProfileRefinement, FollowsTheFieldMoreCloselyTheLessItMayBeOff) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = transforms()[3].file_from_index;
    const auto field = maker.field(fixture);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> anywhere(-30, 30), inside(0, 9);
    ConcentrationProfile profile;
    std::size_t knots_before = 0;
    for (const double tolerance : {2e-2, 2e-3, 2e-4}) {
        std::size_t knots = 0;
        for (int n = 0; n < 200; ++n) {
            const Point3 from = fixture.file_from_index *
                                Point3{anywhere(random), anywhere(random), anywhere(random)};
            const Point3 to =
                fixture.file_from_index * Point3{inside(random), inside(random), inside(random)};
            const Ray ray{from, glm::normalize(to - from)};
            field->profile_within(column_tolerance(tolerance), ray, 1e4, profile);
            expect_lawful(profile, 1e4);
            knots += profile.s.size();
            for (std::size_t i = 0; i < profile.s.size(); ++i)
                EXPECT_NEAR(profile.concentration[i], value_at(*field, ray.at(profile.s[i])), 1e-9);
            const double exact = column_of(*field, ray.origin, ray.at(100));
            // At most 22 voxels in five coarse steps along an axis, nine along the diagonal, each
            // off by the tolerance, and the trapezoids of quarter voxels as in profile().
            EXPECT_NEAR(profile.column.back(), exact, 9 * tolerance + 1e-2 * exact);
        }
        EXPECT_GT(knots, knots_before);
        knots_before = knots;
    }
}

TEST(ProfileRefinement, WithoutToleranceIsTheProfileItself) {
    FieldMaker maker;
    const auto field = maker.field(bumpy_fixture());
    const Ray ray{{-30, 2.2, 3.1}, glm::normalize(Vector3(1, 0.1, 0.05))};
    ConcentrationProfile profile, within;
    field->profile(ray, 60, profile);
    field->profile_within({}, ray, 60, within);
    EXPECT_EQ(profile.s, within.s);
    EXPECT_EQ(profile.column, within.column);
}

// The greatest |error| e^-depth of the columns of a sheet of one voxel in faint fog. `column`: of
// the sheet along its normal. `tilt`: the greatest tangent of rays against it in either direction.
struct SheetErrors {
    double greatest = 0, max_of_profile = 0;
};
SheetErrors errors_at_sheet(double column, double tolerance, double tilt) {
    FieldMaker maker;
    VdbFixture fixture;
    fixture.boxes = {{{0, 0, 0}, {63, 63, 63}, 1e-4}, {{33, 0, 0}, {33, 63, 63}, column}};
    const auto field = maker.field(fixture);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> offset(0, 4), slope(-tilt, tilt);
    ConcentrationProfile profile;
    SheetErrors errors;
    for (int n = 0; n < 400; ++n) {
        const Vector3 direction = glm::normalize(Vector3(1, slope(random), slope(random)));
        const Point3 middle{33, 31.5, 31.5};
        const Ray ray{middle - (50 + offset(random)) * direction, direction};
        const double exact = column_of(*field, ray.origin, ray.at(120));
        const auto weighted = [&] {
            return std::abs(profile.column.back() - exact) * std::exp(-exact);
        };
        field->profile_within(column_tolerance(tolerance), ray, 120, profile);
        errors.greatest = std::max(errors.greatest, weighted());
        field->profile(ray, 120, profile);
        errors.max_of_profile = std::max(errors.max_of_profile, weighted());
    }
    return errors;
}

TEST(ProfileRefinement, MissesNoSheetOfOneVoxel) {
    const double tolerance = 0.01;
    for (const double tilt : {0.0, 0.1, 1.0}) {
        for (const double column : {0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.4}) {
            SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", column " << column);
            const SheetErrors errors = errors_at_sheet(column, tolerance, tilt);
            // At the finest, quarters of a voxel, the profile itself is off a little.
            EXPECT_LT(errors.greatest, tolerance + errors.max_of_profile);
        }
    }
}

TEST(ProfileRefinement, TakesAKnotPerVoxelWhereNothingChanges) {
    FieldMaker maker;
    VdbFixture fixture;  // an optical depth of 0.13: what lies behind counts as well
    fixture.value = [](int i, int j, int k) {
        return 1e-3 * (1 + 0.01 * i + 0.02 * j + 0.005 * k);
    };
    fixture.min = {0, 0, 0};
    fixture.max = {63, 63, 63};
    const auto field = maker.field(fixture);
    ConcentrationProfile coarse, fine;
    const Ray ray{{-5, 30, 30}, {1, 0, 0}};
    field->profile_within(column_tolerance(1e-3), ray, 100, coarse);
    field->profile(ray, 100, fine);
    // 64 knots inside, and those at the two faces where it falls to 0 within a voxel.
    EXPECT_LT(coarse.s.size(), 64 + 2 * 8U);
    EXPECT_GT(fine.s.size(), 4 * 64U);
    // Nothing but the two faces can be off.
    EXPECT_NEAR(coarse.column.back(), fine.column.back(), 2e-3);
}

}  // namespace
}  // namespace uw
