#pragma once

#include <string_view>
#include <vector>

namespace uw {

/// One file of edit/page, compiled in.
struct PageFile {
    std::string_view name;
    std::string_view text;
};

/// All files of the page, in the order of their names.
const std::vector<PageFile>& page_files();

/// The file of this name, or null.
const PageFile* find_page_file(std::string_view name);

/// The HTTP content type of a file of the page, by the ending of its name.
std::string_view content_type(std::string_view name);

}  // namespace uw
