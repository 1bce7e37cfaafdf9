#include "core/base/scratch_folder.h"

#include <stdlib.h>

#include <string>

#include "core/base/error.h"

namespace uw {

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "uwvdb-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw IoError(name + ": cannot make a temporary folder; set TMPDIR to a writable one");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace uw
