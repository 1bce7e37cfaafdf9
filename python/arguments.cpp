#include "python/arguments.h"

#include <fmt/format.h>

#include <typeindex>

#include "core/base/error.h"
#include "core/base/text.h"

namespace py = pybind11;

namespace uw {

namespace {

constexpr std::size_t k_longest_text = 80;  // in messages

/// As Python writes it in ASCII, with quotes.
std::string ascii(py::handle text) {
    const auto written = py::reinterpret_steal<py::object>(PyObject_ASCII(text.ptr()));
    return printable(written.cast<std::string>(), k_longest_text);
}

}  // namespace

std::string text_of(py::handle text) {
    Py_ssize_t size = 0;
    const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
    if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
    PyErr_Clear();
    throw InputError(
        fmt::format("{}: the text has a lone surrogate, which is no character; remove it, or "
                    "decode the text from UTF-8",
                    ascii(text)));
}

bool load_file_name(py::handle name, FileName& into) {
    const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(name.ptr()));
    if (!path) {
        if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw py::error_already_set();
        PyErr_Clear();
        return false;
    }
    PyObject* encoded = nullptr;
    if (PyUnicode_FSConverter(path.ptr(), &encoded) == 0) {
        PyErr_Clear();
        throw InputError(fmt::format(
            "{}: no file can have this name; remove what is no character from it", ascii(path)));
    }
    const auto bytes = py::reinterpret_steal<py::bytes>(encoded);
    into.value = std::string(bytes);
    return true;
}

void require_made(py::handle object, const std::type_info& type) {
    const auto* const bound = py::detail::get_type_info(std::type_index(type), false);
    if (bound == nullptr || !object || PyObject_TypeCheck(object.ptr(), bound->type) == 0) return;
    auto* const instance = reinterpret_cast<py::detail::instance*>(object.ptr());
    if (!instance->get_value_and_holder(bound).holder_constructed())
        throw py::type_error(
            fmt::format("{}: the object was never made; call the class, not its __new__ alone",
                        bound->type->tp_name));
}

}  // namespace uw
