#pragma once

#include <cstddef>
#include <string>

#include "core/json/json.h"
#include "dataset/definition.h"
#include "dataset/view_record.h"

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

}  // namespace uw
