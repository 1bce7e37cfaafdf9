#include "tests/support/image_file.h"

#include <dlfcn.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/file_bytes.h"
#include "tests/support/temp_dir.h"

namespace uw::test {
namespace {

template <typename Function>
Function* loaded(const char* name) {
    void* const module = dlopen(UWVDB_TEST_IMAGES, RTLD_LAZY | RTLD_LOCAL);
    void* const address = module != nullptr ? dlsym(module, name) : nullptr;
    if (address == nullptr) throw std::runtime_error(dlerror());
    return reinterpret_cast<Function*>(address);
}

}  // namespace

ImageFile read_exr(const std::filesystem::path& file) {
    ImageFile image;
    loaded<ReadImageFunction>("uwvdb_test_read_image")(file, image);
    return image;
}

std::vector<std::uint16_t> numbers_of(const ImageFile& image, int bits) {
    std::vector<std::uint16_t> numbers;
    const auto largest = static_cast<float>((1 << bits) - 1);
    const std::size_t pixels = image.channels.at(image.names.at(0)).size();
    for (std::size_t i = 0; i < pixels; ++i)
        for (const std::string& name : image.names)
            numbers.push_back(
                static_cast<std::uint16_t>(std::lround(largest * image.channels.at(name)[i])));
    return numbers;
}

std::string encoded_image(const std::string& extension, int width, int height, int channels,
                          const std::vector<int>& values, int bits) {
    const TempDir folder;
    const std::filesystem::path file = folder.path() / ("image." + extension);
    loaded<WriteImageFunction>("uwvdb_test_write_image")(file, width, height, channels, values,
                                                         bits);
    return file_bytes(file);
}

}  // namespace uw::test
