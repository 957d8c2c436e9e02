#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "downwash/problems/problem.hpp"

namespace downwash::cli {

/// Options that override planner settings of the problem file. The table of parameters describes and checks both.
class PlannerOptions {
 public:
    /// Adds the options to a command. @pre this object outlives the command's parsing
    void add_to(CLI::App& command);

    /// Overrides the settings of the file with the options that were given.
    /// @throws UsageError with every option whose value is invalid or out of range
    void apply(Problem& problem) const;

 private:
    std::map<std::string, std::string> given_;  ///< texts by option
};

}  // namespace downwash::cli
