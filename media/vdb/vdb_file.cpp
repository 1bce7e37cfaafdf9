#include "media/vdb/vdb_file.h"

#include "media/vdb/grid_bricks.h"
#include "media/vdb/grid_selection.h"
#include "media/vdb/vdb_stream.h"

namespace uw {

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
    GridIntake intake;
    read_guarded(prefix, [&] {
        read_slabs(header, grid, slab_bytes, where, [&](const openvdb::GridBase::Ptr& slab) {
            loaded.file_from_index = to_affine(slab->transform());
            loaded.statistics.background = background_of(*slab);
            intake.add(take_slab(to_float(slab), loaded.bricks));
        });
    });
    loaded.statistics = intake.statistics(loaded.statistics.background);
    check_loaded(header, grid, prefix, loaded);
    loaded.warnings = intake_warnings(loaded.statistics, prefix);
    return loaded;
}

}  // namespace uw
