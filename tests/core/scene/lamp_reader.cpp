// ctest labels: unit
#include "core/scene/lamp_desc.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/section_reader.h"

namespace uw {
namespace {

class LampReader : public test::SectionReader<std::vector<LampDesc>> {
  protected:
    LampReader() : SectionReader("lamps", read_lamps) {}

    /// The profile of a lamp that is whole but for it.
    template <class Desc>
    Desc profile(const std::string& text) const {
        const std::string lamp = "[{position: [0, 0, 0], intensity: 1, profile: " + text + "}]";
        return std::get<Desc>(read(lamp).at(0).profile);
    }
};

TEST_F(LampReader, ReadsEachProfile) {
    profile<IsotropicProfileDesc>("{type: isotropic}");
    const auto spot = profile<SpotProfileDesc>("{type: spot, beam: 60, edge: 5, falloff: gltf}");
    EXPECT_EQ(spot.beam, 60);
    EXPECT_EQ(spot.edge, 5);
    EXPECT_EQ(spot.falloff, SpotProfileDesc::Falloff::gltf);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60, falloff: blender}").falloff,
              SpotProfileDesc::Falloff::blender);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60, falloff: blender-3.4}").falloff,
              SpotProfileDesc::Falloff::blender_3_4);
    EXPECT_THROW(profile<SpotProfileDesc>("{type: spot, beam: 150, edge: 31, falloff: blender}"),
                 InputError);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60}").falloff,
              SpotProfileDesc::Falloff::smooth);
    EXPECT_EQ(profile<CosineProfileDesc>("{type: cosine, fwhm: 70}").fwhm, 70);
    const auto table =
        profile<TableProfileDesc>("{type: table, angles: [0, 20, 60], values: [1, 0.5, 0]}");
    EXPECT_EQ(table.angles, (std::vector<double>{0, 20, 60}));
    EXPECT_EQ(table.values, (std::vector<double>{1, 0.5, 0}));
    for (const char* const wrong :
         {"angles: [0], values: [1]", "angles: [5, 20], values: [1, 0]",
          "angles: [0, 20, 20], values: [1, 0.5, 0]", "angles: [0, 181], values: [1, 0]",
          "angles: [0, 20], values: [1]", "angles: [0, 20], values: [2, 1]",
          "angles: [0, 20], values: [0, 0]", "angles: [0, 20]"})
        EXPECT_THROW(profile<TableProfileDesc>(std::string("{type: table, ") + wrong + "}"),
                     InputError)
            << wrong;
    const std::filesystem::path file = folder_.write("lamp.ies", "x");
    const auto ies = profile<IesProfileDesc>("{type: ies, file: lamp.ies, rotate: 30, tilt: -20}");
    EXPECT_EQ(ies.file, file);
    EXPECT_EQ(ies.rotate, 30);
    EXPECT_EQ(ies.tilt, -20);
    EXPECT_NE(ies.where.find("lamps[0].profile"), std::string::npos) << ies.where;
    EXPECT_TRUE(std::holds_alternative<IsotropicProfileDesc>(
        read("[{position: [0, 0, 0], intensity: 1}]").at(0).profile));
}

TEST_F(LampReader, ReadsPatterns) {
    const auto line = profile<LineProfileDesc>("{type: line, angle: 60, width: 0.2, rotate: -15}");
    EXPECT_EQ(line.angle, 60);
    EXPECT_EQ(line.width, 0.2);
    EXPECT_EQ(line.rotate, -15);
    for (const char* const wrong :
         {"angle: 60", "width: 1", "angle: 171, width: 1", "angle: 60, width: 21",
          "angle: 60, width: 0", "angle: 60, width: 1, rotate: 400", "angle: 60, width: 1, fov: 3"})
        EXPECT_THROW(profile<LineProfileDesc>(std::string("{type: line, ") + wrong + "}"),
                     InputError)
            << wrong;
    const std::filesystem::path file = folder_.write("pattern.png", "x");
    const auto image = profile<ImageProfileDesc>("{type: image, file: pattern.png, fov: 40}");
    EXPECT_EQ(image.file, file);
    EXPECT_EQ(image.fov, 40);
    EXPECT_EQ(image.rotate, 0);
    EXPECT_NE(image.where.find("lamps[0].profile"), std::string::npos) << image.where;
    for (const char* const wrong : {"fov: 40", "file: pattern.png", "file: none.png, fov: 40",
                                    "file: pattern.png, fov: 180", "file: pattern.png, fov: 0"})
        EXPECT_THROW(profile<ImageProfileDesc>(std::string("{type: image, ") + wrong + "}"),
                     InputError)
            << wrong;
}

TEST_F(LampReader, ReadsExtents) {
    EXPECT_FALSE(read("[{position: [0, 0, 0], intensity: 1, type: point}]").at(0).extent);
    const LampDesc panel = read(
                               "[{type: rectangle, width: 0.4, height: 0.2, rotate: 30, samples: "
                               "16, position: [0, 0, 0], power: 1}]")
                               .at(0);
    EXPECT_EQ(panel.extent,
              (LampExtentDesc{LampExtentDesc::Shape::rectangle, 0.4, 0.2, 30, 0, 16}));
    EXPECT_EQ(std::get<CosineProfileDesc>(panel.profile).fwhm, 120);  // diffuse
    const LampDesc disk = read(
                              "[{type: disk, radius: 0.3, position: [0, 0, 0], power: 1, profile: "
                              "{type: isotropic}}]")
                              .at(0);
    EXPECT_EQ(disk.extent, (LampExtentDesc{LampExtentDesc::Shape::disk, 0, 0, 0, 0.3, 32}));
    EXPECT_TRUE(std::holds_alternative<IsotropicProfileDesc>(disk.profile));
    const LampDesc bulb =
        read("[{type: sphere, radius: 0.1, samples: 8, position: [0, 0, 0], power: 1}]").at(0);
    EXPECT_EQ(bulb.extent, (LampExtentDesc{LampExtentDesc::Shape::sphere, 0, 0, 0, 0.1, 8}));
    EXPECT_TRUE(std::holds_alternative<IsotropicProfileDesc>(bulb.profile));
}

TEST_F(LampReader, RefusesWhatAnExtentCannotBe) {
    for (const auto& [keys, part] :
         {std::pair{"type: rectangle, width: 1", "'height' is missing"},
          {"type: rectangle, width: 0, height: 1", "width: must be greater than 0"},
          {"type: disk", "'radius' is missing"},
          {"type: disk, radius: 1, width: 2", "width"},
          {"type: sphere, width: 1", "'radius' is missing"},
          {"type: sphere, radius: 1, rotate: 2", "rotate"},
          {"radius: 1", "radius"},
          {"type: disk, radius: 1, samples: 0", "samples"},
          {"type: disc, radius: 1", "did you mean 'disk'?"}})
        expect_refused(std::string("[{position: [0, 0, 0], intensity: 1, ") + keys + "}]", part);
}

TEST_F(LampReader, ReadsSunsInTheWorldUnderTheWatersSurface) {
    const WaterSurfaceDesc surface{{0, 8, 0}, {0, 1, 0}};
    context_.water_surface = surface;
    const LampDesc sun = read("[{type: sun, direction: [0, -2, 0], irradiance: [1, 2, 3]}]").at(0);
    ASSERT_TRUE(sun.sun);
    EXPECT_EQ(*sun.sun, (SunDesc{0, 32, surface}));
    EXPECT_EQ(sun.direction, Vector3(0, -1, 0));
    EXPECT_EQ(*sun.intensity, (PerBand{1, 2, 3}));
    EXPECT_FALSE(sun.fixed_to_camera);
    const LampDesc wide =
        read(
            "[{type: sun, direction: [0, -2, 0], lux: 5e4, spectrum: {type: d65}, angle: 0.53, "
            "samples: 8}]")
            .at(0);
    EXPECT_EQ(*wide.sun, (SunDesc{0.53, 8, surface}));
    EXPECT_EQ(wide.lumens, 5e4);
    for (const auto& [keys, part] :
         {std::pair{"irradiance: 1", "'direction' is missing"},
          {"direction: [0, 0, 0], irradiance: 1", "direction"},
          {"direction: [0, -1, 0]", "give irradiance in W/m2, or its spectrum and lux"},
          {"direction: [0, -1, 0], irradiance: 1, lux: 3, spectrum: {type: d65}", "remove one"},
          {"direction: [0, -1, 0], lux: 3", "spectrum"},
          {"direction: [0, -1, 0], irradiance: 1, angle: 100", "angle"},
          {"direction: [0, -1, 0], irradiance: 1, position: [0, 0, 0]", "position"},
          {"direction: [0, -1, 0], irradiance: 1, frame: camera", "frame"},
          {"direction: [0, -1, 0], intensity: 1", "irradiance"}})
        expect_refused(std::string("[{type: sun, ") + keys + "}]", part);
    expect_refused("[{position: [0, 0, 0], intensity: 1, angle: 1}]", "angle");
    context_.water_surface.reset();
    expect_refused("[{type: sun, direction: [0, -1, 0], irradiance: 1}]",
                   "give water: {surface: {point: [0, 10, 0], normal: [0, 1, 0]}}");
}

TEST_F(LampReader, OnlyAbsoluteProfilesNeedNoOutput) {
    folder_.write("lamp.ies", "x");
    EXPECT_NO_THROW(read("[{position: [0, 0, 0], profile: {type: ies, file: lamp.ies}}]"));
    for (const char* const other :
         {"{type: isotropic}", "{type: spot, beam: 60}", "{type: cosine, fwhm: 60}"})
        EXPECT_THROW(read(std::string("[{position: [0, 0, 0], profile: ") + other + "}]"),
                     InputError)
            << other;
}

TEST_F(LampReader, NamesAllProfiles) {
    expect_refused("[{position: [0, 0, 0], intensity: 1, profile: {type: laser}}]",
                   "lamps[0].profile.type: unknown value 'laser'; use one of: isotropic, spot, "
                   "cosine, table, ies");
}

}  // namespace
}  // namespace uw
