#include "core/image/deep_image.h"

#include "core/base/available_memory.h"

namespace uw {

DeepImage::DeepImage(int width, int height, const PixelWindow& window, int most)
    : width_(width), height_(height), window_(window), most_(most) {
    const double pixels = static_cast<double>(window.width()) * window.height();
    require_memory(pixels * (static_cast<double>(sizeof(std::vector<DeepSample>)) +
                             static_cast<double>(sizeof(DeepSample)) * most),
                   "--deep: its samples may take",
                   "ask for fewer of them, a smaller --size or a --crop");
    pixels_.assign(window.width(), window.height());
}

std::size_t DeepImage::sample_count() const {
    std::size_t count = 0;
    for (const std::vector<DeepSample>& pixel : pixels_.values()) count += pixel.size();
    return count;
}

}  // namespace uw
