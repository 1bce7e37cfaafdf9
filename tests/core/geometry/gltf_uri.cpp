// ctest labels: unit
#include "core/geometry/gltf_document.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

std::string beside(const std::string& uri) {
    return gltf_uri_path("/data/scene.gltf", uri).string();
}

TEST(GltfUri, StandsBesideTheFile) {
    EXPECT_EQ(beside("a.bin"), "/data/a.bin");
    EXPECT_EQ(beside("textures/a.png"), "/data/textures/a.png");
    EXPECT_EQ(gltf_uri_path("scene.gltf", "a.bin"), std::filesystem::path("a.bin"));
}

TEST(GltfUri, UndoesPercentEncoding) {
    EXPECT_EQ(beside("four%20texels.png"), "/data/four texels.png");
    EXPECT_EQ(beside("%C3%a4%25.bin"), "/data/\xC3\xA4%.bin");
    EXPECT_EQ(beside("a%2Fb%41"), "/data/a/bA");
}

TEST(GltfUri, LeavesWhatIsNoCode) {
    for (const char* uri : {"100%", "100%2", "%zz", "%4z", "% 1"})
        EXPECT_EQ(beside(uri), std::string("/data/") + uri);
}

}  // namespace
}  // namespace uw
