#pragma once

#include <mutex>

namespace uw {

/// A mutex to be held while FFTW makes or destroys a plan: its planner, unlike its transforms, is
/// not thread safe.
std::mutex& fourier_planner();

}  // namespace uw
