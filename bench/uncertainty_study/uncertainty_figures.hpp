#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "downwash/bench/campaign_report.hpp"
#include "downwash/bench/uncertainty_study/uncertainty_study.hpp"

namespace downwash::bench {

/// One way to plan, on one problem or on all of them together.
struct SetupFigures {
    std::string setting;        ///< as in StudyPart
    std::string setup;          ///< "mp-arm-ada, nominal, margin 0.05 m"
    std::string problem;        ///< empty: all
    std::size_t attempted = 0;  ///< searches
    Share planned;              ///< found a plan that the planner's own model accepts
    bool certifies = false;     ///< as in StudyPart
    WorldsFigures in_worlds;
    /// Reported a plan that fails in at most max_failure_share of the evaluation worlds.
    Share reliable;
    Spread duration_s;        ///< durations of the reported plans' flights in the nominal world, of those that held
    Spread cost_ratio;        ///< these flights' costs over those of the reference setup on the same seed
    std::size_t pairs = 0;    ///< seeds on which both have such a flight
    Spread first_solution_s;  ///< over all searches
};

/// The share of failed flights up to which a plan counts as reliable: the default of planner.max_failure_probability.
inline constexpr double max_failure_share = 0.01;

/// A claim and what the study says about it.
struct Finding {
    std::string name;
    std::optional<double> measured;  ///< empty: nothing to measure it by
    std::string target;              ///< "at most 0.01"
    std::string basis;               ///< what was counted: "3 of 4200 flights of 14 plans"
    bool is_reproduced = false;
};

/// The results of a study so far.
struct StudyFigures {
    std::vector<std::pair<std::string, std::string>> settings;
    std::size_t planned = 0, done = 0;  ///< runs
    std::vector<SetupFigures> setups;   ///< all problems together
    std::vector<SetupFigures> by_problem;
    std::vector<Finding> findings;
};

/// The setup whose costs those of the others are divided by, and whose plans are the nominal ones.
inline constexpr const char* reference_setup = "mp-arm-ada, nominal, margin 0.05 m";

/// @param folder that run_study() wrote to
/// @throws CampaignError, DatabaseError
[[nodiscard]] StudyFigures figures_of(const std::vector<StudyPart>& parts, const std::filesystem::path& folder);

/// The claims that the study can check, from the setups of all problems together.
[[nodiscard]] std::vector<Finding> findings_of(const std::vector<SetupFigures>& all);

/// A page for people.
[[nodiscard]] std::string markdown_of(const StudyFigures& figures);

/// `{"study": "uncertainty", "findings": [{"name", "thesis", "measured", "reproduced", ...}], ...}`
[[nodiscard]] std::string json_of(const StudyFigures& figures);

}  // namespace downwash::bench
