// ctest labels: analytic
#include "media/light/deep_shadow_map.h"

#include <gtest/gtest.h>

#include <random>

#include "core/light/lamp.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/random_direction.h"
#include "tests/support/sphere_surface.h"

namespace uw::test {
namespace {

TEST(DeepShadowMap, AsksItsTwoMaps) {
    const SphereSurface sphere({0.5, 0.3, 2}, 0.4);
    const GaussianField field({0, 0, 2}, 0.3, 1.0, 0.1);
    const Point3 lamp{-0.7, 0.6, 0.2};
    const DeepShadowMap whole(field, sphere, lamp, {.shadow_resolution = 64});
    const auto shadows = std::make_shared<ShadowMap>(sphere, lamp, 64);
    const auto columns = std::make_shared<ColumnMap>(field, lamp, 2, 80 << 20);
    const DeepShadowMap shared(shadows, columns);
    EXPECT_EQ(whole.bytes(), shadows->bytes() + columns->bytes());
    EXPECT_EQ(whole.rays_traced(), shadows->rays_traced() + columns->rays_traced());
    const Ray ray{{-1, 0.1, 2.5}, {1, 0, 0}};
    std::vector<Interval> lit, truth;
    whole.lit_intervals(ray, {0, 3}, lit);
    shadows->lit_intervals(ray, {0, 3}, truth);
    ASSERT_EQ(lit.size(), truth.size());
    EXPECT_GT(lit.size(), 1U);  // before and behind the shadow
    for (std::size_t i = 0; i < lit.size(); ++i) EXPECT_EQ(lit[i].end, truth[i].end);
    std::vector<double> breaks, column_breaks;
    shared.append_column_breaks(ray, {0, 3}, breaks);
    columns->append_breaks(ray, {0, 3}, column_breaks);
    EXPECT_EQ(breaks, column_breaks);
    const Point3 x = ray.at(1);
    double column = 0, from_map = 0;
    shared.columns({&x, 1}, {&column, 1});
    columns->columns({&x, 1}, {&from_map, 1});
    EXPECT_EQ(column, from_map);
}

}  // namespace
}  // namespace uw::test
