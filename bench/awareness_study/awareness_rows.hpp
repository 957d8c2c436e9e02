#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "downwash/bench/awareness_study/awareness_cells.hpp"
#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// The flight of a plan with direct aerodynamics in the nominal world.
struct ExecutedFlight {
    Outcome outcome = Outcome::ok;
    double cost = 0;
    double min_clearance_m = 0;  ///< infinite without obstacles
    double duration_s = 0;

    bool operator==(const ExecutedFlight&) const = default;
};

/// The flights of a plan in fresh worlds.
struct FreshFlights {
    std::uint64_t worlds = 0;
    std::uint64_t failures = 0;

    bool operator==(const FreshFlights&) const = default;
};

/// What a run of the study left: one line of its file.
struct AwarenessRow {
    Condition condition;
    std::string problem;  ///< name of the problem
    std::uint32_t seed = 1;
    std::string hash;    ///< of what was run: see run_hash()
    std::string commit;  ///< that the program was made from
    RunStatus status = RunStatus::none;
    std::string error;                         ///< why it is impossible or failed
    double wall_s = 0;                         ///< of the search with the flight of its plan
    double evaluation_s = 0;                   ///< of the flights in worlds
    std::optional<double> first_candidate_s;   ///< from the parsed problem to the first plan that the model accepts
    std::optional<double> first_certified_s;   ///< likewise to the first plan with a certificate
    std::optional<CertificateFigures> tested;  ///< certificate of the plan: given or not
    std::uint64_t discarded = 0;               ///< plans whose executed flight failed
    std::optional<double> planned_cost;        ///< cost of the plan by the planner's own figure
    std::optional<ExecutedFlight> executed;    ///< of the plan that counts
    std::optional<FreshFlights> fresh;         ///< likewise
    std::optional<double> nearest_approach_m;  ///< how near a search without a plan came to the goal
    std::string missed;                        ///< what stopped a search without a plan; empty where nothing is known

    /// Whether there is a plan that counts: a first candidate, or a plan that is reported.
    [[nodiscard]] bool has_plan() const { return status == RunStatus::solved; }
    [[nodiscard]] bool holds() const { return has_plan() && executed && executed->outcome == Outcome::ok; }

    bool operator==(const AwarenessRow&) const = default;
};

/// "reported mp-arm-ada certified checked own 1 s/bridge_inspection/7": unique among runs.
[[nodiscard]] std::string key_of(const Condition& condition, const std::string& problem, std::uint32_t seed);

/// One line of JSON, without its end.
[[nodiscard]] std::string line_of(const AwarenessRow& row);

/// The row of such a line; empty if it is none: cut off when its program was killed, or of another version.
[[nodiscard]] std::optional<AwarenessRow> row_of(const std::string& line);

/// The file of a study's rows. Several programs may add to it at a time.
class AwarenessRows {
 public:
    explicit AwarenessRows(std::filesystem::path file) : file_(std::move(file)) {}

    /// All rows that can be read, in the order in which they were written. None without a file.
    /// @throws InputError when the file cannot be read
    [[nodiscard]] std::vector<AwarenessRow> read() const;

    /// Appends a row in one piece. Safe to call from several threads. @throws InputError when that fails
    void add(const AwarenessRow& row);

 private:
    std::filesystem::path file_;
    std::mutex mutex_;
};

}  // namespace downwash::bench
