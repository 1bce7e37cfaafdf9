// ctest labels: unit
//
// Files of other programs, which cannot all be part of the project: the environment variable
// UWVDB_SAMPLES names their folder. Where it is set, a file that is missing there is a failure.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "core/base/error.h"
#include "media/volumes/load_volumes.h"
#include "media/volumes/vdb_header.h"

namespace uw {
namespace {

/// A file, a grid to ask for, and either what must come or part of the refusal.
struct Sample {
    const char* file;
    const char* grid;
    const char* refusal = "";
    double voxel = 0;  // edge of the first axis [m]
    double max = 0;    // largest value
    std::int64_t active = 0;
    Centering centering = Centering::node;
    UpAxis up = UpAxis::y;
};

std::ostream& operator<<(std::ostream& out, const Sample& sample) {
    return out << sample.file << " " << sample.grid;
}

VolumeDesc describe(const std::filesystem::path& file, const std::string& grid) {
    VolumeDesc desc;
    desc.file = file;
    desc.where = "scene.yaml:1:1: volumes[0]";
    desc.grids.resize(1);
    desc.grids[0].grid = grid;
    desc.grids[0].where = desc.where;
    return desc;
}

void expect_loads(const std::filesystem::path& file, const Sample& sample) {
    std::vector<VolumeReport> reports;
    std::vector<std::string> warnings;
    const auto field =
        load_volumes({describe(file, sample.grid)}, {{{GridLoad{0, 2.0}}}}, 1, reports, warnings);
    ASSERT_EQ(reports.size(), 1U);
    const VolumeReport& report = reports[0];
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_NEAR(report.metres_per_voxel.x, sample.voxel, 1e-5 * sample.voxel);
    EXPECT_NEAR(report.statistics.max, sample.max, 1e-3 * sample.max);
    EXPECT_EQ(report.statistics.active_voxels, sample.active);
    EXPECT_EQ(report.placement.centering, sample.centering);
    EXPECT_EQ(report.placement.up, sample.up);
    EXPECT_FALSE(field->bounds().empty());
    for (const double column : report.column) {
        EXPECT_GE(column, 0);
        EXPECT_LE(column, report.statistics.max * field->bounds().diagonal());
    }
    // Light across the whole grid: the profile and the exact column tell the same.
    const Bounds bounds = field->bounds();
    const double length = bounds.diagonal();
    ConcentrationProfile profile;
    field->profile({bounds.min, (1 / length) * (bounds.max - bounds.min)}, length, profile);
    double column = 0;
    field->column(bounds.min, bounds.max, {&column, 1});
    EXPECT_GT(column, 0);
    EXPECT_NEAR(profile.column.back(), column, 0.02 * column);
}

void expect_refused(const std::filesystem::path& file, const Sample& sample) {
    std::vector<VolumeReport> reports;
    std::vector<std::string> warnings;
    try {
        load_volumes({describe(file, sample.grid)}, {{{GridLoad{0, 1.0}}}}, 1, reports, warnings);
        ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_TRUE(what.starts_with("scene.yaml:1:1: volumes[0]: ")) << what;
        EXPECT_NE(what.find(sample.refusal), std::string::npos) << what;
        EXPECT_NE(what.find(file.string()), std::string::npos) << what;
    }
}

void check(const std::filesystem::path& folder, const Sample& sample) {
    const std::filesystem::path file = folder / sample.file;
    ASSERT_TRUE(std::filesystem::exists(file)) << file << " is missing";
    if (*sample.refusal != '\0')
        expect_refused(file, sample);
    else
        expect_loads(file, sample);
}

const Sample k_plume{"plume128_blosc_half_0030.vdb",
                     "density",
                     "",
                     0.046875,
                     1.0,
                     18076,
                     Centering::cell,
                     UpAxis::z};

// The counts of active voxels are those the files' own metadata state.
const std::vector<Sample> k_samples{
    k_plume,
    {"plume128_blosc_half_0020.vdb", "density", "", 0.046875, 1.0, 11684, Centering::cell,
     UpAxis::z},
    {"plume128_blosc_half_0040.vdb", "density", "", 0.046875, 1.0, 25372, Centering::cell,
     UpAxis::z},
    {"plume128long_blosc_half_0100.vdb", "density", "", 0.046875, 1.0, 174054, Centering::cell,
     UpAxis::z},
    {"plume96_noise2_data_0030.vdb", "density", "", 0.0625, 1.0, 8984, Centering::cell, UpAxis::z},
    {"plume96_noise2_noise_0030.vdb", "density_noise", "", 0.03125, 1.99121, 69509, Centering::cell,
     UpAxis::z},
    {"plume96_none32_0024.vdb", "density", "", 0.0625, 0.999448, 7049, Centering::cell, UpAxis::z},
    {"plume96_zip32_0024.vdb", "density", "", 0.0625, 0.999448, 7049, Centering::cell, UpAxis::z},
    {"fire64_blosc_half_0020.vdb", "density", "", 0.09375, 1.04688, 2849, Centering::cell,
     UpAxis::z},
    {"openvdb_smoke_houdini.vdb", "density", "", 0.476190476, 5.71484, 1049275},
    {"gaffer_sphere.vdb", "density", "", 0.2, 1.0, 465},
    {"oiio_sphere.vdb", "density", "", 0.1, 1.0, 9047},
    {"arnold_torus01.vdb", "voxel_fog_density", "", 0.403230965, 100, 2450},
    {"arnold_grids.vdb", "density[0]", "", 0.1, 10, 491},
    {"arnold_grids.vdb", "density[1]", "", 0.1, 10, 2222},
    {"arnold_grids.vdb", "density[2]", "", 0.1, 10, 803},
    {"arnold_grids.vdb", "density",
     "3 grids are called 'density'; write 'density[0]' for the first"},
    {"arnold_pointgrid.vdb", "points", "grid 'points' holds points"},
    {"openvdb_sphere_houdini.vdb", "ls_sphere", "grid 'ls_sphere' is a level set"},
    {"oiio_sphereCd.vdb", "Cd", "grid 'Cd' holds vectors (vec3s)"},
    {"fire64_blosc_half_0020.vdb", "velocity", "grid 'velocity' holds vectors (vec3s)"},
    {"plume96_noise2_noise_0030.vdb", "density", "no grid 'density'"}};

TEST(VdbSamples, ThePlumeOfTheProject) {
    const std::filesystem::path folder = std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/grids";
    check(folder, k_plume);
    const VdbHeader header = read_vdb_header(folder / k_plume.file, "here");
    EXPECT_TRUE(header.from_blender_fluid());
    EXPECT_EQ(header.grids.size(), 8U);
}

class OtherPrograms : public testing::TestWithParam<Sample> {};

TEST_P(OtherPrograms, LoadOrSayWhyNot) {
    check(std::getenv("UWVDB_SAMPLES"), GetParam());
}

std::vector<Sample> samples_where_available() {
    return std::getenv("UWVDB_SAMPLES") != nullptr ? k_samples : std::vector<Sample>{};
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OtherPrograms);
INSTANTIATE_TEST_SUITE_P(VdbSamples, OtherPrograms, testing::ValuesIn(samples_where_available()));

}  // namespace
}  // namespace uw
