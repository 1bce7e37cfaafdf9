#pragma once

#include <string>
#include <vector>

#include "dataset/definition.h"

namespace uw {

/// What a page shows of a view.
struct PageView {
    std::string label;                  // "frame 12, left"
    std::vector<std::string> pictures;  // files relative to the set's folder
};

/// A page with the pictures of a set, HTML that needs nothing but the files beside it.
std::string dataset_page(const DatasetDefinition& definition, const std::vector<PageView>& views);

}  // namespace uw
