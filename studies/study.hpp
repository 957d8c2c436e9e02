#pragma once

#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/report/curve_figure.hpp"

namespace downwash::studies {

/// A claim of the thesis beside what was measured here.
struct Finding {
    std::string name = {};      ///< "C1: difference between rotors at 10 deg, 0.1 m"
    std::string thesis = {};    ///< what the thesis says
    std::string measured = {};  ///< what our flights give for it
    bool is_reproduced = false;
    std::string note = {};  ///< over which range, or why not; may be empty
};

/// A picture, as diagrams one below the other.
struct Figure {
    std::string name;  ///< name of its file, without extension
    std::string caption;
    std::vector<CurveFigure> diagrams;
};

/// Numbers as a CSV file and in the page.
struct Table {
    std::string name;  ///< name of its file, without extension
    std::string caption;
    std::vector<std::string> columns;            ///< with units
    std::vector<std::vector<std::string>> rows;  ///< as many cells each
};

/// What a study found.
struct Study {
    std::string name;  ///< name in the command: "ceiling-envelope"
    std::string title;
    std::vector<std::string> setting;  ///< paragraphs: what was simulated, and what the thesis leaves open
    std::vector<Finding> findings;
    std::vector<Figure> figures;
    std::vector<Table> tables;
};

/// `{"study": NAME, "findings": [{"name", "thesis", "measured", "reproduced", "note"}]}`
[[nodiscard]] DOWNWASH_EXPORT std::string json_of(const Study& study);

/// Findings and tables as a page for terminals and repositories.
[[nodiscard]] DOWNWASH_EXPORT std::string markdown_of(const Study& study);

/// All files of a study by name: study.json, study.md, study.html (one page with every picture in it), and a file for
/// each figure (SVG) and table (CSV).
/// @throws PictureError when gnuplot cannot draw
[[nodiscard]] DOWNWASH_EXPORT std::vector<std::pair<std::string, std::string>> files_of(const Study& study);

}  // namespace downwash::studies
