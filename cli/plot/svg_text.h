#pragma once

#include <string>
#include <vector>

namespace uw {

/// `text` as content of an XML element or attribute; bytes that are no text become '?'.
std::string xml_escaped(std::string text);

/// Width of a line of UTF-8 text in a sans-serif font of size `font`, in its unit: an upper
/// estimate, as the font that a reader's program chooses is not known.
double text_width(const std::string& text, double font);

/// `text` broken at spaces into lines of at most `width`, as text_width has it; all but the first
/// are indented. A longer word stands alone.
std::vector<std::string> wrapped_lines(const std::string& text, double width, double font);

}  // namespace uw
