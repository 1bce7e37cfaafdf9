#include "core/base/fourier.h"

namespace uw {

std::mutex& fourier_planner() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace uw
