#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "dataset/definition.h"
#include "dataset/view.h"

namespace uw {

/// The list of a set's views, row by row, as CSV and JSON lines of one array.
class Manifest {
  public:
    explicit Manifest(const DatasetDefinition& definition);

    void add(const ViewRecord& record);

    const std::string& csv() const { return csv_; }
    /// Of all views added.
    std::string json() const;

  private:
    const DatasetDefinition& definition_;
    std::string csv_;
    std::string views_;  // of JSON, separated by commas
};

/// What a page shows of a view.
struct PageView {
    std::string label;                  // "frame 12, left"
    std::vector<std::string> pictures;  // files relative to the set's folder
};

/// A page with the pictures of a set, HTML that needs nothing but the files beside it.
std::string dataset_page(const DatasetDefinition& definition, const std::vector<PageView>& views);

/// Receives the share of the work that is done (0..1); returns false to stop.
using CompletionProgress = std::function<bool(double share)>;

/// Writes what a set has once all of its views are there: the tables of its formats, manifest, data
/// card, contact sheet, page and checksums; and removes what processes that were killed have left.
/// What it writes depends on the set alone, not on how its views were made. With `check` the
/// checksums of all views' files are computed again. Throws InputError that names the frames which
/// are missing or damaged; IoError; Interrupted.
void complete_dataset(const std::filesystem::path& folder, const DatasetFile& set, bool check,
                      const CompletionProgress& progress);

}  // namespace uw
