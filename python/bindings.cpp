#include "python/bindings.h"

#include <exception>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"

namespace py = pybind11;

namespace uw {

namespace {

void raise(const char* name, const std::exception& fault) {
    PyErr_SetString(py::module_::import("uwvdb.errors").attr(name).ptr(), fault.what());
}

}  // namespace

void bind_errors(py::module_& /*module*/) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(std::move(thrown));
        } catch (const InputError& fault) {
            raise("InputError", fault);
        } catch (const IoError& fault) {
            raise("IoError", fault);
        } catch (const UsageError& fault) {
            raise("UsageError", fault);
        } catch (const Interrupted& fault) {
            raise("Interrupted", fault);
        } catch (const OutOfMemory& fault) {
            PyErr_SetString(PyExc_MemoryError, fault.what());
        }
    });
}

}  // namespace uw
