// ctest labels: unit
#include "core/scene/waves_desc.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "tests/support/section_reader.h"

namespace uw::test {
namespace {

class WavesReader : public SectionReader<WavesDesc> {
  protected:
    WavesReader() : SectionReader("water.surface.waves", read_waves) {}
};

TEST_F(WavesReader, ReadsEachType) {
    const WavesDesc sines = read(
        "{type: sines, depth: 4, waves: [{amplitude: 0.1, wavelength: 3}, {amplitude: 0.02, "
        "wavelength: 1, direction: 30, phase: -90, steepness: 0.7}]}");
    const auto& list = std::get<std::vector<SineWaveDesc>>(sines.shape);
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0], (SineWaveDesc{0.1, 3, 0, 0, 0}));
    EXPECT_EQ(list[1], (SineWaveDesc{0.02, 1, 30, -90, 0.7}));
    EXPECT_EQ(sines.depth, 4);

    const auto sea = std::get<WaveSpectrumDesc>(
        read("{type: jonswap, wind: 8, wind_height: 19.5, fetch: 5000, gamma: 2, direction: 45, "
             "spreading: 4, tile: 60, resolution: 256, seed: 9}")
            .shape);
    EXPECT_EQ(sea, (WaveSpectrumDesc{WaveSpectrumDesc::Model::jonswap, 8, 19.5, 45, 5000, 2, 4, 60,
                                     256, 9}));
    const WavesDesc developed = read("{type: pierson-moskowitz, wind: 8, tile: 60}");
    const auto& spectrum = std::get<WaveSpectrumDesc>(developed.shape);
    EXPECT_EQ(spectrum.model, WaveSpectrumDesc::Model::pierson_moskowitz);
    EXPECT_EQ(spectrum.wind_height, 10);
    EXPECT_EQ(spectrum.resolution, 512);
    EXPECT_FALSE(developed.depth);

    const std::filesystem::path file = folder_.write("h.exr", "x");
    const auto image =
        std::get<HeightImageDesc>(read("{type: image, file: h.exr, width: 40}").shape);
    EXPECT_TRUE(std::filesystem::equivalent(image.file, file));
    EXPECT_EQ(image.width, 40);
}

TEST_F(WavesReader, RefusesWhatItDoesNotUse) {
    folder_.write("h.exr", "x");
    expect_refused("{wind: 8}", "type");
    expect_refused("{type: jonswop, wind: 8}", "jonswap");
    expect_refused("{type: sines}", "waves");
    expect_refused("{type: sines, waves: []}", "no entry");
    expect_refused("{type: sines, waves: [{amplitude: 0.1}]}", "wavelength");
    expect_refused("{type: sines, waves: [{amplitude: 0, wavelength: 1}]}", "amplitude");
    expect_refused("{type: sines, waves: [{amplitude: 0.1, wavelength: 1, height: 1}]}", "height");
    // 2 pi 0.2 / 1.3 = 0.967.
    expect_refused("{type: sines, waves: [{amplitude: 0.2, wavelength: 1.3, steepness: 1}]}",
                   "folds over itself");
    read("{type: sines, waves: [{amplitude: 0.2, wavelength: 1.3, steepness: 0.9}]}");
    expect_refused("{type: sines, waves: [{amplitude: 0.1, wavelength: 1}], wind: 3}",
                   "waves of type 'sines'");
    expect_refused("{type: jonswap, wind: 8, tile: 60}", "fetch");
    expect_refused("{type: jonswap, wind: 8, fetch: 100}", "tile");
    expect_refused("{type: pierson-moskowitz, wind: 8, tile: 60, fetch: 3}",
                   "waves of type 'pierson-moskowitz'");
    expect_refused("{type: pierson-moskowitz, wind: 8, tile: 60, resolution: 33}", "even");
    expect_refused("{type: pierson-moskowitz, wind: 80, tile: 60}", "wind");
    expect_refused("{type: pierson-moskowitz, wind: 8, tile: 60, spredding: 3}",
                   "did you mean 'spreading'");
    expect_refused("{type: image, file: h.exr}", "width");
    expect_refused("{type: image, file: none.exr, width: 3}", "none.exr");
    expect_refused("{type: image, file: h.exr, width: 3, depth: 3}", "waves of type 'image'");
}

TEST_F(WavesReader, RefusesMoreWavesThanRaysCanLookAt) {
    const auto sines = [](int count) {
        std::string text = "{type: sines, waves: [";
        for (int n = 0; n < count; ++n) text += "{amplitude: 0.001, wavelength: 3}, ";
        return text + "]}";
    };
    EXPECT_NO_THROW(read(sines(1000)));
    expect_refused(sines(1001), "waves: has 1001 waves, and must not have more than 1000");
}

}  // namespace
}  // namespace uw::test
