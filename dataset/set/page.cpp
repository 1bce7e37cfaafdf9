#include "dataset/set/page.h"

#include <fmt/format.h>

namespace uw {

namespace {

std::string html_text(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

constexpr const char* k_page_head =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n<style>\n"
    "body {{ font: 15px/1.5 sans-serif; margin: 2em; background: #101418; color: #dde; }}\n"
    "a {{ color: #8cf; }}\n"
    "main {{ display: flex; flex-wrap: wrap; gap: 12px; }}\n"
    "figure {{ margin: 0; }}\n"
    "figure img {{ width: 320px; display: block; background: #000; }}\n"
    "figcaption {{ font-size: 13px; color: #9ab; }}\n"
    "</style>\n</head>\n<body>\n<h1>{0}</h1>\n";

}  // namespace

std::string dataset_page(const DatasetDefinition& definition, const std::vector<PageView>& views) {
    std::string page = fmt::format(k_page_head, html_text("Data set of " + definition.scene));
    page += fmt::format("<p>{} views", definition.view_count());
    if (views.size() < definition.view_count())
        page += fmt::format(", {} of them here", views.size());
    page +=
        ". <a href=\"README.md\">data card</a>, <a href=\"manifest.csv\">manifest</a>, "
        "<a href=\"SHA256SUMS\">checksums</a></p>\n";
    page += fmt::format("<p><code>{}</code></p>\n<main>\n", html_text(definition.command));
    for (const PageView& view : views) {
        page += "<figure>";
        for (const std::string& picture : view.pictures)
            page +=
                fmt::format("<a href=\"{0}\"><img src=\"{0}\" loading=\"lazy\" alt=\"{1}\"></a>",
                            html_text(picture), html_text(view.label));
        page += fmt::format("<figcaption>{}</figcaption></figure>\n", html_text(view.label));
    }
    return page + "</main>\n</body>\n</html>\n";
}

}  // namespace uw
