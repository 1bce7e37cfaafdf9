#include "dataset/set/dataset_file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr int k_dataset_version = 1;

/// Whether there is anything in the folder but what AtomicFile left when it was killed.
bool has_files(const fs::path& folder) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (!entry.path().filename().string().starts_with(".uwvdb-")) return true;
    return false;
}

}  // namespace

std::string dataset_text(const DatasetFile& file) {
    return json_text({{"uwvdb_dataset", k_dataset_version},
                      {"set", definition_json(file.definition)},
                      {"exposure", file.exposures.image},
                      {"clean_exposure", file.exposures.clean},
                      {"facts", file.facts}});
}

std::optional<DatasetFile> read_dataset_file(const fs::path& folder) {
    const fs::path name = folder / k_dataset_file;
    const std::string shown = printable(name.string(), 300);
    std::ifstream in(name, std::ios::binary);
    if (!in) {
        if (has_files(folder))
            throw UsageError(fmt::format(
                "-o {}: the folder has other files, and no data set to continue; give an empty one",
                printable(folder.string(), 300)));
        return std::nullopt;
    }
    try {
        const Json json = Json::parse(in);
        if (json.at("uwvdb_dataset") != k_dataset_version)
            throw InputError(shown + ": is of another version of uwvdb; give another folder");
        return DatasetFile{
            definition_from_json(json.at("set"), shown),
            {json.at("exposure").get<double>(), json.at("clean_exposure").get<double>()},
            json.at("facts")};
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: is not the description of a data set: {}", shown,
                                     printable(error.what(), 200)));
    }
}

void check_same_set(const fs::path& folder, const DatasetDefinition& there,
                    const DatasetDefinition& wanted) {
    const std::string what = difference(there, wanted);
    if (!what.empty())
        throw UsageError(fmt::format(
            "-o {}: holds another data set: {}; give the same options to continue it, or another "
            "folder",
            printable(folder.string(), 300), what));
}

}  // namespace uw
