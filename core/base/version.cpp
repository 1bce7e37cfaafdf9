#include "core/base/version.h"

namespace uw {

std::string program_version() {
    return UWVDB_VERSION_STRING;
}

std::string build_libraries() {
    return UWVDB_LIBRARIES;
}

}  // namespace uw
