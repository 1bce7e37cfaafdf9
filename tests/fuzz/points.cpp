#include "core/base/csv_table.h"
#include "fit/board_corners.h"
#include "fit/point_residuals.h"
#include "tests/fuzz/fuzzing.h"

// Tables of points that photographs show, which are written and read again; and boards in words.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::parse([&] {
        const PointTable read = read_seen_points(CsvTable(text, "corners.csv"));
        try {
            const PointTable again = read_seen_points(CsvTable(point_csv(read), "corners.csv"));
            if (again.images != read.images) __builtin_trap();
        } catch (const InputError&) {
            __builtin_trap();  // what the program writes, it reads
        }
    });
    fuzz::parse([&] { read_board(std::string(text)); });
    return 0;
}
