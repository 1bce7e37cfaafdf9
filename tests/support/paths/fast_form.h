#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/image/layers.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/scene_folder.h"
#include "tests/support/vdb/vdb_fixtures.h"

/// The fast form of multiple scattering against light paths, in units of the errors of both.
namespace uw::test {

/// Writes "ones.vdb": a cube of ones from (0, 0, 0) to (1, 1, 1) m.
inline void write_ones(const SceneFolder& folder) {
    constexpr int k_voxels = 16;
    VdbFixture grid;
    grid.boxes = {{{0, 0, 0}, {k_voxels - 1, k_voxels - 1, k_voxels - 1}, 1.0}};
    grid.file_from_index =
        Affine::scale(Vector3(1.0 / k_voxels)) * Affine::translation(Vector3(0.5));
    write_fixture(folder.path() / "ones.vdb", {grid});
}

/// All light of an image that is scattered or reflected more than once, and the standard errors,
/// by pixel and band.
struct LightOfImage {
    int width = 0, height = 0;
    std::size_t bands = 0;
    std::vector<double> light, error;
    std::vector<double> total;  // with all that is scattered or reflected once, by band: the mean
    std::vector<double> all;    // with it, by pixel and band
    double stated = 0, stated_of_parts = 0, stated_of_worst_part = 0;
    std::vector<double> stated_of_bands;

    explicit LightOfImage(const SceneDesc& desc) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc));
        const RenderOptions options{.layers = "all"};
        const LayerPlan plan = layer_plan(renderer.scene(), options.layers, options.paths);
        const Film& film = renderer.render(options);
        width = film.width();
        height = film.height();
        bands = plan.band_count();
        total.assign(bands, 0.0);
        const double weight = 1.0 / (width * height);
        const auto value = [&](Layer layer, int x, int y, std::size_t band) {
            return static_cast<double>(
                film.pixel(x, y)[static_cast<std::size_t>(plan.first_channel(layer)) + band]);
        };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (std::size_t b = 0; b < bands; ++b) {
                    light.push_back(value(Layer::multiple, x, y, b));
                    error.push_back(value(Layer::error, x, y, b));
                    all.push_back(light.back() + value(Layer::direct, x, y, b) +
                                  value(Layer::backscatter, x, y, b));
                    total[b] += weight * all.back();
                }
            }
        }
        stated = renderer.report().multiple_error.value_or(0);
        stated_of_bands = renderer.report().multiple_error_of_bands;
        stated_of_parts = renderer.report().multiple_error_of_parts;
        stated_of_worst_part = renderer.report().multiple_error_of_worst_part;
    }

    std::size_t index(int x, int y, std::size_t band) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)) *
                   bands +
               band;
    }
};

/// Deviations of the fast form from light paths over blocks of pixels, in units of the standard
/// errors of both, by band: the square of each, the darkest block first.
struct FastFormDeviations {
    std::vector<std::vector<double>> squares;
    /// The difference of the images' means, relative to the mean of all light.
    std::vector<double> of_mean;

    /// Within a block the errors of the fast form are alike, and those of light paths independent.
    /// `unseen`: differences that count as errors of the fast form, too, relative to the mean of
    /// all light.
    FastFormDeviations(const LightOfImage& fast, const LightOfImage& paths, int block,
                       double unseen) {
        for (std::size_t b = 0; b < fast.bands; ++b) {
            std::vector<std::pair<double, double>> blocks;  // light, and square
            double difference = 0;
            for (int top = 0; top + block <= fast.height; top += block) {
                for (int left = 0; left + block <= fast.width; left += block) {
                    double light = 0, deviation = 0, of_fast = 0, of_paths = 0;
                    for (int y = top; y < top + block; ++y) {
                        for (int x = left; x < left + block; ++x) {
                            const std::size_t k = fast.index(x, y, b);
                            light += paths.light[k];
                            deviation += fast.light[k] - paths.light[k];
                            of_fast += fast.error[k];
                            of_paths += paths.error[k] * paths.error[k];
                        }
                    }
                    difference += deviation;
                    const double floor = unseen * paths.total[b] * block * block;
                    blocks.emplace_back(light, deviation * deviation /
                                                   (of_fast * of_fast + of_paths + floor * floor));
                }
            }
            std::ranges::sort(blocks);
            squares.emplace_back();
            for (const auto& [light, square] : blocks) squares.back().push_back(square);
            of_mean.push_back(difference / static_cast<double>(blocks.size()) / (block * block) /
                              paths.total[b]);
        }
    }

    /// The mean of a band's squares over the blocks from one fraction of them to another, by light.
    double mean_square(std::size_t band, double from = 0, double to = 1) const {
        const std::vector<double>& all = squares[band];
        const auto first = static_cast<std::size_t>(from * static_cast<double>(all.size()));
        const auto last = static_cast<std::size_t>(to * static_cast<double>(all.size()));
        return std::accumulate(all.begin() + static_cast<std::ptrdiff_t>(first),
                               all.begin() + static_cast<std::ptrdiff_t>(last), 0.0) /
               static_cast<double>(last - first);
    }
    double greatest(std::size_t band) const {
        return std::sqrt(*std::ranges::max_element(squares[band]));
    }
};

/// The same image upside down: other nodes, and random numbers of their own.
inline SceneDesc upside_down(SceneDesc desc) {
    desc.camera.world_from_camera =
        desc.camera.world_from_camera * Affine::scale(Vector3(-1, -1, 1));
    return desc;
}
inline LightOfImage upside_down(LightOfImage image) {
    const auto turn = [&](std::vector<double>& values) {
        std::vector<double> turned(values.size());
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (std::size_t b = 0; b < image.bands; ++b)
                    turned[image.index(image.width - 1 - x, image.height - 1 - y, b)] =
                        values[image.index(x, y, b)];
        values = std::move(turned);
    };
    turn(image.light);
    turn(image.error);
    return image;
}

}  // namespace uw::test
