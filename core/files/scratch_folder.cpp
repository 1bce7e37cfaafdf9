#include "core/files/scratch_folder.h"

#include <stdlib.h>

#include <string>
#include <system_error>

#include "core/base/error.h"

namespace uw {

ScratchFolder::ScratchFolder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string name = (parent / "uwvdb-XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr)
        throw IoError(name + ": cannot make a temporary folder; set TMPDIR to a writable one");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace uw
