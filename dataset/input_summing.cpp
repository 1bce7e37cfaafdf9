#include "dataset/input_summing.h"

#include <vector>

#include "core/base/parallel.h"
#include "dataset/set_files.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// A file's name that is the same in sets made elsewhere: relative to the scene's folder.
std::string name_of_input(const fs::path& file, const fs::path& scene) {
    const auto whole = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
    return whole(file).lexically_relative(whole(scene).parent_path()).generic_string();
}

}  // namespace

InputSums InputSummer::sums_of(const SceneDesc& whole, const ImageChoice& choice) {
    InputSums sums;
    std::vector<std::pair<std::string, fs::path>> files;
    for (const InputFile& input : input_files(whole, choice, side_files_)) {
        // A folder or a device that a key names is rejected by its reader.
        std::error_code error;
        if (input.is_hashed || !fs::is_regular_file(input.file, error)) continue;
        std::string name = name_of_input(input.file, whole.file);
        if (sums.try_emplace(name).second) files.emplace_back(std::move(name), input.file);
    }
    std::vector<Known> found(files.size());
    parallel_for(files.size(), [&](std::size_t i) {
        const fs::path& file = files[i].second;
        found[i].stamp = stamp_of(file);
        const auto known = known_.find(file);
        found[i].sum = known != known_.end() && known->second.stamp == found[i].stamp
                           ? known->second.sum
                           : sha256_of_file(file);
    });
    for (std::size_t i = 0; i < files.size(); ++i) {
        sums[files[i].first] = found[i].sum;
        known_[files[i].second] = std::move(found[i]);
    }
    return sums;
}

}  // namespace uw
