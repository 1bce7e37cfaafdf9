#include "cli/validate/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/image/image_writer.h"

namespace uw {

namespace {

constexpr int k_picture_width = 288;  // of one picture on the page [CSS pixels]

std::string base64(const std::string& bytes) {
    static constexpr const char* k_digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t j = 0; j < 3; ++j)
            group =
                group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j > bytes.size() ? '=' : k_digits[group >> (18 - 6 * j) & 63U];
    }
    return text;
}

}  // namespace

const char* const k_report_style =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;"
    "color:#222}table{border-collapse:collapse;margin:1em 0}td,th{padding:.15em .8em;"
    "border-bottom:1px solid "
    "#ddd;text-align:left}td.n{text-align:right;white-space:nowrap;font-variant-numeric:"
    "tabular-nums}.failed{color:#c00;font-weight:bold}.passed{color:#070}figure{display:"
    "inline-block;margin:0 1em 1em "
    "0;vertical-align:top}figcaption{font-size:13px;max-width:288px}img{image-"
    "rendering:pixelated;display:block;border:1px solid #ccc}";

std::string verdict_html(bool passed) {
    return passed ? "<span class=passed>passed</span>" : "<span class=failed>FAILED</span>";
}

std::string ReportPictures::figure(const Preview& picture, const std::string& caption) const {
    const std::filesystem::path file = folder_.path() / "picture.png";
    write_png(file, picture, {});
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return fmt::format(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        k_picture_width, k_picture_width * picture.height() / std::max(1, picture.width()), caption,
        base64(bytes), caption);
}

}  // namespace uw
