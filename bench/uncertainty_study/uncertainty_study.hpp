#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/bench/campaign_run.hpp"

namespace downwash::bench {

/// How large a study of uncertainty is.
struct StudySettings {
    std::vector<AnyProblem> problems;   ///< each with an uncertainty
    std::uint64_t seeds = 20;           ///< 1 to `seeds`
    double time_limit_s = 5;            ///< time limit of one search
    std::uint64_t worlds = 300;         ///< in which every reported plan is flown
    std::optional<std::uint64_t> jobs;  ///< searches at a time; empty: one per processor
};

/// A campaign of the study: what its planners assume, and in whose worlds their plans are flown.
struct StudyPart {
    std::string name;     ///< name of its folder: "worlds_8"
    std::string setting;  ///< what is uncertain where plans are flown: "problem's own", "CAMP's"
    std::string assumed;  ///< "nominal", "one pessimistic world", "8 worlds"
    /// Certificates are about the worlds in which the plans are flown.
    bool certifies = false;
    ReadCampaign read;
};

/// What is uncertain in the quadrotor experiments of CAMP: mass 7 %, centre of mass 3 cm, inertia 10 %, read as
/// standard deviations; nothing else.
[[nodiscard]] Uncertainty camp_uncertainty();

/// One pessimistic world and no other: suction 40 % stronger, surfaces 4 cm lower, the rotors' lag 1.5 times as long.
[[nodiscard]] Uncertainty pessimistic_world();

/// The campaigns that compare
/// - the three variants planning for the nominal world, with margins from 0.05 to 0.4 m;
/// - mp-arm-ada in the nominal and one pessimistic world, with a margin of 0.1 m;
/// - mp-arm-ada in 2, 4, 8 and 16 worlds;
/// - in the nominal world and in 20 worlds where only what CAMP varies is uncertain.
[[nodiscard]] std::vector<StudyPart> parts_of(const StudySettings& settings);

/// Runs what is missing of a study, each part in a folder of its own below options.out.
/// @throws CampaignError, DatabaseError
CampaignProgress run_study(const std::vector<StudyPart>& parts, const CampaignRunOptions& options);

}  // namespace downwash::bench
