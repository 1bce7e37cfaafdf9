#include "cli/sweep/sweep_command.h"

#include <fmt/format.h>

#include <memory>

#include "cli/console.h"
#include "cli/progress.h"
#include "cli/stop_signal.h"
#include "cli/sweep/sweep_table.h"
#include "cli/text_files.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/stop.h"
#include "core/base/text.h"

namespace uw {

namespace {

std::filesystem::path table_of(const SweepArguments& a) {
    if (a.output.empty()) return a.scene.stem().string() + "-sweep.csv";
    if (a.output.extension() != ".csv")
        throw UsageError(fmt::format("-o {}: it is written as CSV; give a name that ends in .csv",
                                     printable(a.output.string(), 300)));
    return a.output;
}

}  // namespace

void run_sweep(const SweepArguments& a) {
    check_axes(a);
    const ThreadLimit limit(a.threads);
    const std::filesystem::path table = table_of(a);
    std::filesystem::path plot = table;
    plot.replace_extension(".svg");
    for (const auto& file : {table, plot}) const AtomicFile probe(file);
    begin_orderly_stop();
    Sweep sweep;
    {
        const StopScope scope(stop_flag());
        Progress progress("sweep", "pictures", static_cast<double>(a.count()), a.quiet);
        sweep = run_pictures(a, [&](double share) {
            progress.update(share);
            return !stop_requested();
        });
    }
    for (const std::string& warning : sweep.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    if (sweep.points.empty()) throw Interrupted();
    TextFiles files;
    files.add(table, sweep_csv(sweep));
    files.add(plot, svg_document(sweep_figure(sweep, a)));
    if (!a.quiet) print_message(best_of(sweep) + "\n");
    files.commit(a.quiet);
    if (!sweep.is_complete)
        throw Interrupted(fmt::format("interrupted; {} of {} pictures are measured",
                                      sweep.points.size(), a.count()));
}

Command sweep_command() {
    const auto arguments = std::make_shared<SweepArguments>();
    return {"sweep", "measure a scene over a range of values: a table and a plot", k_sweep_examples,
            sweep_options(*arguments), [arguments] {
                install_stop_signal();
                run_sweep(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
