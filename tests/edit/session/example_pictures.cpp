// ctest labels: metamorphic golden slow
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "tests/support/edit_examples.h"

namespace {

using namespace uw;
using namespace uw::test;

// These make maps of caustics, which take long (tests/edit/session/all_light_pictures.cpp), or need
// a file of the user's.
const std::set<std::string> k_elsewhere{"houdini.yaml", "shallows.yaml"};

// Forward scatter blurs a lamp's light by how far it has come: by its own way where the lamp is
// rendered alone, by the mean of the ways from all lamps in their one image.
double tolerance_of(const std::string& name) {
    return name == "paper/figure6-components.yaml" ? 1.5e-2 : 1e-3;
}

// What `uwvdb render` shows of a scene, the editor shows: of all lamps and of what shines by
// itself, through lens and port, in the colours of any number of bands. The tolerance is that of
// in-scatter, which is interpolated between pixels for each lamp by itself. All light, which has
// noise, is compared in all_light_pictures.cpp.
TEST(ExamplePictures, AreThoseThatRenderGives) {
    const std::filesystem::path folder =
        std::filesystem::path(UWVDB_SOURCE_DIR) / "assets" / "scenes";
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).string();
        if (entry.path().extension() != ".yaml" || k_elsewhere.contains(name)) continue;
        const TwoPictures pictures = both_pictures_of(name, 64, 36, RenderDesc::Scattering::single);
        EXPECT_GT(pictures.mean(), 0) << name;
        EXPECT_LT(pictures.rms_difference(), tolerance_of(name) * pictures.mean()) << name;
        ++count;
    }
    EXPECT_GE(count, 23);
}

}  // namespace
