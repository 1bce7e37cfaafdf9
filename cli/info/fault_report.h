#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace uw {

/// The information that a bug report should contain: `uwvdb info SUBJECT --report`.
struct FaultReportOf {
    std::filesystem::path subject;  // a scene, a VDB file, or none
    bool is_scene = false;
    std::vector<std::string> overrides;  // --set, of a scene
    /// What `uwvdb info SUBJECT` prints. May throw: then the report has the message.
    std::function<std::string()> log;
};

/// Prints the versions of program, libraries and system, the facts of the machine that matter, the
/// text of the scene, the names and sizes of the files that it is read from without their contents,
/// and the log, each as soon as it is known, so that all of it up to a crash is printed. The user's
/// folder is "~". Throws IoError if nothing can be printed.
void print_fault_report(const FaultReportOf& of);

}  // namespace uw
