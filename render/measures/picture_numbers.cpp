#include "render/measures/picture_numbers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace uw {

std::vector<PicturePlane> layer_planes(const Film& film, const LayerPlan& plan,
                                       std::initializer_list<Layer> layers, double gain) {
    const std::size_t bands = plan.band_count();
    std::vector<PicturePlane> planes;
    for (const Layer layer : layers)
        if (plan.has(layer))
            planes.push_back(
                {film.values().subspan(static_cast<std::size_t>(plan.first_channel(layer))),
                 film.channel_names().size(),
                 per_band(bands, [gain](std::size_t) { return gain; })});
    return planes;
}

double mean_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double mean_between(std::span<double> values, double low, double high) {
    const auto count = static_cast<double>(values.size());
    const auto begin = static_cast<std::ptrdiff_t>(std::ceil(low * count));
    const auto end = static_cast<std::ptrdiff_t>(std::floor(high * count));
    if (begin >= end) {
        const auto middle = std::min(static_cast<std::ptrdiff_t>(0.5 * (low + high) * count),
                                     static_cast<std::ptrdiff_t>(values.size()) - 1);
        std::nth_element(values.begin(), values.begin() + middle, values.end());
        return values[static_cast<std::size_t>(middle)];
    }
    std::nth_element(values.begin(), values.begin() + begin, values.end());
    std::nth_element(values.begin() + begin, values.begin() + end, values.end());
    return mean_of({values.begin() + begin, values.begin() + end});
}

double percentile(std::span<double> values, double fraction) {
    const double place = fraction * static_cast<double>(values.size() - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), below, values.end());
    const double low = *below;
    if (below + 1 == values.end()) return low;
    return std::lerp(low, *std::min_element(below + 1, values.end()), place - std::floor(place));
}

namespace {

double ratio_of(double signal, double backscatter) {
    if (backscatter > 0) return signal / backscatter;
    return signal > 0 ? std::numeric_limits<double>::infinity() : 0;
}

double contrast_of(std::span<double> values) {
    const double dark = mean_between(values, 0.05, 0.25), bright = mean_between(values, 0.75, 0.95);
    return bright + dark > 0 ? (bright - dark) / (bright + dark) : 0;
}

/// Returns the side of tiles in which lighting is taken to be even [pixels].
std::size_t tile_side(const PictureLayers& picture) {
    constexpr int k_min = 8, k_tiles = 16;  // pixels, along the shorter side
    return static_cast<std::size_t>(
        std::max(k_min, std::min(picture.width, picture.height) / k_tiles));
}

/// A pixel that sees a surface: its index in a list of values, its tile of the picture, and its
/// albedo.
struct SurfacePixel {
    std::size_t place, tile;
    double albedo;
    bool is_edge;  // whether it lies at a step of the albedo, whose light mixes both sides
};

/// Whether the albedo of a pixel differs from that of a neighbour.
bool is_at_edge(const GreyLayers& albedo, std::size_t pixel, std::size_t width,
                std::size_t height) {
    constexpr double k_step = 0.2;
    const std::size_t x = pixel % width, y = pixel / width;
    const double own = albedo.at(pixel);
    const auto differs = [&](std::size_t neighbour) {
        const double other = albedo.at(neighbour);
        return std::abs(own - other) > k_step * std::max(own, other);
    };
    return (x > 0 && differs(pixel - 1)) || (x + 1 < width && differs(pixel + 1)) ||
           (y > 0 && differs(pixel - width)) || (y + 1 < height && differs(pixel + width));
}

/// The tiles in which surfaces are patterned, and the pixels in them that are bright and dark by
/// their albedo.
class AlbedoPattern {
  public:
    /// Leaves out pixels at edges, unless there are no others to compare.
    explicit AlbedoPattern(std::vector<SurfacePixel> pixels) {
        std::ranges::stable_sort(pixels, {}, &SurfacePixel::tile);
        std::vector<SurfacePixel> within;
        std::ranges::copy_if(pixels, std::back_inserter(within),
                             [](const SurfacePixel& pixel) { return !pixel.is_edge; });
        add_tiles(within);
        if (tiles_.empty()) add_tiles(pixels);
    }

    bool empty() const { return tiles_.empty(); }
    /// Returns the mean of the tiles' contrasts, weighted by their numbers of pixels.
    double contrast_of(std::span<const double> values) const {
        double sum = 0, count = 0;
        for (const Tile& tile : tiles_) {
            const double bright = mean(values, tile.bright), dark = mean(values, tile.dark);
            const auto pixels = static_cast<double>(tile.bright.size() + tile.dark.size());
            if (bright + dark > 0) sum += pixels * (bright - dark) / (bright + dark);
            count += pixels;
        }
        return sum / count;
    }

  private:
    struct Tile {
        std::vector<std::size_t> bright, dark;  // places
    };

    void add_tiles(const std::vector<SurfacePixel>& pixels) {
        for (auto begin = pixels.begin(); begin != pixels.end();) {
            const auto end = std::find_if(begin, pixels.end(), [&](const SurfacePixel& pixel) {
                return pixel.tile != begin->tile;
            });
            add({begin, end});
            begin = end;
        }
    }

    void add(std::span<const SurfacePixel> pixels) {
        constexpr double k_min_contrast = 0.02;  // minimum of a visible pattern
        std::vector<double> albedos;
        albedos.reserve(pixels.size());
        for (const SurfacePixel& pixel : pixels) albedos.push_back(pixel.albedo);
        const double low = percentile(albedos, 0.25), high = percentile(albedos, 0.75);
        if (!(high - low > k_min_contrast * (high + low))) return;
        Tile& tile = tiles_.emplace_back();
        for (const SurfacePixel& pixel : pixels) {
            if (pixel.albedo >= high) tile.bright.push_back(pixel.place);
            if (pixel.albedo <= low) tile.dark.push_back(pixel.place);
        }
    }

    static double mean(std::span<const double> values, const std::vector<std::size_t>& places) {
        double sum = 0;
        for (const std::size_t place : places) sum += values[place];
        return sum / static_cast<double>(places.size());
    }

    std::vector<Tile> tiles_;
};

/// Computes the evenness of the irradiance at pixels that see a surface.
Evenness evenness_of(std::vector<double> irradiance) {
    Evenness even;
    even.pixels = irradiance.size();
    if (irradiance.empty()) return even;
    even.mean = mean_of(irradiance);
    even.least = *std::ranges::min_element(irradiance);
    even.greatest = *std::ranges::max_element(irradiance);
    even.percentile5 = percentile(irradiance, 0.05);
    even.median = percentile(irradiance, 0.5);
    even.percentile95 = percentile(irradiance, 0.95);
    if (even.mean > 0) {
        even.min_to_mean = even.least / even.mean;
        even.percentile5_to_mean = even.percentile5 / even.mean;
    }
    return even;
}

}  // namespace

PictureLayers picture_layers(const Film& film, const LayerPlan& plan) {
    PictureLayers picture{
        film.window().width(), film.window().height(), plan.band_count(), {}, {}, {}, {}, {}};
    picture.signal =
        layer_planes(film, plan, {Layer::direct, Layer::forward, Layer::multiple_surface});
    picture.backscatter =
        layer_planes(film, plan, {Layer::backscatter, Layer::multiple_volume, Layer::snow});
    picture.clean = layer_planes(film, plan, {Layer::clean});
    picture.irradiance = layer_planes(film, plan, {Layer::irradiance});
    picture.albedo = layer_planes(film, plan, {Layer::albedo});
    return picture;
}

std::vector<std::size_t> pixels_within(const PixelWindow& part, int width) {
    std::vector<std::size_t> pixels;
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x)
            pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
    return pixels;
}

PictureNumbers measure_picture(const PictureLayers& picture, const PixelWindow& part,
                               double ratio) {
    return measure_picture(picture, pixels_within(part, picture.width), ratio);
}

PictureNumbers measure_picture(const PictureLayers& picture, std::span<const std::size_t> pixels,
                               double ratio) {
    const GreyLayers signal(picture.signal, picture.bands);
    const GreyLayers backscatter(picture.backscatter, picture.bands);
    const GreyLayers clean(picture.clean, picture.bands);
    const GreyLayers irradiance(picture.irradiance, picture.bands);
    const GreyLayers albedo(picture.albedo, picture.bands);
    std::vector<double> totals, signals, scattered, cleans, lit;
    std::vector<SurfacePixel> surfaces;
    const auto width = static_cast<std::size_t>(picture.width);
    const std::size_t side = tile_side(picture);
    std::size_t above = 0;
    for (const std::size_t pixel : pixels) {
        signals.push_back(signal.at(pixel));
        scattered.push_back(backscatter.at(pixel));
        totals.push_back(signals.back() + scattered.back());
        above += signals.back() > 0 && signals.back() >= ratio * scattered.back() ? 1U : 0U;
        cleans.push_back(clean.at(pixel));
        const double light = irradiance.at(pixel);
        if (!(light > 0 || albedo.at(pixel) > 0)) continue;
        lit.push_back(light);
        surfaces.push_back(
            {signals.size() - 1, pixel / width / side * width + pixel % width / side,
             albedo.at(pixel),
             !albedo.empty() &&
                 is_at_edge(albedo, pixel, width, static_cast<std::size_t>(picture.height))});
    }
    PictureNumbers numbers;
    numbers.signal = mean_of(signals);
    numbers.backscatter = mean_of(scattered);
    numbers.signal_to_backscatter = ratio_of(numbers.signal, numbers.backscatter);
    numbers.fraction_above = static_cast<double>(above) / static_cast<double>(totals.size());
    const AlbedoPattern pattern(std::move(surfaces));
    const auto contrast = [&](std::vector<double>& light) {
        return pattern.empty() ? contrast_of(light) : pattern.contrast_of(light);
    };
    numbers.contrast = contrast(totals);
    if (!clean.empty()) {
        const double without_water = mean_of(cleans);
        if (without_water > 0) numbers.lost_to_water = 1 - numbers.signal / without_water;
        numbers.clean_contrast = contrast(cleans);
    }
    if (!irradiance.empty()) numbers.evenness = evenness_of(std::move(lit));
    return numbers;
}

std::optional<PixelWindow> patterned_part(const PictureLayers& picture, int side) {
    const GreyLayers albedo(picture.albedo, picture.bands);
    const int width = picture.width, height = picture.height;
    if (albedo.empty() || side < 2 || side > std::min(width, height)) return std::nullopt;
    // Sums of the values and of their squares over all pixels above and to the left.
    const auto columns = static_cast<std::size_t>(width) + 1;
    std::vector<double> sums(columns * (static_cast<std::size_t>(height) + 1)), squares = sums;
    const auto at = [columns](int x, int y) {
        return static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double value = albedo.at(static_cast<std::size_t>(y) * (columns - 1) +
                                           static_cast<std::size_t>(x));
            for (auto [table, term] : {std::pair{&sums, value}, std::pair{&squares, value * value}})
                (*table)[at(x + 1, y + 1)] =
                    term + (*table)[at(x, y + 1)] + (*table)[at(x + 1, y)] - (*table)[at(x, y)];
        }
    const auto sum_within = [&](const std::vector<double>& table, int x, int y) {
        return table[at(x + side, y + side)] - table[at(x, y + side)] - table[at(x + side, y)] +
               table[at(x, y)];
    };
    // For equal surfaces, the deviation is 0 except for rounding, which is far below this; that of
    // a visible pattern is greater.
    constexpr double k_min_deviation = 0.01;
    double most = k_min_deviation * k_min_deviation;
    std::optional<PixelWindow> best;
    const double count = static_cast<double>(side) * side;
    for (int y = 0; y + side <= height; ++y)
        for (int x = 0; x + side <= width; ++x) {
            const double mean = sum_within(sums, x, y) / count;
            const double variance = sum_within(squares, x, y) / count - mean * mean;
            if (variance <= most) continue;
            most = variance;
            best = PixelWindow{x, y, x + side, y + side};
        }
    return best;
}

namespace {

std::vector<PicturePlane> planes_of(const MeasuredImage& image,
                                    std::initializer_list<Layer> layers) {
    std::vector<PicturePlane> planes = layer_planes(image.film, image.plan, layers);
    if (image.emitted == nullptr) return planes;
    for (PicturePlane& plane : layer_planes(*image.emitted, image.plan, layers, -1))
        planes.push_back(plane);
    return planes;
}

Distribution distribution_of(const MeasuredImage& image, std::initializer_list<Layer> layers,
                             std::span<const std::size_t> pixels) {
    const std::vector<PicturePlane> planes = planes_of(image, layers);
    const GreyLayers light(planes, image.plan.band_count());
    std::vector<double> values;
    values.reserve(pixels.size());
    for (const std::size_t pixel : pixels) values.push_back(light.at(pixel));
    return {mean_of(values), percentile(values, 0.05), percentile(values, 0.5),
            percentile(values, 0.95)};
}

}  // namespace

std::string layers_to_measure(const ImageScene& scene) {
    std::string layers = k_picture_layers;
    const LayerPlan plan = layer_plan(scene, {});
    if (plan.is_provided(Layer::multiple)) layers += ",multiple.volume,multiple.surface";
    if (plan.is_provided(Layer::snow)) layers += ",snow";
    return layers;
}

LightNumbers light_numbers(const MeasuredImage& image, std::span<const std::size_t> pixels) {
    LightNumbers numbers;
    numbers.pixels = pixels.size();
    numbers.direct = distribution_of(image, {Layer::direct}, pixels);
    numbers.forward = distribution_of(image, {Layer::forward}, pixels);
    numbers.backscatter = distribution_of(image, {Layer::backscatter}, pixels);
    if (image.plan.has(Layer::multiple_volume))
        numbers.multiple =
            distribution_of(image, {Layer::multiple_volume, Layer::multiple_surface}, pixels);
    PictureLayers picture = picture_layers(image.film, image.plan);
    picture.signal = planes_of(image, {Layer::direct, Layer::forward, Layer::multiple_surface});
    picture.backscatter =
        planes_of(image, {Layer::backscatter, Layer::multiple_volume, Layer::snow});
    picture.clean = planes_of(image, {Layer::clean});
    numbers.picture = measure_picture(picture, pixels);
    return numbers;
}

std::vector<PartNumbers> part_numbers(const MeasuredImage& image,
                                      const std::vector<PicturePart>& parts,
                                      const std::string& lamp) {
    std::vector<PartNumbers> numbers;
    for (const PicturePart& part : parts)
        numbers.push_back({part.name, lamp, light_numbers(image, part.pixels)});
    return numbers;
}

std::vector<PartNumbers> lamp_numbers(Renderer& renderer, const ImageScene& scene,
                                      const RenderOptions& options,
                                      const std::vector<PicturePart>& parts,
                                      const std::function<void(std::size_t image)>& begin) {
    RenderOptions measured = options;
    measured.layers = layers_to_measure(scene);
    const auto render = [&](std::vector<LampDesc> lamps, std::size_t image) {
        if (begin) begin(image);
        renderer.set_scene(scene.with([&](SceneDesc& desc) { desc.lamps = std::move(lamps); }));
        renderer.render(measured);
        return renderer.release_film();
    };
    const Film emitted = render({}, 0);
    std::vector<PartNumbers> numbers;
    std::size_t image = 0;
    for (const LampDesc& lamp : scene.desc().lamps) {
        const Film film = render({lamp}, ++image);
        const LayerPlan plan = layer_plan(renderer.scene(), measured.layers, measured.paths);
        for (PartNumbers& of_part : part_numbers({film, plan, &emitted}, parts, lamp.name))
            numbers.push_back(std::move(of_part));
    }
    return numbers;
}

}  // namespace uw
