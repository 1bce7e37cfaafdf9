#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/output_files.h"
#include "core/image/pixel_image.h"
#include "validation/validation.h"

namespace uw {

/// The style sheet of report pages.
extern const char* const k_report_style;

/// "passed" or "FAILED", in colour.
std::string verdict_html(bool passed);

/// Turns pictures into HTML that needs no other files; owns the folder for temporary ones.
class ReportPictures {
  public:
    /// A picture with a caption below.
    std::string figure(const Preview& picture, const std::string& caption) const;

  private:
    ScratchFolder folder_;
};

/// The checks and the parts of the light as lines of text; failed checks are red if `colour` is
/// set.
std::string light_table(const LightValidation& light, bool colour);

/// The same with pictures and a plot of the parts, as a section of a report page.
std::string light_section(const LightValidation& light, const ReportPictures& pictures);

/// The checks of one scene as lines of text; failed ones are red if `colour` is set.
std::string validation_table(const SceneValidation& scene, bool colour);

/// Writes one self-contained HTML page: the tables, the pictures of every method, maps of their
/// differences, the convergence of the planes, and what is said of all light. Throws IoError.
void write_validation_report(const std::filesystem::path& file,
                             const std::vector<SceneValidation>& scenes,
                             const std::vector<LightValidation>& lights);

}  // namespace uw
