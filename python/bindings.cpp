#include "python/bindings.h"

#include <exception>
#include <string_view>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"

namespace py = pybind11;

namespace uw {

namespace {

void raise(const char* name, const std::exception& fault) {
    // Files may have names that are no UTF-8.
    const std::string_view text = fault.what();
    const auto message = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
        text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace"));
    PyErr_SetObject(py::module_::import("uwvdb.errors").attr(name).ptr(), message.ptr());
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
