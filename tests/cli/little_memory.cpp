// ctest labels: unit slow
// A machine, or a share of one, with little memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/output_files.h"
#include "core/image/pixel_image.h"
#include "core/image/png_file.h"
#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

class LittleMemory : public CliTest {
  protected:
    /// The program has 2 GB of address space for all that it is and does.
    ProgramResult run_in_2_gb(const std::vector<std::string>& arguments) const {
        return run_in(2'000'000'000, arguments);
    }
    ProgramResult run_in(rlim_t bytes, const std::vector<std::string>& arguments) const {
        struct Restore {
            rlimit limit{};
            Restore() { ::getrlimit(RLIMIT_AS, &limit); }
            ~Restore() { ::setrlimit(RLIMIT_AS, &limit); }
        } const restore;
        const rlimit little{bytes, restore.limit.rlim_max};
        ::setrlimit(RLIMIT_AS, &little);
        return run(arguments);
    }
    /// The program has so many bytes of address space: it renders nothing and says so in one line
    /// that holds `message`.
    void expect_refused(rlim_t bytes, std::vector<std::string> arguments,
                        const std::string& message, int exit_code = 1) const {
        arguments.insert(arguments.begin(), "render");
        for (const char* const more : {"-o", "out.exr", "--threads", "1", "--quiet"})
            arguments.emplace_back(more);
        const ProgramResult result = run_in(bytes, arguments);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(line_count(result.err), 1) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_FALSE(exists("out.exr"));
    }
    static std::string scene_with_mesh(const std::string& file) {
        std::string scene = k_small_scene;
        return scene.insert(scene.find("  - {type: plane"), "  - {file: " + file + "}\n");
    }
};

TEST_F(LittleMemory, RendersWhatFits) {
    const ProgramResult result = run_in_2_gb(
        {"render", "scene.yaml", "-o", "out.exr", "--layers", "all", "--threads", "2", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

// However little it is: until it is enough, the run ends with one line that says so.
TEST_F(LittleMemory, IsNeverAFaultOfTheProgram) {
    int done = 0, refused = 0;
    for (rlim_t megabytes = 200; megabytes <= 1000; megabytes += 50) {
        const ProgramResult result =
            run_in(megabytes * 1'000'000,
                   {"render", "scene.yaml", "-o", "out.exr", "--threads", "1", "--quiet"});
        if (result.exit_code == 0) {
            ++done;
            continue;
        }
        // There is no room for the libraries of this system, which end the program before it
        // begins.
        if (result.exit_code == 127) continue;
        ++refused;
        EXPECT_EQ(result.exit_code, 1) << megabytes << " MB: " << result.err;
        EXPECT_EQ(line_count(result.err), 1) << megabytes << " MB: " << result.err;
        EXPECT_NE(result.err.find("memory"), std::string::npos)
            << megabytes << " MB: " << result.err;
        EXPECT_EQ(result.err.find("report it"), std::string::npos)
            << megabytes << " MB: " << result.err;
    }
    EXPECT_GT(done, 0);
    EXPECT_GT(refused, 0);
}

// Before anything is rendered, by what is left of the 2 GB, whatever the machine has.
TEST_F(LittleMemory, RefusesWhatDoesNot) {
    const ProgramResult result = run_in_2_gb({"render", "scene.yaml", "-o", "out.exr", "--size",
                                              "6000x4000", "--layers", "all", "--quiet"});
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("but only 1."), std::string::npos) << result.err;
    EXPECT_FALSE(exists("out.exr"));
}

TEST_F(LittleMemory, RefusesAVolumeThatDoesNotFit) {
    // 405 224 blocks of one voxel each: few bytes in the file, 0.8 GB of values.
    VdbFixture scattered;
    scattered.max = {591, 591, 591};
    scattered.value = [](int i, int j, int k) { return ((i | j | k) & 7) == 0 ? 1.0 : 0.0; };
    scattered.file_from_index = Affine::scale(Vector3(0.001));
    write_fixture(folder_ / "scattered.vdb", {scattered});
    write("volume.yaml", std::string(k_small_scene) +
                             "volumes:\n  - {file: scattered.vdb, grids: {density: {small: 1}}}\n");
    expect_refused(900'000'000, {"volume.yaml"},
                   "scattered.vdb': it needs 0.952 GB of memory, but only 0.");
}

TEST_F(LittleMemory, RefusesMeshesThatDoNotFit) {
    constexpr std::uint32_t k_triangles = 3'000'000;
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(k_triangles + 2) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(k_triangles) + "\nproperty list uchar uint vertex_indices\nend_header\n";
    const auto append = [&](const auto& value) {
        ply.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    // A strip.
    for (std::uint32_t k = 0; k < k_triangles + 2; ++k)
        for (const double value : {1e-5 * k, static_cast<double>(k % 2), 3.0})
            append(static_cast<float>(value));
    for (std::uint32_t k = 0; k < k_triangles; ++k) {
        append(std::uint8_t{3});
        for (const std::uint32_t corner : {k, k + 1, k + 2}) append(corner);
    }
    write("many.ply", ply);
    write("meshes.yaml", scene_with_mesh("many.ply"));
    expect_refused(500'000'000, {"meshes.yaml"},
                   "to trace 3000012 triangles takes 0.3 GB of memory, but only 0.");
}

TEST_F(LittleMemory, RefusesATextureThatDoesNotFit) {
    constexpr int k_side = 8000;
    OutputFile png(folder_ / "large.png");
    write_png_file(png,
                   DigitalImage{.width = k_side,
                                .height = k_side,
                                .values = std::vector<std::uint16_t>(std::size_t{k_side} * k_side)},
                   {});
    png.commit();
    write("large.mtl", "newmtl large\nmap_Kd large.png\n");
    write("large.obj",
          "mtllib large.mtl\nv 0 0 3\nv 1 0 3\nv 0 1 3\nvt 0 0\nusemtl large\nf 1/1 2/1 3/1\n");
    write("texture.yaml", scene_with_mesh("large.obj"));
    expect_refused(500'000'000, {"texture.yaml"},
                   "large.png: 8000 x 8000 pixels need 0.32 GB of memory, but only 0.");
}

// Each of 10 240 points has shadows of its own: known from the first few.
TEST_F(LittleMemory, RefusesLightOfLampsThatDoesNotFit) {
    std::string scene = k_small_scene;
    for (int n = 0; n < 10; ++n)
        scene +=
            "  - {type: disk, radius: 0.3, samples: 1024, position: [0, 0, 0], direction: "
            "[0, 0, 1], profile: {type: isotropic}, intensity: 1}\n";
    write("lamps.yaml", scene);
    // 144 GB: what the machine could not hold at all is bad input.
    const int exit_code = static_cast<double>(read_free_memory().most) < 1.4e11 ? 3 : 1;
    expect_refused(900'000'000, {"lamps.yaml"},
                   "lamps: what 10241 points of light see takes another", exit_code);
}

// Which has no maps of lamps where there is nothing to throw shadows.
TEST_F(LittleMemory, RefusesMultipleScatteringThatDoesNotFit) {
    std::string scene = k_small_scene;
    scene.erase(scene.find("  bands:"));
    scene += "  preset: jerlov-II\n  bands: [420";
    for (int nm = 430; nm <= 670; nm += 10) scene += ", " + std::to_string(nm);
    scene += "]\nlamps:\n";
    for (int n = 0; n < 60; ++n)
        scene += "  - {position: [" + std::to_string(n + 1) +
                 ", 0, 0], direction: [0, 0, 1], profile: {type: isotropic}, intensity: 1}\n";
    write("multiple.yaml", scene + "render: {scattering: multiple}\n");
    expect_refused(600'000'000, {"multiple.yaml", "--layers", "lamps"},
                   "render.scattering: multiple: 60 lamps in 26 bands need");
}

}  // namespace
}  // namespace uw::test
