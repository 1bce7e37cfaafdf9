#include "tests/support/vdb/vdb_fixtures.h"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/LevelSetSphere.h>

#include "media/volumes/grid_bricks.h"

namespace uw::test {
namespace {

openvdb::math::Transform::Ptr to_transform(const Affine& file_from_index) {
    openvdb::Mat4d m = openvdb::Mat4d::identity();
    for (int column = 0; column < 3; ++column) {  // OpenVDB multiplies row vectors from the left
        for (int row = 0; row < 3; ++row) m[column][row] = file_from_index.linear()[column][row];
        m[3][column] = file_from_index.offset()[column];
    }
    return openvdb::math::Transform::createLinearTransform(m);
}

openvdb::CoordBBox to_box(const VdbBox& box) {
    return {openvdb::Coord(box.min[0], box.min[1], box.min[2]),
            openvdb::Coord(box.max[0], box.max[1], box.max[2])};
}

template <class GridT>
openvdb::GridBase::Ptr make_grid(const VdbFixture& fixture) {
    using Value = typename GridT::ValueType;
    auto grid = make_empty_grid<GridT>(static_cast<Value>(fixture.background));
    grid->setName(fixture.name);
    if (!fixture.grid_class.empty())
        grid->setGridClass(openvdb::GridBase::stringToGridClass(fixture.grid_class));
    grid->setTransform(to_transform(fixture.file_from_index));
    grid->setSaveFloatAsHalf(fixture.numbers == VdbNumbers::half);
    for (const VdbBox& box : fixture.boxes)
        grid->tree().sparseFill(to_box(box), static_cast<Value>(box.value), true);
    for (const VdbBox& box : fixture.inactive_boxes)
        grid->tree().sparseFill(to_box(box), static_cast<Value>(box.value), false);
    auto accessor = grid->getAccessor();
    for (int i = fixture.min[0]; i <= fixture.max[0]; ++i)
        for (int j = fixture.min[1]; j <= fixture.max[1]; ++j)
            for (int k = fixture.min[2]; k <= fixture.max[2]; ++k) {
                const auto value = static_cast<Value>(fixture.value(i, j, k));
                if (value != 0) accessor.setValue(openvdb::Coord(i, j, k), value);
            }
    if (fixture.blender_metadata)
        grid->insertMeta("file_base_resolution",
                         openvdb::Vec3IMetadata(openvdb::Vec3i(fixture.base_resolution.data())));
    for (const auto& [name, text] : fixture.metadata)
        grid->insertMeta(name, openvdb::StringMetadata(text));
    return grid;
}

void write_grids(const std::filesystem::path& file, const openvdb::GridPtrVec& grids,
                 const std::string& creator) {
    openvdb::MetaMap metadata;
    if (!creator.empty()) metadata.insertMeta("creator", openvdb::StringMetadata(creator));
    openvdb::io::File(file.string()).write(grids, metadata);
}

}  // namespace

void write_fixture(const std::filesystem::path& file, const std::vector<VdbFixture>& grids,
                   const std::string& creator) {
    initialize_openvdb();
    openvdb::GridPtrVec made;
    for (const VdbFixture& fixture : grids)
        made.push_back(fixture.numbers == VdbNumbers::float64
                           ? make_grid<openvdb::DoubleGrid>(fixture)
                           : make_grid<openvdb::FloatGrid>(fixture));
    write_grids(file, made, creator);
}

void write_point_grid(const std::filesystem::path& file) {
    initialize_openvdb();
    const auto grid = openvdb::GridBase::createGrid(openvdb::points::PointDataGrid::gridType());
    grid->setName("points");
    write_grids(file, {grid}, "");
}

void write_vector_grid(const std::filesystem::path& file) {
    initialize_openvdb();
    auto grid = make_empty_grid<openvdb::Vec3SGrid>(openvdb::Vec3f(0));
    grid->setName("vel");
    grid->getAccessor().setValue({0, 0, 0}, openvdb::Vec3f(1, 2, 3));
    write_grids(file, {grid}, "");
}

void write_bool_and_int_grids(const std::filesystem::path& file) {
    initialize_openvdb();
    auto flag = make_empty_grid<openvdb::BoolGrid>(false);
    flag->setName("flag");
    flag->getAccessor().setValue({0, 0, 0}, true);
    auto flags = make_empty_grid<openvdb::Int32Grid>(0);
    flags->setName("flags");
    flags->getAccessor().setValue({0, 0, 0}, 3);
    write_grids(file, {flag, flags}, "");
}

void write_level_set(const std::filesystem::path& file, bool with_class) {
    initialize_openvdb();
    auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        1.0F, openvdb::Vec3f(0, 0, 0), 0.1F);
    grid->setName("surface");
    grid->setGridClass(with_class ? openvdb::GRID_LEVEL_SET : openvdb::GRID_UNKNOWN);
    write_grids(file, {grid}, "");
}

void write_frustum_grid(const std::filesystem::path& file) {
    initialize_openvdb();
    auto grid = make_empty_grid<openvdb::FloatGrid>(0.0F);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->getAccessor().setValue({1, 1, 1}, 1.0F);
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), /*taper=*/0.5, /*depth=*/10.0));
    write_grids(file, {grid}, "");
}

void write_instanced_grids(const std::filesystem::path& file) {
    initialize_openvdb();
    auto grid = make_empty_grid<openvdb::FloatGrid>(0.0F);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->getAccessor().setValue({1, 1, 1}, 2.0F);
    auto copy = make_empty_grid<openvdb::FloatGrid>(0.0F);
    copy->setTree(grid->baseTreePtr());
    copy->setName("copy");
    copy->setGridClass(openvdb::GRID_FOG_VOLUME);
    copy->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    write_grids(file, {grid, copy}, "");
}

void write_moving_grid(const std::filesystem::path& file, const VdbFixture& density,
                       const Vector3& velocity, VelocityKind kind) {
    initialize_openvdb();
    const openvdb::CoordBBox box(openvdb::Coord(-64), openvdb::Coord(63));
    openvdb::GridPtrVec grids{make_grid<openvdb::FloatGrid>(density)};
    const auto add = [&](auto grid, const std::string& name, const auto& value) {
        grid->setName(name);
        grid->setTransform(to_transform(density.file_from_index));
        grid->tree().sparseFill(box, value, true);
        grids.push_back(grid);
    };
    if (kind == VelocityKind::three_numbers) {
        for (int c = 0; c < 3; ++c)
            add(make_empty_grid<openvdb::FloatGrid>(0.0F), std::string("vel.") + "xyz"[c],
                static_cast<float>(velocity[c]));
    } else {
        auto vectors = make_empty_grid<openvdb::Vec3SGrid>(openvdb::Vec3f(0));
        if (kind == VelocityKind::staggered) vectors->setGridClass(openvdb::GRID_STAGGERED);
        add(vectors, "vel", openvdb::Vec3f(openvdb::Vec3d(velocity.x, velocity.y, velocity.z)));
    }
    write_grids(file, grids, density.blender_metadata ? "" : "uwvdb tests");
}

}  // namespace uw::test
