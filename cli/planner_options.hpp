#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "downwash/problems/problem.hpp"

namespace downwash::cli {

/// Options of the command line that stand for planner settings of the problem file, described by the same table.
class PlannerOptions {
 public:
    /// Adds the options to a command. @pre this object outlives the command's parsing
    void add_to(CLI::App& command);

    /// Writes what was given over the file's settings.
    /// @throws UsageError with every option that is no value for its key or out of range
    void apply(Problem& problem) const;

 private:
    std::map<std::string, std::string> given_;  ///< texts by option
};

}  // namespace downwash::cli
