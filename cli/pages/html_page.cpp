#include "cli/pages/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/report.h"
#include "core/base/input_files.h"
#include "core/image/image_file.h"

namespace uw {

namespace {

constexpr int k_picture_width = 288;  // of one picture on a page [CSS pixels]

constexpr const char* k_page_style =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;"
    "color:#222}table{border-collapse:collapse;margin:1em 0}td,th{padding:.15em .8em;"
    "border-bottom:1px solid "
    "#ddd;text-align:left}td.n{text-align:right;white-space:nowrap;font-variant-numeric:"
    "tabular-nums}.failed{color:#c00;font-weight:bold}.passed{color:#070}figure{display:"
    "inline-block;margin:0 1em 1em "
    "0;vertical-align:top}figcaption{font-size:13px;max-width:288px}img{image-"
    "rendering:pixelated;display:block;border:1px solid "
    "#ccc}img.plot{border:0;max-width:100%;image-rendering:auto}"
    "th.n{text-align:right}"
    "pre{white-space:pre-wrap;font-size:13px;background:#f6f6f6;padding:.6em .8em}";

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

constexpr const char* k_not_compared = "not compared";

}  // namespace

std::string verdict_html(bool passed) {
    return passed ? "<span class=passed>passed</span>" : "<span class=failed>FAILED</span>";
}

std::string ReportTable::text(bool colour) const {
    std::vector<std::vector<std::string>> cells{headings};
    for (const Row& row : rows) cells.push_back(row.cells);
    const std::vector<std::string> lines = aligned_rows(cells, names);
    std::string text = "  " + lines[0] + "\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool failed = rows[i].verdict == Verdict::failed;
        std::string line = "  " + lines[1 + i];
        if (failed) line += "  FAILED";
        if (rows[i].verdict == Verdict::passed) line += "  passed";
        if (rows[i].verdict == Verdict::not_compared) line += fmt::format("  {}", k_not_compared);
        text += colour && failed ? "\033[31m" + line + "\033[0m\n" : line + "\n";
    }
    return text;
}

std::string ReportTable::html() const {
    std::string html = "<table><tr>";
    for (std::size_t i = 0; i < headings.size(); ++i)
        html += (i < names ? "<th>" : "<th class=n>") + xml_escaped(headings[i]) + "</th>";
    if (!rows.empty() && rows.front().verdict != Verdict::none) html += "<th></th>";
    html += "</tr>\n";
    for (const Row& row : rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            html += (i < names ? "<td>" : "<td class=n>") + xml_escaped(row.cells[i]) + "</td>";
        if (row.verdict == Verdict::not_compared)
            html += fmt::format("<td>{}</td>", k_not_compared);
        else if (row.verdict != Verdict::none)
            html += "<td>" + verdict_html(row.verdict == Verdict::passed) + "</td>";
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string HtmlPictures::figure(const Preview& picture, const std::string& caption) const {
    const std::filesystem::path file = folder_.path() / "picture.png";
    write_png(file, picture, {});
    std::ifstream in = open_own_file(file);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return fmt::format(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        k_picture_width, k_picture_width * picture.height() / std::max(1, picture.width()),
        xml_escaped(caption), base64(bytes), xml_escaped(caption));
}

std::string plot_html(const PlotFigure& plot) {
    return fmt::format("<p><img class=plot alt=\"{}\" src=\"data:image/svg+xml;base64,{}\"></p>\n",
                       xml_escaped(plot.title.empty() ? "plot" : plot.title),
                       base64(svg_document(plot)));
}

std::string html_page(const std::string& title, const std::string& body) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>"
        "<style>{1}</style></head><body>\n<h1>{0}</h1>\n{2}</body></html>\n",
        xml_escaped(title), k_page_style, body);
}

}  // namespace uw
