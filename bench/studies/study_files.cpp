#include "downwash/studies/study_files.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "downwash/base/csv_cell.hpp"
#include "downwash/base/text.hpp"
#include "downwash/studies/study_page.hpp"

namespace downwash::studies {
namespace {

std::string csv_row(const std::vector<std::string>& cells) {
    return joined(cells, ",", csv_cell) + "\n";
}

std::string csv_of(const Table& table) {
    std::string text = csv_row(table.columns);
    for (const std::vector<std::string>& row : table.rows) {
        text += csv_row(row);
    }
    return text;
}

std::string markdown_row(const std::vector<std::string>& cells) {
    return "| " + joined(cells, " | ") + " |\n";
}

}  // namespace

std::string json_of(const Study& study) {
    nlohmann::ordered_json json = {{"study", study.name}, {"title", study.title}};
    json["findings"] = nlohmann::ordered_json::array();
    for (const Finding& finding : study.findings) {
        json["findings"].push_back({{"name", finding.name},
                                    {"thesis", finding.thesis},
                                    {"measured", finding.measured},
                                    {"reproduced", finding.is_reproduced},
                                    {"note", finding.note}});
    }
    return json.dump(2);
}

std::string markdown_of(const Study& study) {
    std::string text = fmt::format("# {}\n\n", study.title);
    for (const std::string& paragraph : study.setting) {
        text += paragraph + "\n\n";
    }
    text += "| | thesis | here | reproduced |\n| --- | --- | --- | --- |\n";
    for (const Finding& f : study.findings) {
        text += markdown_row({f.name, f.thesis, f.note.empty() ? f.measured : f.measured + " (" + f.note + ")",
                              f.is_reproduced ? "yes" : "no"});
    }
    for (const Table& table : study.tables) {
        text += fmt::format("\n**{}** (`{}.csv`)\n\n", table.caption, table.name);
        text += markdown_row(table.columns);
        text += markdown_row(std::vector<std::string>(table.columns.size(), "---"));
        for (const std::vector<std::string>& row : table.rows) {
            text += markdown_row(row);
        }
    }
    return text;
}

std::vector<std::pair<std::string, std::string>> files_of(const Study& study) {
    std::vector<std::pair<std::string, std::string>> files{{"study.json", json_of(study) + "\n"},
                                                           {"study.md", markdown_of(study)}};
    std::vector<std::string> pictures;
    for (const Figure& figure : study.figures) {
        pictures.push_back(draw(figure.diagrams, PictureSettings{}));
        files.emplace_back(figure.name + ".svg", pictures.back());
    }
    for (const Table& table : study.tables) {
        files.emplace_back(table.name + ".csv", csv_of(table));
    }
    files.emplace_back("study.html", page_of(study, pictures));
    return files;
}

}  // namespace downwash::studies
