#pragma once

#include <string>
#include <vector>

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
    std::vector<std::string> columns;            ///< names of the columns, with units
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

}  // namespace downwash::studies
