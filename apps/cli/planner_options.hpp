#pragma once

#include <map>
#include <string>
#include <string_view>

#include "downwash/cli/command_line.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"

namespace downwash::cli {

/// Options that override planner settings of a problem file. The table of parameters describes and checks them.
class PlannerOptions {
 public:
    /// Adds the option of a key: --margin for "planner.safety_margin_m".
    /// @pre the key has one; this object stays where it is as long as the command
    void add(Command command, std::string_view key);
    /// Adds those of a command that searches.
    void add_of_search(Command command);

    /// Overrides the settings of the file with the options that were given.
    /// @throws UsageError with every option whose value is invalid or out of range
    void apply_to(Problem& problem) const;
    void apply_to(SpaceProblem& problem) const;
    /// Whether any was given.
    [[nodiscard]] bool is_any() const noexcept { return !given_.empty(); }

 private:
    std::map<std::string_view, std::string> given_;  ///< texts by keys
};

}  // namespace downwash::cli
