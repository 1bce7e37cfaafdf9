#pragma once

#include <cmath>

#include "media/inspection/vdb_inspect.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "tests/fuzz/fuzzing.h"

namespace uw::fuzz {

/// Inspects a volume as `uwvdb info` does, and loads every grid as a scene does.
inline void read_volume_file(const std::filesystem::path& file) {
    parse([&] { inspect_vdb(file, "volume"); });
    parse([&] {
        const VdbHeader header = read_vdb_header(file, "volume");
        for (const GridSummary& grid : header.grids)
            parse([&] {
                const LoadedGrid loaded = load_grid(header, grid.name, "volume");
                if (!std::isfinite(loaded.statistics.max) || loaded.statistics.min < 0)
                    __builtin_trap();
            });
    });
}

}  // namespace uw::fuzz
