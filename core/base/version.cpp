#include "core/base/version.h"

namespace uw {

std::string program_version() {
    return UWVDB_VERSION_STRING;
}

}  // namespace uw
