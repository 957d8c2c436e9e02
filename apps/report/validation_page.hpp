#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/results/number_table.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// A flight of a judge, to be played on a page.
struct PlayableFlight {
    std::optional<std::uint64_t> world;  ///< empty: the nominal one
    std::string outcome;
    /// One row per control tick: t_s, ref_x_m, ref_z_m, ref_arm_rad, x_m, z_m, pitch_rad, arm_rad, vx_m_s, vz_m_s,
    /// clearance_m, ee_x_m, ee_z_m, energy_j. A clearance without obstacles is NaN.
    NumberTable rows;
    double scene_x_m = 0, scene_z_m = 0;  ///< where this world has the obstacles, from where the problem has them
    double lateral_m = 0;                 ///< how far the vehicle is to the left of where they have its plane
};

/// Clearance [m] over many flights, step by step; see docs/validation.md.
struct ClearanceOverTime {
    double step_s = 0;
    std::vector<double> minimum, p01, p10, p50;
};

/// What the page of a validation shows.
struct ValidationRecord {
    std::string findings;  ///< JSON that `validate --json` prints
    bool is_valid = false;
    bool has_flight_claims = false;  ///< the file says something about a flight
    std::string solution_text;       ///< the file that was judged, JSON
    std::uint64_t seed = 0;          ///< seed of the worlds
    std::string command;             ///< command that made the page
    std::optional<ClearanceOverTime> clearance;
    std::vector<PlayableFlight> flights;  ///< the judge's own first, then the worst ones
};

/// A validation as one self-contained HTML file: verdict, flights with playback, clearance over time, what matters.
/// @param model of the problem   @param threads at least 1; the page does not depend on it
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string validation_page(const ValidationRecord& validation, const Problem& problem,
                                                          const FlightModel& model, int threads = 1);

/// The data within that page, as JSON (`downwash/validation-report/v1`).
[[nodiscard]] DOWNWASH_EXPORT std::string validation_page_data(const ValidationRecord& validation,
                                                               const Problem& problem, const FlightModel& model,
                                                               int threads = 1);

}  // namespace downwash
