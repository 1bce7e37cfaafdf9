#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/parallel.h"
#include "tests/support/image_of.h"

/// Laws that hold for every image, whatever it shows.
namespace uw::test {

/// One thread gives the bytes of all of them, and a window is that part of the whole. Returns the
/// whole image.
inline Film expect_same_for_threads_and_windows(const ImageScene& scene, RenderOptions options,
                                                const PixelWindow& window) {
    const Film whole = image_of(scene, options);
    {
        const ThreadLimit one(1);
        EXPECT_TRUE(std::ranges::equal(image_of(scene, options).values(), whole.values()));
    }
    options.window = window;
    EXPECT_TRUE(
        std::ranges::equal(image_of(scene, options).values(), cropped(whole, window).values()));
    return whole;
}
inline Film expect_same_for_threads_and_windows(const SceneDesc& desc, const RenderOptions& options,
                                                const PixelWindow& window) {
    return expect_same_for_threads_and_windows(ImageScene(SceneDesc(desc)), options, window);
}

/// The components that an image of three bands holds add up to its total to the bit, and those of
/// the lamps, each rounded, nearly so. Returns the number of values that are lit.
inline int expect_components_add_up(const Film& film) {
    const std::vector<std::string>& names = film.channel_names();
    int lit = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            for (std::size_t b = 0; b < 3; ++b) {
                const auto pixel = film.pixel(x, y);
                const std::string band = "." + std::string("RGB").substr(b, 1);
                const auto sum_of = [&](std::initializer_list<const char*> layers) {
                    float sum = 0;
                    for (const char* layer : layers) {
                        const auto found = std::ranges::find(names, layer + band);
                        if (found != names.end())
                            sum += pixel[static_cast<std::size_t>(found - names.begin())];
                    }
                    return sum;
                };
                const std::string where = std::to_string(x) + ", " + std::to_string(y) + band;
                EXPECT_EQ(pixel[b],
                          sum_of({"direct", "forward", "backscatter", "multiple", "snow"}))
                    << where;
                if (std::ranges::count(names, "multiple.volume" + band) > 0) {
                    EXPECT_EQ(sum_of({"multiple"}), sum_of({"multiple.volume", "multiple.surface"}))
                        << where;
                }
                float lamps = 0, all = 0;
                for (std::size_t c = 0; c < names.size(); ++c)
                    if (names[c].starts_with("lamp.") && names[c].ends_with(band)) {
                        lamps += pixel[c];
                        all = pixel[b];
                    }
                EXPECT_NEAR(lamps, all, 1e-5F * lamps) << where;
                lit += pixel[b] > 0 ? 1 : 0;
            }
    return lit;
}

}  // namespace uw::test
