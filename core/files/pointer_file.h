#pragma once

#include <filesystem>
#include <string>

namespace uw {

/// Git LFS and git-annex leave a small stand-in where the content of a large file has not been
/// fetched. What `file` stands in for and how to fetch it, to follow its name ("is a Git LFS
/// pointer ..."); "" if it is no such stand-in. Also recognises the broken links of git-annex.
std::string stand_in_of(const std::filesystem::path& file);

}  // namespace uw
