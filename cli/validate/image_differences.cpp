#include "cli/validate/image_differences.h"

#include <algorithm>
#include <cmath>

namespace uw {

double mean_over_pixels(const std::vector<Spectrum>& image, std::size_t band) {
    double sum = 0;
    for (const Spectrum& pixel : image) sum += pixel[band];
    return sum / static_cast<double>(image.size());
}

double largest_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                          const std::vector<char>& counted, std::size_t band, double dark) {
    const double floor = dark * mean_over_pixels(b, band);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(a[i][band] - b[i][band]);
        if (counted[i] != 0 && difference > 0)
            largest = std::max(largest, difference / std::max(b[i][band], floor));
    }
    return largest;
}

double rms_difference(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                      std::size_t band) {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += (a[i][band] - b[i][band]) * (a[i][band] - b[i][band]);
    const double mean = mean_over_pixels(b, band);
    return squares == 0 ? 0 : std::sqrt(squares / static_cast<double>(a.size())) / mean;
}

}  // namespace uw
