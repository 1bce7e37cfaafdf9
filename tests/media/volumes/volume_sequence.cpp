// ctest labels: unit
#include "media/volumes/load_volumes.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_dir.h"
#include "tests/support/vdb/vdb_loading.h"

namespace uw {
namespace {

class VolumeSequence : public testing::Test {
  protected:
    /// A frame with one grid at a place of its own.
    VolumeDesc frame(const std::string& name, const Affine& file_from_index,
                     const std::string& grid = "density") const {
        test::VdbFixture fixture = test::single_voxel(grid);
        fixture.file_from_index = file_from_index;
        test::write_fixture(dir_ / name, {fixture});
        VolumeDesc desc;
        desc.file = dir_ / name;
        desc.where = "scene.yaml:3:5: volumes[0]";
        desc.grids.resize(1);
        desc.grids[0].grid = "density";
        desc.grids[0].where = desc.where + ".grids.density";
        return desc;
    }
    test::TempDir dir_;
};

TEST_F(VolumeSequence, OfOneTransformGoesTogether) {
    VolumeSequenceCheck check;
    const Affine place(Matrix3(0.05), {1, 2, 3});
    check.take(frame("1.vdb", place));
    EXPECT_NO_THROW(check.take(frame("2.vdb", place)));
    // Rounded otherwise by the program that wrote it: a hundred-thousandth of a voxel.
    EXPECT_NO_THROW(check.take(frame("3.vdb", Affine(Matrix3(0.0500005), {1, 2.0000005, 3}))));
}

TEST_F(VolumeSequence, ThatMovesIsRefused) {
    VolumeSequenceCheck check;
    check.take(frame("1.vdb", Affine(Matrix3(0.05), {1, 2, 3})));
    const VolumeDesc moved = frame("2.vdb", Affine(Matrix3(0.05), {1, 2, 3.01}));
    EXPECT_EQ(test::message_of<InputError>([&] { check.take(moved); }),
              "scene.yaml:3:5: volumes[0].grids.density: grid 'density' of '" +
                  (dir_ / "2.vdb").string() +
                  "' has voxels of 0.05 x 0.05 x 0.05 from (1, 2, 3.01), but that of '" +
                  (dir_ / "1.vdb").string() +
                  "' has voxels of 0.05 x 0.05 x 0.05 from (1, 2, 3); export all frames with one "
                  "transform, or render them in separate runs");
    EXPECT_THROW(check.take(frame("3.vdb", Affine(Matrix3(0.051), {1, 2, 3}))), InputError);
}

TEST_F(VolumeSequence, NeedsItsGridsInEachFrame) {
    VolumeSequenceCheck check;
    check.take(frame("1.vdb", Affine()));
    const VolumeDesc other = frame("2.vdb", Affine(), "smoke");
    EXPECT_NE(test::message_of<InputError>([&] { check.take(other); }).find("no grid 'density'"),
              std::string::npos);
    VolumeDesc missing = other;
    missing.file = dir_ / "none.vdb";
    EXPECT_THROW(check.take(missing), IoError);
}

}  // namespace
}  // namespace uw
