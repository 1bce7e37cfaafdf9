#pragma once

#include "edit/document/yaml_source.h"

namespace uw {

/// Hands on the anchors of all values on the way to `route`, and of all below it if
/// `with_all_below`, that aliases elsewhere stand for: the first alias becomes the anchor, with the
/// value as it is now. A change there then changes nothing else. The document means the same.
void release_anchors(YamlSource& source, const NodeRoute& route, bool with_all_below);

}  // namespace uw
