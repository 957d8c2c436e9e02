#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/any_problem.hpp"
#include "downwash/problems/campaign.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash {

/// A campaign and the problems that it names, in the same order.
struct ReadCampaign {
    Campaign campaign;
    std::vector<AnyProblem> problems;
    /// In whose worlds the plans for `problems` are flown, one for each: problems that differ from them in their
    /// uncertainty alone. Empty: `problems` themselves.
    std::vector<AnyProblem> evaluated_in = {};
};

/// Reads a campaign file and its problems, whose paths are relative to it. The result is sound: problems have names of
/// their own, and what is expected is run.
/// @param on_outdated see read_problem()
/// @param on_warning is told of everything that problem_warnings() finds in the problems, of each place once
/// @param further_errors what may not be asked of problems in space
/// @throws ProblemFileError with every error that can be found in one reading, those of the problems included
[[nodiscard]] DOWNWASH_EXPORT ReadCampaign read_campaign(
    const std::filesystem::path& file, const std::function<void(const LocatedError&)>& on_outdated = {},
    const std::function<void(const LocatedError&)>& on_warning = {}, const FurtherSpaceErrors& further_errors = {});

}  // namespace downwash
