#include "core/base/csv_table.h"
#include "tests/fuzz/fuzzing.h"

// Tables of any columns: each is read as numbers, and as a curve over the first.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    fuzz::parse([&] {
        const CsvTable table(fuzz::text_of(data, size), "table.csv");
        for (const std::string& column : table.columns()) {
            fuzz::parse([&] { table.numbers(column); });
            fuzz::parse([&] { table.curve(table.columns().front(), column); });
        }
    });
    return 0;
}
