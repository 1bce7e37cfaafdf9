#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <string>
#include <typeinfo>

namespace uw {

/// What Python hands over, looked at before anything is made of it.

/// A str as UTF-8. Throws InputError for one with a lone surrogate, which is no character.
std::string text_of(pybind11::handle text);

/// A parameter that is a str. Throws as text_of, where std::string would be refused as of another
/// type.
struct Text {
    std::string value;
    // NOLINTNEXTLINE(google-explicit-constructor): it is what it holds
    operator const std::string&() const { return value; }
};

/// A parameter that is the name of a file: a str or what has __fspath__. Throws InputError for one
/// that no file system can have.
struct FileName {
    std::filesystem::path value;
    // NOLINTNEXTLINE(google-explicit-constructor): it is what it holds
    operator const std::filesystem::path&() const { return value; }
};

/// Loads a FileName; false for what is none.
bool load_file_name(pybind11::handle name, FileName& into);

/// Throws TypeError for an instance of a bound class that was never made: __new__ was called alone.
/// pybind11 would take uninitialised memory for it.
void require_made(pybind11::handle object, const std::type_info& type);

/// Converts a bound class, and requires that its instances were made.
template <class Bound>
class MadeCaster : public pybind11::detail::type_caster_base<Bound> {
  public:
    bool load(pybind11::handle object, bool convert) {
        require_made(object, typeid(Bound));
        return pybind11::detail::type_caster_base<Bound>::load(object, convert);
    }
};

}  // namespace uw

/// To be written for each bound class, outside of all namespaces, before it is bound or converted.
#define UWVDB_BOUND_CLASS(Bound) \
    template <>                  \
    class pybind11::detail::type_caster<Bound> : public uw::MadeCaster<Bound> {}

template <>
struct pybind11::detail::type_caster<uw::Text> {
    PYBIND11_TYPE_CASTER(uw::Text, const_name("str"));

    bool load(handle object, bool /*convert*/) {
        if (PyUnicode_Check(object.ptr()) == 0) return false;
        value.value = uw::text_of(object);
        return true;
    }
};

template <>
struct pybind11::detail::type_caster<uw::FileName> {
    PYBIND11_TYPE_CASTER(uw::FileName, const_name("os.PathLike"));

    bool load(handle object, bool /*convert*/) { return uw::load_file_name(object, value); }
};
