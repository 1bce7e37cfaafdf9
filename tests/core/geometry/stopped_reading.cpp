// ctest labels: unit
// Meshes and textures that are read by work that is to stop.
#include <gtest/gtest.h>

#include <atomic>

#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/geometry/mesh.h"
#include "core/geometry/mesh_reader.h"
#include "core/image/image_file.h"
#include "core/image/jpeg_file.h"
#include "core/image/png_file.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"

namespace uw {
namespace {

class StoppedReading : public test::MeshReading {
  protected:
    /// A file that can be read, but not by work that is to stop.
    template <class Read>
    static void expect_stop(const Read& read) {
        EXPECT_NO_THROW(read());
        const std::atomic<bool> stop = true;
        const StopScope scope(stop);
        EXPECT_THROW(read(), Interrupted);
    }
    void expect_stop(const std::string& name, const std::string& bytes) {
        SCOPED_TRACE(name);
        const std::filesystem::path file = folder_.write(name, bytes);
        expect_stop([&] { read_mesh(file, warnings_); });
    }
};

TEST_F(StoppedReading, OfMeshesEndsWithATriangle) {
    expect_stop("a.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_stop("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_stop("a.stl",
                "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    expect_stop("a.gltf", test::gltf_text());
}

TEST_F(StoppedReading, OfTexturesEndsWithARow) {
    const DigitalImage image{8, 8, 3, 8, false, std::vector<std::uint16_t>(192, 77)};
    const std::filesystem::path png = folder_.path("a.png"), jpeg = folder_.path("a.jpg");
    {
        OutputGroup files;
        write_png_file(files.add(png), image, {});
        write_jpeg_file(files.add(jpeg), image, 90, {});
        files.commit();
    }
    for (const std::filesystem::path& file : {png, jpeg}) {
        SCOPED_TRACE(file);
        expect_stop([&] { read_image(file); });
    }
    const PixelImage pixels = read_image(png);
    expect_stop([&] { Texture(pixels, TextureEncoding::srgb, false); });
}

TEST_F(StoppedReading, OfTrianglesThatAreSiftedEndsWithOne) {
    TriangleMesh mesh;
    mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    mesh.triangles = {0, 1, 2};
    expect_stop([&] {
        DroppedTriangles dropped;
        drop_bad_triangles(mesh, dropped);
    });
}

}  // namespace
}  // namespace uw
