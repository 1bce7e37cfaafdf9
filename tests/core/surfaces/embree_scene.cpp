// ctest labels: unit
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/surfaces/embree_surfaces.h"

namespace uw {
namespace {

/// A flat square of 2 n^2 triangles at z = 1, as traced.
SceneObjects square(std::uint32_t n) {
    auto object = std::make_shared<MeshObject>();
    for (std::uint32_t k = 0; k < (n + 1) * (n + 1); ++k)
        for (const double value : {double(k % (n + 1)) / n, double(k / (n + 1)) / n, 1.0})
            object->mesh.positions.push_back(static_cast<float>(value));
    for (std::uint32_t k = 0; k < n * n; ++k) {
        const std::uint32_t a = k / n * (n + 1) + k % n;
        for (const std::uint32_t corner : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1})
            object->mesh.triangles.push_back(corner);
    }
    object->vertex_count = object->mesh.positions.size() / 3;
    object->mesh.positions.resize(object->mesh.positions.size() + 4);
    SceneObjects objects{{object}, {}, {}, {}, {}, {}, ReflectanceBands({620, 540, 450}), {}};
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
