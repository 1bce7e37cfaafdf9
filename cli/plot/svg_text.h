#pragma once

#include <string>
#include <vector>

namespace uw {

/// `text` as content of an XML element or attribute; bytes that are not valid UTF-8 become '?'.
std::string xml_escaped(std::string text);

/// Width of a line of UTF-8 text in a sans-serif font of size `font`, in the unit of `font`: an
/// upper estimate, as the viewer's font is not known.
double text_width(const std::string& text, double font);

/// `text` broken at spaces into lines of at most `width`, measured by text_width; all but the first
/// are indented. A longer word has a line of its own.
std::vector<std::string> wrapped_lines(const std::string& text, double width, double font);

}  // namespace uw
