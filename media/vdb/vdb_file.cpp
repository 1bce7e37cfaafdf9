#include "media/vdb/vdb_file.h"

#include <fmt/format.h>

#include <openvdb/openvdb.h>

#include <cmath>

#include "core/base/error.h"
#include "media/vdb/grid_bricks.h"
#include "media/vdb/vdb_stream.h"

namespace uw {
namespace {

template <class GridT>
GridIntake read_grid(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                     const SourceLocation& where, LoadedGrid& loaded) {
    GridIntake total;
    read_slabs<GridT>(header, grid, slab_bytes, where, [&](typename GridT::Ptr slab) {
        loaded.file_from_index = to_affine(slab->transform());
        loaded.statistics.background = static_cast<double>(slab->background());
        total.add(take_slab(to_float(std::move(slab)), loaded.bricks));
    });
    return total;
}

}  // namespace

Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where);
    return read_guarded(describe_grid_place(header, grid, where),
                        [&] { return to_affine(*read_transform(header, grid, where)); });
}

LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where);
    const std::string prefix = describe_grid_place(header, grid, where);
    LoadedGrid loaded;
    loaded.name = grid.name;
    const GridIntake intake = read_guarded(prefix, [&] {
        return grid.value_type == "double"
                   ? read_grid<openvdb::DoubleGrid>(header, grid, slab_bytes, where, loaded)
                   : read_grid<openvdb::FloatGrid>(header, grid, slab_bytes, where, loaded);
    });
    loaded.statistics = intake.statistics(loaded.statistics.background);
    check_loaded(header, grid, prefix, loaded);
    loaded.warnings = intake_warnings(loaded.statistics, prefix);
    return loaded;
}

void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded) {
    const bool classless = grid.grid_class != "fog volume";
    const std::int64_t negative = loaded.statistics.negative_voxels;
    if (classless && loaded.statistics.background > 0 && negative > 0)
        throw InputError(fmt::format(
            "{}is a level set, though its class is '{}' (background {:g}, {} negative voxels), not "
            "a concentration; export a fog volume; the file has {}",
            prefix, grid.grid_class, loaded.statistics.background, negative,
            header.describe_grids()));
    const double determinant = loaded.file_from_index.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw InputError(prefix + "its transform is singular (voxels without volume)");
}

}  // namespace uw
