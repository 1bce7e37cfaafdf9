#pragma once

#include <string>

#include "cli/validate/light_check.h"
#include "cli/validate/report_page.h"

namespace uw {

/// The checks and the parts of the light as lines of text; failed checks are red if `colour` is
/// set.
std::string light_table(const LightValidation& light, bool colour);

/// The same with pictures and a plot of the parts, as a section of a report page.
std::string light_section(const LightValidation& light, const ReportPictures& pictures);

}  // namespace uw
