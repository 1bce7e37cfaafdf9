#pragma once

#include <span>
#include <string_view>

#include "dataset/formats/format.h"

namespace uw {

/// Every format, in the order in which --help lists them.
std::span<const DatasetFormat> dataset_formats();

/// The format of a name. Throws UsageError that lists those there are.
const DatasetFormat& dataset_format(std::string_view name);

}  // namespace uw
