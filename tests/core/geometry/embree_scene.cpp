// ctest labels: unit
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/error.h"
#include "core/geometry/embree_surfaces.h"
#include "tests/support/meshes/sheet_object.h"

namespace uw {
namespace {

/// A flat square of 2 n^2 triangles at z = 1, as traced.
SceneObjects square(std::uint32_t n) {
    SceneObjects objects{{test::sheet_object(n, 1)},        {}, {}, {}, {}, {},
                         ReflectanceBands({620, 540, 450}), {}};
    objects.bounds.extend(Point3(0, 0, 1));
    objects.bounds.extend(Point3(1, 1, 1));
    return objects;
}

const Ray k_ray{{0.3, 0.4, 0}, {0, 0, 1}};

TEST(EmbreeScene, StopsWhileItIsBuilt) {
    std::atomic<bool> stop{true};
    const StopScope scope(stop);
    // Again and again: what was begun is given back.
    for (int k = 0; k < 20; ++k) EXPECT_THROW(make_embree_surfaces(square(300)), Interrupted);
    stop = false;
    EXPECT_EQ(make_embree_surfaces(square(300))->hit_distance(k_ray), 1);
}

TEST(EmbreeScene, IsTracedOnceWhatCouldHaveStoppedItIsGone) {
    std::unique_ptr<Surfaces> surfaces;
    {
        const auto stop = std::make_unique<std::atomic<bool>>(false);
        const StopScope scope(*stop);
        surfaces = make_embree_surfaces(square(30));
    }
    EXPECT_EQ(surfaces->hit_distance(k_ray), 1);
}

}  // namespace
}  // namespace uw
