// ctest labels: unit metamorphic
#include "render/light_splatter.h"

#include <gtest/gtest.h>

#include <random>

#include "render/scene_cache.h"
#include "tests/support/field_maker.h"
#include "tests/support/suns.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// Two lamps in the world, a box that throws shadows, and a small grid.
class LightReuse : public testing::Test {
  protected:
    LightReuse() {
        desc_ = pinhole_scene(16, 12);
        desc_.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
        desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40), isotropic_lamp({0.6, 0.3, 0.1}, 30)};
        for (LampDesc& lamp : desc_.lamps) lamp.fixed_to_camera = false;
        desc_.volumes = {volume(1.0)};
        assemble();
    }

    VolumeDesc volume(double value) {
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = Affine::translation({0, 0, 2}) * Affine::scale(Vector3(0.05));
        fixture.value = [value](int i, int j, int k) { return value * bumpy(i, j, k); };
        VolumeDesc desc = maker_.volume(fixture);
        desc.grids[0].optics = GridMappingDesc::Optics{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {}};
        return desc;
    }

    /// Another scene, with what is the same taken over.
    void change(const std::function<void(SceneDesc&)>& edit) {
        edit(desc_);
        scene_.reset();
        assemble();
    }

    /// Splats and holds the light against light that nothing was taken over for: to the bit.
    void expect_splat(std::size_t shadow_maps, std::size_t column_maps,
                      const DeepShadowOptions& options = k_options) {
        const DeepShadows light = cache_.light(scene(), options);
        EXPECT_EQ(counts().shadow_maps, shadow_maps);
        EXPECT_EQ(counts().column_maps, column_maps);
        if (shadow_maps + column_maps == 0) {
            EXPECT_EQ(counts().rays, 0U);
        }
        const TestScene fresh(desc_, options);
        ASSERT_EQ(light.size(), fresh.light().size());
        const auto a = make_light_transport(scene(), light, false);
        const auto b = make_light_transport(fresh.assembled(), fresh.light(), false);
        const Camera& camera = *scene().camera;
        double brightest = 0;
        for (int y = 0; y < camera.height(); ++y) {
            for (int x = 0; x < camera.width(); ++x) {
                const auto ray = camera.refracted_ray(x + 0.5, y + 0.5);
                ASSERT_TRUE(ray);
                InScatter taken_over, splatted;
                const std::array<double, 2> ends{1.8, 3.5};
                a.integrator->in_scatter(*ray, ends, taken_over);
                b.integrator->in_scatter(*ray, ends, splatted);
                for (std::size_t end = 0; end < ends.size(); ++end)
                    for (std::size_t lamp = 0; lamp < light.size(); ++lamp) {
                        EXPECT_EQ(taken_over.at(end, lamp), splatted.at(end, lamp));
                        brightest = std::max(brightest, splatted.at(end, lamp)[1]);
                    }
            }
        }
        EXPECT_GT(brightest, 0);
    }

    const AssembledScene& scene() const { return *scene_; }
    const SplatCounts& counts() const { return cache_.splat_counts(); }

    static constexpr DeepShadowOptions k_options{64, 2, std::size_t{32} << 20};
    FieldMaker maker_;
    SceneDesc desc_;

  private:
    void assemble() {
        scene_ = assemble_scene(SceneDesc(desc_), cache_, [](Stage) {});
        scene_->slabs = place_slabs(*scene_);
    }

    SceneCache cache_;
    std::optional<AssembledScene> scene_;
};

TEST_F(LightReuse, WhatLeavesPositionsAsTheyAreNeedsNoSplat) {
    expect_splat(2, 2);
    expect_splat(0, 0);
    change([](SceneDesc& d) {
        d.camera.world_from_camera =
            Affine::translation({0.2, 0.1, -0.3}) * Affine::rotation_xyz_degrees({2, -5, 1});
    });
    expect_splat(0, 0);
    change([](SceneDesc& d) {
        d.lamps[0].intensity = PerBand{5, 20, 90};
        d.lamps[1].direction = {0, 1, 0};
        d.lamps[1].profile = SpotProfileDesc{120, 20};
    });
    expect_splat(0, 0);
    change([](SceneDesc& d) { d.water.absorption = PerBand{0.1, 0.2, 0.3}; });
    expect_splat(0, 0);
}

TEST_F(LightReuse, ALampThatTurnsOutOfItsShadowsNeedsOthers) {
    change([](SceneDesc& d) { d.lamps[1].profile = SpotProfileDesc{50, 10}; });
    expect_splat(2, 2);
    const std::uint64_t all = 6 * 66 * 66;
    EXPECT_LT(counts().rays, all + all / 2);  // the spot's are those of its beam
    change([](SceneDesc& d) { d.lamps[1].profile = SpotProfileDesc{30, 4}; });
    expect_splat(0, 0);
    change([&](SceneDesc& d) { d.lamps[1].direction = glm::normalize(Vector3(0.05, 0, 1)); });
    expect_splat(0, 0);
    change([&](SceneDesc& d) { d.lamps[1].direction = glm::normalize(Vector3(0.5, 0, 1)); });
    expect_splat(1, 0);
    change([](SceneDesc& d) { d.lamps[1].profile = SpotProfileDesc{60, 4}; });
    expect_splat(1, 0);
}

TEST_F(LightReuse, ASunNeedsASplatIfItTurnsOrItsSurfaceMoves) {
    change([](SceneDesc& d) {
        d.water.surface = k_sea_level;
        d.lamps[0] = slanting_sun();
    });
    expect_splat(2, 2);
    change([](SceneDesc& d) {
        d.camera.world_from_camera = Affine::translation({0.2, 0.1, -0.3});
        d.lamps[0].intensity = PerBand{5, 20, 90};
    });
    expect_splat(0, 0);
    change([](SceneDesc& d) { d.lamps[0].direction = glm::normalize(Vector3(0.4, 1, 0.3)); });
    expect_splat(1, 1);
    change([](SceneDesc& d) { d.lamps[0].sun->surface.point.y = -4; });
    expect_splat(1, 1);
    change([this](SceneDesc& d) { d.volumes = {volume(2.0)}; });
    expect_splat(0, 2);
    // A floor of 80 m has more than one square, which follow the camera.
    change([](SceneDesc& d) { d.geometry.push_back(box({-40, 3, -40}, {40, 3.1, 40})); });
    expect_splat(2, 0);
    change([](SceneDesc& d) {
        d.camera.world_from_camera = Affine::translation({0.2, 0.1, -0.31});
    });
    expect_splat(0, 0);
    change([](SceneDesc& d) { d.camera.world_from_camera = Affine::translation({0, 0, -8}); });
    expect_splat(1, 0);
}

TEST_F(LightReuse, OnlyTheLampThatMovedIsSplattedAgain) {
    expect_splat(2, 2);
    change([](SceneDesc& d) { d.lamps[1].position.y += 0.1; });
    expect_splat(1, 1);
    change([](SceneDesc& d) { std::swap(d.lamps[0], d.lamps[1]); });
    expect_splat(0, 0);
    // A lamp that is fixed to the camera moves with it.
    change([](SceneDesc& d) { d.lamps[0].fixed_to_camera = true; });
    expect_splat(0, 0);
    change([](SceneDesc& d) { d.camera.world_from_camera = Affine::translation({0, 0, -0.1}); });
    expect_splat(1, 1);
}

TEST_F(LightReuse, LampsInOnePlaceShareTheirMaps) {
    change([](SceneDesc& d) { d.lamps[1].position = d.lamps[0].position; });
    expect_splat(1, 1);
}

TEST_F(LightReuse, AnotherFieldNeedsColumnsAndOtherSurfacesNeedShadows) {
    expect_splat(2, 2);
    change([this](SceneDesc& d) { d.volumes = {volume(3.0)}; });
    expect_splat(0, 2);
    change([](SceneDesc& d) { d.volumes.clear(); });
    expect_splat(0, 2);
    change([](SceneDesc& d) { d.geometry[1].min.x -= 0.1; });
    expect_splat(2, 0);
}

TEST_F(LightReuse, OtherOptionsNeedTheirOwn) {
    expect_splat(2, 2);
    expect_splat(2, 0, {32, 2, k_options.column_budget});
    expect_splat(0, 2, {32, 2, k_options.column_budget / 64});
    expect_splat(0, 2, {32, 1, k_options.column_budget});
    expect_splat(0, 2, {32, 2, k_options.column_budget / 64});
    // The budget is shared out among the lamps.
    change([](SceneDesc& d) { d.lamps.pop_back(); });
    expect_splat(0, 1, {32, 2, k_options.column_budget / 64});
}

TEST_F(LightReuse, ScenesTakeOverWhatIsTheSame) {
    const auto field = scene().field;
    const auto surfaces = scene().surfaces;
    const std::vector<std::string> warnings = scene().warnings;
    change([](SceneDesc& d) { d.camera.world_from_camera = Affine::translation({0, 0, -0.1}); });
    EXPECT_EQ(scene().field, field);
    EXPECT_EQ(scene().surfaces, surfaces);
    EXPECT_EQ(scene().warnings, warnings);
    EXPECT_EQ(scene().volume_reports.size(), 1U);
    change([](SceneDesc& d) { d.geometry[0].reflectance = PerBand{0.1, 0.2, 0.3}; });
    EXPECT_EQ(scene().field, field);
    EXPECT_NE(scene().surfaces, surfaces);
    change([](SceneDesc& d) { d.volumes[0].world_from_upright = Affine::translation({0, 1, 0}); });
    EXPECT_NE(scene().field, field);
}

}  // namespace
}  // namespace uw::test
