#include "core/base/fast_exp.h"

#include "core/base/vector_clones.h"

namespace uw {

UWVDB_VECTOR_CLONES void exp_of_minus(std::span<double> x) {
    for (double& value : x) value = exp_of_minus(value);
}

}  // namespace uw
