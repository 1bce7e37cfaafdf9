// ctest labels: unit
#include "core/scene/sky_desc.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "tests/support/section_reader.h"

namespace uw::test {
namespace {

class SkyReader : public SectionReader<SkyDesc> {
  protected:
    SkyReader() : SectionReader("sky", read_sky) {}
};

TEST_F(SkyReader, ReadsEachModel) {
    const SkyDesc uniform = read("{model: uniform, irradiance: [1, 2, 3]}");
    EXPECT_EQ(uniform.model, SkyDesc::Model::uniform);
    EXPECT_EQ(uniform.irradiance, (PerBand{1, 2, 3}));
    EXPECT_EQ(uniform.samples, 32);
    EXPECT_EQ(read("{model: black}").model, SkyDesc::Model::black);
    const SkyDesc overcast =
        read("{model: overcast, lux: 9000, spectrum: {type: d65}, samples: 100}");
    EXPECT_EQ(overcast.model, SkyDesc::Model::overcast);
    EXPECT_EQ(overcast.lux, 9000);
    EXPECT_EQ(overcast.spectrum->type, LampSpectrumDesc::Type::d65);
    EXPECT_EQ(overcast.samples, 100);
    const SkyDesc clear =
        read("{model: clear, turbidity: 4, sun: {azimuth: 120, elevation: 40}, north: [2, 0, 0]}");
    EXPECT_EQ(clear.model, SkyDesc::Model::clear);
    EXPECT_EQ(clear.turbidity, 4);
    EXPECT_EQ(std::get<SunAnglesDesc>(*clear.sun), (SunAnglesDesc{120, 40}));
    EXPECT_EQ(*clear.north, Vector3(1, 0, 0));
    EXPECT_FALSE(clear.irradiance || clear.lux);
    const SkyDesc by_light = read("{model: clear, lux: 10, sun: {direction: [0, -2, 0]}}");
    EXPECT_EQ(std::get<SunDirectionDesc>(*by_light.sun).direction, Vector3(0, -1, 0));
    EXPECT_EQ(by_light.turbidity, 3);
    EXPECT_EQ(by_light.lux, 10);
    EXPECT_EQ(read("{model: uniform, irradiance: 4}").irradiance, (PerBand{4, 4, 4}));
    EXPECT_EQ(read("{model: uniform, irradiance: 4, spectrum: {type: d65}}").irradiance,
              (PerBand{4}));
}

TEST_F(SkyReader, ReadsTheSunsTimeAndPlace) {
    const auto time_of = [&](const std::string& text) {
        const SkyDesc sky =
            read("{model: clear, sun: {time: " + text + ", latitude: 54.3, longitude: -10.1}}");
        const auto sun = std::get<SunTimeDesc>(*sky.sun);
        EXPECT_EQ(sun.latitude, 54.3);
        EXPECT_EQ(sun.longitude, -10.1);
        return sun.unix_time;
    };
    // By `date -u -d ... +%s`.
    EXPECT_EQ(time_of("2024-06-21T12:30:00Z"), 1718973000);
    EXPECT_EQ(time_of("2024-06-21T14:30:00+02:00"), 1718973000);
    EXPECT_EQ(time_of("'2024-06-21 08:45-03:45'"), 1718973000);
    EXPECT_NEAR(time_of("2024-02-29T23:59:59.25Z"), 1709251199.25, 1e-6);
    EXPECT_EQ(time_of("1970-01-01T00:00Z"), 0);
    const auto refused = [&](const std::string& time) {
        expect_refused("{model: clear, sun: {time: '" + time + "', latitude: 1, longitude: 2}}",
                       "time");
    };
    for (const char* const time :
         {"2024-06-21T12:30:00", "2024-06-21", "2023-02-29T12:00Z", "2024-06-21T24:00Z",
          "2024-06-21T12:60Z", "2024-06-21T12:30:00Zulu", "21.6.2024 12:00Z", "noon",
          "1899-12-31T12:00Z", "2101-01-01T00:00Z", "2024-06-21T12:30:00+2"})
        refused(time);
    time_of("2100-12-31T23:59Z");
    expect_refused("{model: clear, sun: {time: 2024-06-21T12:30Z, latitude: 1}}", "longitude");
    expect_refused("{model: clear, sun: {time: 2024-06-21T12:30Z, latitude: 91, longitude: 0}}",
                   "latitude");
    expect_refused("{model: clear, sun: {latitude: 1, longitude: 0, elevation: 3, azimuth: 3}}",
                   "a sun with 'elevation'");
}

TEST_F(SkyReader, ReadsPanoramas) {
    const std::filesystem::path file = folder_.write("sky.hdr", "x");
    const SkyDesc sky =
        read("{model: panorama, file: sky.hdr, rotate: -30, north: [1, 0, 0], samples: 64}");
    EXPECT_EQ(sky.model, SkyDesc::Model::panorama);
    EXPECT_TRUE(std::filesystem::equivalent(sky.file, file));
    EXPECT_EQ(sky.rotate, -30);
    EXPECT_EQ(*sky.north, Vector3(1, 0, 0));
    EXPECT_FALSE(sky.irradiance);
    EXPECT_EQ(read("{model: panorama, file: sky.hdr, irradiance: 2}").irradiance,
              (PerBand{2, 2, 2}));
    expect_refused("{model: panorama}", "file");
    expect_refused("{model: panorama, file: none.hdr}", "none.hdr");
    expect_refused("{model: panorama, file: sky.hdr, lux: 4}", "spectrum");
    expect_refused("{model: panorama, file: sky.hdr, turbidity: 4}", "sky model 'panorama'");
    expect_refused("{model: uniform, irradiance: 1, file: sky.hdr}", "sky model 'uniform'");
}

TEST_F(SkyReader, RefusesWhatItDoesNotUse) {
    expect_refused("{irradiance: 1}", "model");
    expect_refused("{model: cloudy, irradiance: 1}", "overcast");
    expect_refused("{model: uniform}", "how bright");
    expect_refused("{model: uniform, lux: 4}", "spectrum");
    expect_refused("{model: uniform, lux: 4, irradiance: 1, spectrum: {type: d65}}", "remove one");
    expect_refused("{model: uniform, irradiance: [1, 2]}", "irradiance");
    expect_refused("{model: uniform, irradiance: -1}", "irradiance");
    expect_refused("{model: uniform, irradiance: 1, turbidity: 3}", "sky model 'uniform'");
    expect_refused("{model: uniform, irradiance: 1, sun: {azimuth: 1, elevation: 2}}",
                   "sky model 'uniform'");
    expect_refused("{model: uniform, irradiance: 1, samples: 2000}", "samples");
    expect_refused("{model: black, irradiance: 1}", "sky model 'black'");
    expect_refused("{model: clear}", "where the sun stands");
    expect_refused("{model: clear, sun: {azimuth: 1}}", "elevation");
    expect_refused("{model: clear, sun: {azimuth: 1, elevation: 91}}", "elevation");
    expect_refused("{model: clear, sun: {azimuth: 1, direction: [0, -1, 0]}}", "'direction'");
    expect_refused("{model: clear, sun: {azimuth: 1, elevation: 40}, turbidity: 1}", "turbidity");
    expect_refused("{model: clear, sun: {azimuth: 1, elevation: 40}, spectrum: {type: d65}}",
                   "spectrum of its own");
    expect_refused("{model: clear, sun: {azimuth: 1, elevation: 40}, turbidty: 3}",
                   "did you mean 'turbidity'");
    EXPECT_TRUE(warnings_.empty());
    read("{model: uniform, irradiance: 0}");
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("dark"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
