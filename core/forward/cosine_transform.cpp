#include "core/forward/cosine_transform.h"

#include <fftw3.h>

#include <mutex>
#include <new>
#include <stdexcept>
#include <vector>

namespace uw {

namespace {

// FFTW's planner, unlike its transforms, is not thread safe.
std::mutex& planner_mutex() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

struct CosineTransform::Plans {
    struct Destroy {
        void operator()(fftw_plan_s* plan) const {
            const std::lock_guard lock(planner_mutex());
            fftw_destroy_plan(plan);
        }
    };
    using Plan = std::unique_ptr<fftw_plan_s, Destroy>;

    explicit Plans(int length)
        : forward(plan_line(length, FFTW_REDFT10)), inverse(plan_line(length, FFTW_REDFT01)) {}

    Plan forward, inverse;

  private:
    static Plan plan_line(int length, fftw_r2r_kind kind) {
        std::vector<double> line(static_cast<std::size_t>(length));
        const std::lock_guard lock(planner_mutex());
        // Estimated, not measured, so that the plan, and thus the rounding, is the same in every
        // run. Lines of an image differ in alignment.
        Plan plan(fftw_plan_r2r_1d(length, line.data(), line.data(), kind,
                                   FFTW_ESTIMATE | FFTW_UNALIGNED));
        if (!plan) throw std::bad_alloc();
        return plan;
    }
};

CosineTransform::CosineTransform(int length) : length_(length) {
    if (length < 1) throw std::invalid_argument("a cosine transform needs at least one value");
    plans_ = std::make_shared<Plans>(length);
}

void CosineTransform::forward(double* line) const {
    fftw_execute_r2r(plans_->forward.get(), line, line);
}

void CosineTransform::inverse(double* line) const {
    fftw_execute_r2r(plans_->inverse.get(), line, line);
}

}  // namespace uw
