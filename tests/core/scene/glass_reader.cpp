// ctest labels: unit
// `material` of glass: what is read, and what is refused.
#include <gtest/gtest.h>

#include "core/scene/geometry_desc.h"
#include "tests/support/section_reader.h"

namespace uw::test {
namespace {

class GlassReader : public SectionReader<std::vector<GeometryDesc>> {
  protected:
    GlassReader() : SectionReader("geometry", read_geometry) {}

    GlassDesc glass_of(const std::string& shape, const std::string& material) const {
        return read("[{" + shape + ", material: " + material + "}]").at(0).glass.value();
    }
    static constexpr const char* k_ball = "type: sphere, center: [0, 0, 2], radius: 1";
    static constexpr const char* k_plane = "type: plane, point: [0, 0, 2], normal: [0, 0, 1]";
};

TEST_F(GlassReader, ReadsWhatIsWritten) {
    EXPECT_EQ(glass_of(k_ball, "glass"), GlassDesc());
    EXPECT_EQ(glass_of(k_ball, "{type: glass, n: 1, roughness: 0}"), (GlassDesc{1, false, 0, {}}));
    EXPECT_EQ(glass_of(k_ball, "{type: glass, n: 1.33, absorption: [1, 2, 3]}"),
              (GlassDesc{1.33, false, 0, {1, 2, 3}}));
    EXPECT_EQ(glass_of(k_plane, "{type: glass, thin: true, thickness: 0.01, absorption: 5}"),
              (GlassDesc{1.5, true, 0.01, {5, 5, 5}}));
    folder_.write("mesh.stl", "solid\nendsolid\n");
    EXPECT_TRUE(read("[{file: mesh.stl, material: {type: glass}}]").at(0).glass);
    EXPECT_FALSE(read("[{" + std::string(k_ball) + "}]").at(0).glass);
}

TEST_F(GlassReader, RefusesWhatItCannotBe) {
    const auto refused = [&](const std::string& shape, const std::string& material,
                             const std::string& part) {
        expect_refused("[{" + shape + ", material: " + material + "}]", part);
    };
    refused(k_ball, "{type: glass, n: 0.9}", "geometry[0].material.n");
    refused(k_ball, "{type: glass, roughness: 0.2}", "rough glass is not rendered");
    refused(k_ball, "{type: glass, thickness: 0.1}", "solid glass is as thick as its shape");
    refused(k_ball, "{type: glass, thin: true, absorption: 1}", "needs a thickness");
    refused(k_ball, "{type: glas}", "did you mean 'glass'");
    refused(k_ball, "{n: 1.5}", "write type: glass");
    refused(k_ball, "{type: glass, ior: 1.5}", "unknown key");
    refused(k_ball, "pbr", "the only material of a shape");
    refused(k_plane, "{type: glass}", "a plane encloses no solid glass");
    refused(std::string(k_ball) + ", reflectance: 0.5", "{type: glass}",
            "glass has no reflectance of its own");
}

}  // namespace
}  // namespace uw::test
