#include "downwash/studies/study_page.hpp"

#include <fmt/core.h>

namespace downwash::studies {
namespace {

// Colours and measures of the pages in apps/viewer/, without their scripts: a study has nothing to move.
constexpr const char* style = R"(
:root{color-scheme:light;--paper:#fff;--ground:#f6f7f8;--ink:#1b2026;--muted:#5b6670;--rule:#dfe3e7;--good:#006b4f;--bad:#b3261e}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
main{max-width:1080px;margin:0 auto;padding:24px 16px 48px;background:var(--paper)}
h1{font-size:24px;line-height:1.25;margin:0 0 12px}
h2{font-size:18px;margin:32px 0 8px}
p{max-width:70ch;margin:0 0 12px}
figure{margin:24px 0;overflow-x:auto}
figure svg{display:block;width:100%;min-width:620px;height:auto}
figcaption,caption{color:var(--muted);text-align:left;padding:6px 0;max-width:80ch}
.scroll{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;vertical-align:top;padding:6px 12px 6px 0;border-bottom:1px solid var(--rule)}
th{color:var(--muted);font-weight:600}
.yes{color:var(--good);font-weight:600}
.no{color:var(--bad);font-weight:600}
.note{color:var(--muted)}
@media print{body{background:var(--paper)}figure,tr{break-inside:avoid}}
)";

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

std::string cell(const std::string& tag, const std::string& text) {
    return "<" + tag + ">" + escaped(text) + "</" + tag + ">";
}

/// The drawing alone: a page allows no XML declaration inside.
std::string drawing_in(const std::string& picture) {
    const std::size_t begin = picture.find("<svg");
    return begin == std::string::npos ? std::string() : picture.substr(begin);
}

std::string findings_of(const Study& study) {
    std::string text =
        "<div "
        "class=\"scroll\"><table><thead><tr><th></th><th>thesis</th><th>here</th><th>reproduced</th></tr></"
        "thead><tbody>";
    for (const Finding& f : study.findings) {
        const std::string note = f.note.empty() ? "" : "<div class=\"note\">" + escaped(f.note) + "</div>";
        text += "<tr>" + cell("td", f.name) + cell("td", f.thesis) + "<td>" + escaped(f.measured) + note + "</td>" +
                (f.is_reproduced ? "<td class=\"yes\">yes</td>" : "<td class=\"no\">no</td>") + "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

std::string table_of(const Table& table) {
    std::string text = "<div class=\"scroll\"><table>" + cell("caption", table.caption) + "<thead><tr>";
    for (const std::string& column : table.columns) {
        text += cell("th", column);
    }
    text += "</tr></thead><tbody>";
    for (const std::vector<std::string>& row : table.rows) {
        text += "<tr>";
        for (const std::string& value : row) {
            text += cell("td", value);
        }
        text += "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

}  // namespace

std::string page_of(const Study& study, const std::vector<std::string>& pictures) {
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\"><title>{}</title><style>{}</style></head><body><main>\n<h1>{}</h1>\n",
        escaped(study.title), style, escaped(study.title));
    for (const std::string& paragraph : study.setting) {
        page += cell("p", paragraph) + "\n";
    }
    page += "<h2>Findings</h2>\n" + findings_of(study);
    if (!study.figures.empty()) {
        page += "<h2>Figures</h2>\n";
    }
    for (std::size_t i = 0; i < study.figures.size(); ++i) {
        page += "<figure>" + drawing_in(pictures[i]) + cell("figcaption", study.figures[i].caption) + "</figure>\n";
    }
    if (!study.tables.empty()) {
        page += "<h2>Numbers</h2>\n";
    }
    for (const Table& table : study.tables) {
        page += table_of(table);
    }
    return page + "</main></body></html>\n";
}

}  // namespace downwash::studies
