// ctest labels: metamorphic
// Forward scatter does not depend on how its work is divided: by layers of single lamps, and into
// groups of slabs that fit into memory.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/forward/forward_scenes.h"
#include "tests/support/meshes/textured_gltf.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

// A wall that emits and reflects light.
SceneDesc emissive_wall(const MeshFolder& folder) {
    TexturedGltf gltf;
    gltf.material = R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.6,0.7,1]},
        "emissiveFactor":[0.9,0.6,0.3]})";
    GeometryDesc wall;
    wall.file = folder.write("wall.gltf", gltf.text());
    wall.world_from_object = Affine::translation({-0.8, -5, 2}) * Affine::scale({10, 10, 1});
    SceneDesc desc = scattering(staged(), forward(1));
    desc.geometry.push_back(wall);
    return desc;
}

constexpr Layer k_blurred[] = {Layer::direct, Layer::forward, Layer::backscatter};

/// These layers without those of single lamps.
class PlainFilm {
  public:
    explicit PlainFilm(const SceneDesc& desc)
        : plan_(layer_plan(SceneDesc(desc), k_names)), film_(rendered(desc)) {
        EXPECT_FALSE(plan_.has_lamps());
    }
    int width() const { return film_.width(); }
    int height() const { return film_.height(); }
    double value(Layer layer, int x, int y, int band) const {
        const int channel = plan_.first_channel(layer) + band;
        return static_cast<double>(film_.pixel(x, y)[static_cast<std::size_t>(channel)]);
    }
    double brightest(Layer layer) const {
        double most = 0;
        for (int y = 0; y < film_.height(); ++y)
            for (int x = 0; x < film_.width(); ++x)
                for (int band = 0; band < 3; ++band)
                    most = std::max(most, value(layer, x, y, band));
        return most;
    }

  private:
    static constexpr const char* k_names = "direct,forward,backscatter";

    static Film rendered(const SceneDesc& desc) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc));
        return renderer.render({.layers = k_names});
    }

    LayerPlan plan_;
    Film film_;
};

/// What is blurred is off by the rounding of floats in its transforms, of the brightest pixel.
template <class A>
void expect_same(const A& a, const PlainFilm& b, double tolerance) {
    for (const Layer layer : k_blurred) {
        const double allowed = tolerance * b.brightest(layer);
        EXPECT_GT(allowed, 0);
        for (int y = 0; y < b.height(); ++y)
            for (int x = 0; x < b.width(); ++x)
                for (int band = 0; band < 3; ++band)
                    EXPECT_NEAR(a.value(layer, x, y, band), b.value(layer, x, y, band), allowed)
                        << static_cast<int>(layer) << ": " << x << ' ' << y << ' ' << band;
    }
}

TEST(ForwardScatter, IsTheSameWithoutTheLayersOfLamps) {
    const MeshFolder folder;
    const SceneDesc desc = emissive_wall(folder);
    expect_same(RenderedFilm(desc), PlainFilm(desc), 5e-5);
}

// Slabs are integrated as many at a time as 256 MB hold: with 400 constituents, of 64 x 48 pixels,
// 25 of some 40. The same water as one constituent takes a hundredth of that. Most pixels look past
// the port, and cost only memory.
TEST(ForwardScatter, IsTheSameHoweverManySlabsFitIntoMemory) {
    constexpr int k_parts = 400;
    const TempDir dir;
    VdbFixture grid;
    grid.boxes = {{{0, 0, 2}, {0, 0, 2}, 1.0}};  // a voxel of a metre, in a corner
    write_fixture(dir / "ones.vdb", {grid});
    const auto scene = [&](int parts) {
        SceneDesc desc = scattering(staged(), forward(1));
        desc.camera.width = 64;
        desc.camera.height = 48;
        desc.camera.intrinsics = {4, 4, 32, 24};
        desc.camera.distortion.model = DistortionDesc::Model::fisheye;
        desc.camera.port = FlatPortDesc{};
        desc.lamps.resize(1);
        VolumeDesc volume;
        volume.file = dir / "ones.vdb";
        volume.where = "test";
        for (int part = 0; part < parts; ++part) {
            // Different ones, or they would be one constituent: their sum is that of equal ones.
            const double fraction = (1 + 0.5 * (part - 0.5 * (parts - 1)) / parts) / parts;
            GridMappingDesc mapping;
            mapping.grid = "density";
            mapping.optics.emplace();
            mapping.optics->absorption = {0.05 * fraction, 0.04 * fraction, 0.03 * fraction};
            mapping.optics->scattering = {0.10 * fraction, 0.12 * fraction, 0.14 * fraction};
            mapping.where = "test";
            volume.grids.push_back(mapping);
        }
        desc.volumes = {volume};
        return desc;
    };
    // Columns of each constituent are floats, too.
    expect_same(PlainFilm(scene(k_parts)), PlainFilm(scene(1)), 1e-5);
}

}  // namespace
}  // namespace uw::test
