#include "core/image_fft.h"

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

fftw_plan plan_line(std::vector<double>& line, fftw_r2r_kind kind) {
    // Estimated, not measured: the plan, and so the rounding, is the same in every run. Lines of an
    // image are not aligned alike.
    fftw_plan plan = fftw_plan_r2r_1d(static_cast<int>(line.size()), line.data(), line.data(), kind,
                                      FFTW_ESTIMATE | FFTW_UNALIGNED);
    if (plan == nullptr) throw std::bad_alloc();
    return plan;
}

}  // namespace

struct CosineTransform::Plans {
    fftw_plan forward = nullptr;
    fftw_plan inverse = nullptr;

    Plans() = default;
    Plans(const Plans&) = delete;
    Plans& operator=(const Plans&) = delete;
    ~Plans() {
        const std::lock_guard lock(planner_mutex());
        fftw_destroy_plan(forward);
        fftw_destroy_plan(inverse);
    }
};

CosineTransform::CosineTransform(int length) : length_(length) {
    if (length < 1) throw std::invalid_argument("a cosine transform needs at least one value");
    plans_ = std::make_unique<Plans>();
    std::vector<double> line(static_cast<std::size_t>(length));
    const std::lock_guard lock(planner_mutex());
    plans_->forward = plan_line(line, FFTW_REDFT10);
    plans_->inverse = plan_line(line, FFTW_REDFT01);
}

CosineTransform::~CosineTransform() = default;

void CosineTransform::forward(double* line) const {
    fftw_execute_r2r(plans_->forward, line, line);
}

void CosineTransform::inverse(double* line) const {
    fftw_execute_r2r(plans_->inverse, line, line);
}

}  // namespace uw
