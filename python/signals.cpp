#include "python/signals.h"

#include <pybind11/pybind11.h>

namespace uw {

namespace py = pybind11;

void check_signals() {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void run_interruptible(WatchedTask& task, const std::function<void()>& work) {
    const py::gil_scoped_release release;
    task.run(work, [](const std::vector<WatchedTask::News>& /*news*/) { check_signals(); });
}

}  // namespace uw
