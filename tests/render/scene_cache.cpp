// ctest labels: unit
#include "render/scene_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "core/base/error.h"
#include "core/scene/scene_context.h"
#include "tests/support/field_maker.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A cloud, a mesh and water whose phase function is a table: a file of each kind.
class Caches : public testing::Test {
  protected:
    Caches() {
        write("wall.obj", "v 0 0 4\nv 1 0 4\nv 0 1 4\nf 1 2 3\n");
        write("phase.csv", "angle_deg,phase\n0,1\n90,0.1\n180,0.1\n");
        desc_ = pinhole_scene(8, 6);
        desc_.volumes = {maker_.volume(bumpy_fixture())};
        desc_.volumes[0].grids[0].optics =
            GridMappingDesc::Optics{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {}};
        GeometryDesc wall;
        wall.type = GeometryDesc::Type::file;
        wall.file = maker_.dir / "wall.obj";
        desc_.geometry = {wall};
        desc_.water.scattering->phase.function = TabulatedPhaseDesc{maker_.dir / "phase.csv"};
        // As its reader would have listed it.
        desc_.files = {
            {&*std::ranges::find(k_file_keys, "water.scattering.phase.file", &FileKey::path),
             maker_.dir / "phase.csv"}};
    }

    void write(const char* name, const char* text) const {
        std::ofstream(maker_.dir / name) << text;
    }
    void touch(const std::filesystem::path& file) const {
        last_write_time(file, last_write_time(file) + std::chrono::seconds(1));
    }
    AssembledScene assemble() {
        return assemble_scene(SceneDesc(desc_), cache_, [](Stage) {});
    }

    FieldMaker maker_;
    SceneDesc desc_;
    SceneCache cache_;
};

TEST_F(Caches, KeepWhatIsTheSame) {
    const AssembledScene first = assemble();
    desc_.lamps = {isotropic_lamp({}, 1)};
    desc_.camera.width = 4;
    const AssembledScene second = assemble();
    EXPECT_EQ(second.field, first.field);
    EXPECT_EQ(second.surfaces, first.surfaces);
    EXPECT_EQ(second.water.medium.phase_functions, first.water.medium.phase_functions);
    EXPECT_EQ(second.volume_reports.size(), first.volume_reports.size());
    desc_.geometry.push_back(plane_at_z(9));
    const AssembledScene third = assemble();
    EXPECT_EQ(third.field, first.field);
    EXPECT_NE(third.surfaces, first.surfaces);
}

TEST_F(Caches, ReadFilesAnewThatHaveChanged) {
    const AssembledScene first = assemble();
    touch(desc_.volumes[0].file);
    const AssembledScene second = assemble();
    EXPECT_NE(second.field, first.field);
    EXPECT_EQ(second.surfaces, first.surfaces);
    touch(desc_.geometry[0].file);
    const AssembledScene third = assemble();
    EXPECT_EQ(third.field, second.field);
    EXPECT_NE(third.surfaces, first.surfaces);
    touch(maker_.dir / "phase.csv");
    const AssembledScene fourth = assemble();
    EXPECT_EQ(fourth.surfaces, third.surfaces);
    EXPECT_NE(fourth.water.medium.phase_functions, first.water.medium.phase_functions);
}

TEST_F(Caches, HaveTheSurfacesOfTheNextSceneAhead) {
    const AssembledScene first = assemble();
    SceneDesc next = desc_;
    next.geometry.push_back(plane_at_z(9));
    const std::shared_ptr<const Surfaces> ahead = cache_.surfaces_ahead(next).surfaces;
    EXPECT_EQ(cache_.surfaces_ahead(next).surfaces, ahead);
    EXPECT_EQ(assemble().surfaces, first.surfaces);  // such as for another camera of the rig
    desc_ = next;
    EXPECT_EQ(assemble().surfaces, ahead);
}

TEST_F(Caches, KeepWhatWasLoadedBeforeAFault) {
    const AssembledScene first = assemble();
    desc_.geometry[0].file = maker_.dir / "none.obj";
    EXPECT_THROW(assemble(), IoError);
    desc_.geometry[0].file = maker_.dir / "wall.obj";
    EXPECT_EQ(assemble().field, first.field);
}

}  // namespace
}  // namespace uw::test
