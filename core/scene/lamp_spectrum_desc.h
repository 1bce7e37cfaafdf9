#pragma once

#include <filesystem>
#include <string>

#include "core/scene/source_location.h"

namespace uw {

/// A lamp's relative spectral distribution.
struct LampSpectrumDesc {
    enum class Type { flat, d65, blackbody, led, file };
    Type type = Type::flat;
    double temperature = 0;      ///< of a blackbody [K], 500..100000
    std::string name;            ///< of an LED among the CIE's illuminants, "LED-B3"
    std::filesystem::path file;  ///< CSV with a column wavelength_nm and
    std::string column;          ///< this one; empty: the only other one
    SourceLocation where;
};

}  // namespace uw
