#pragma once

#include <string>

#include "core/files/scratch_folder.h"
#include "core/image/preview.h"

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

}  // namespace uw
