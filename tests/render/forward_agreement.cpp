// ctest labels: metamorphic slow
// Forward scatter: integrators against each other, and equal waters.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/forward/forward_scenes.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

void expect_same_components(const RenderedFilm& a, const RenderedFilm& b, double tolerance) {
    for (const auto& [name, layer] : {std::pair{"direct", Layer::direct},
                                      {"forward", Layer::forward},
                                      {"backscatter", Layer::backscatter}}) {
        const double worst = worst_difference(a, b, layer);
        std::cout << name << ": largest difference " << worst << "\n";
        EXPECT_LE(worst, tolerance) << name;
    }
}

class ForwardAgreement : public ::testing::TestWithParam<Shape> {};

// The planes' 512 slabs against the volume's layers, which are some dozens.
TEST_P(ForwardAgreement, AgreesBetweenPlanesAndVolume) {
    for (SceneDesc desc : {uniform_scene({1, -0.5, 0}), uniform_scene({0.4, -0.3, -1.5}),
                           ported(uniform_scene({1, -0.5, 0}))}) {
        desc = scattering(desc, forward(1, GetParam()));
        desc.camera.width = 32;
        desc.camera.height = 24;
        desc.camera.intrinsics = {28, 28, 16, 12};
        const RenderedFilm volume(desc), planes(with_planes(desc, 512, 0, 5));
        expect_same_components(volume, planes, 3e-3);
    }
}

// Half of the water moved into a grid of ones, with the same phase function. G is relative to the
// uniform water's c, B to its b: they halve too.
TEST_P(ForwardAgreement, IsTheSameInAConstantGrid) {
    const TempDir dir;
    const SceneDesc whole = scattering(staged(), forward(1, GetParam()));
    SceneDesc half = whole;
    for (double& a : *half.water.absorption) a *= 0.5;
    for (double& b : half.water.scattering->b) b *= 0.5;
    half.water.forward_scatter.G *= 0.5;
    half.water.forward_scatter.B *= 0.5;
    VdbFixture ones;
    ones.boxes = {{{0, 0, 0}, {63, 63, 63}, 1.0}};
    ones.file_from_index = Affine::translation(Vector3(-8 + 0.125)) * Affine::scale(Vector3(0.25));
    const std::filesystem::path file = dir / "ones.vdb";
    write_fixture(file, {ones});
    VolumeDesc volume;
    volume.file = file;
    volume.where = "test";
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.optics =
        GridMappingDesc::Optics{*half.water.absorption, half.water.scattering->b, std::nullopt};
    mapping.where = "test";
    volume.grids = {mapping};
    half.volumes = {volume};
    expect_same_components(RenderedFilm(half), RenderedFilm(whole), 3e-3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ForwardAgreement,
                         ::testing::Values(Shape::gaussian, Shape::exponential),
                         [](const auto& test) {
                             return test.param == Shape::gaussian ? "gaussian" : "exponential";
                         });

TEST(ForwardScatter, OfTheReferenceIntegratorIsThatOfTheVolume) {
    SceneDesc desc = scattering(uniform_scene({1, -0.5, 0}), forward(1));
    const RenderedFilm volume(desc);
    desc.render.integrator = RenderDesc::Integrator::reference;
    expect_same_components(RenderedFilm(desc), volume, 3e-3);
}

// Between the nodes of a lattice, on coarse grids and in thick slabs: what every pixel's own ray
// through thin slabs gives on the pixels themselves, within 0.2 % of the mean (RMS) and 1 % at any
// pixel, beside a box and its shadows too.
TEST_P(ForwardAgreement, OfALatticeIsThatOfEveryPixel) {
    SceneDesc desc = scattering(staged(), forward(1, GetParam()));
    desc.camera.width = 120;
    desc.camera.height = 90;
    desc.camera.intrinsics = {450, 450, 60, 45};  // four pixels between nodes
    const RenderedFilm fast(desc);
    desc.render.quality = RenderDesc::Quality::exact;
    const RenderedFilm exact(desc);
    for (const Layer layer : {Layer::forward, Layer::backscatter, Layer::backscatter_first}) {
        for (int band = 0; band < 3; ++band) {
            const double mean = exact.sum(layer, band) / (120 * 90);
            double squares = 0, worst = 0;
            for (int y = 0; y < 90; ++y)
                for (int x = 0; x < 120; ++x) {
                    const double truth = exact.value(layer, x, y, band);
                    const double off = fast.value(layer, x, y, band) - truth;
                    squares += off * off / (120 * 90);
                    worst = std::max(worst, std::abs(off) / std::max(mean, truth));
                }
            std::cout << band << ": " << std::sqrt(squares) / mean << " RMS, " << worst << "\n";
            EXPECT_LT(std::sqrt(squares), 2e-3 * mean) << band;
            EXPECT_LT(worst, 1e-2) << band;
        }
    }
}

// Large images take few layers at a time, and their water from a distance on.
class InScatterFrom : public ::testing::TestWithParam<RenderDesc::Output> {};

TEST_P(InScatterFrom, IsTheDifferenceOfTwo) {
    using Integrators = RenderDesc::Integrator;
    for (const auto which : {Integrators::volume, Integrators::planes, Integrators::reference}) {
        SceneDesc desc = with_planes(uniform_scene({1, -0.5, 0}), 10, 0, 5);
        desc.render.integrator = which;
        desc.render.output = GetParam();
        desc.camera.lens = LensDesc{2.8, 0.4, 0.95};
        const TestScene scene(desc);
        const Ray ray{{0, 0, 0}, {0, 0, 1}};
        InScatter whole, rest;
        const std::vector<double> ends{0.5, 1, 1.5, 3.5};
        scene.integrator().in_scatter(ray, ends, whole);
        scene.integrator().in_scatter_from(ray, 0.5, std::span(ends).subspan(1), rest);
        for (std::size_t i = 1; i < ends.size(); ++i)
            for (std::size_t band = 0; band < 3; ++band) {
                const double truth = whole.at(i, 0)[band] - whole.at(0, 0)[band];
                // The volume integrator places its nodes anew.
                EXPECT_NEAR(rest.at(i - 1, 0)[band], truth, 1e-4 * truth);
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Outputs, InScatterFrom,
                         ::testing::Values(RenderDesc::Output::radiance, RenderDesc::Output::paper),
                         [](const auto& test) {
                             return test.param == RenderDesc::Output::paper ? "paper" : "radiance";
                         });

}  // namespace
}  // namespace uw::test
