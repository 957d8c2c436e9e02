#pragma once

#include <string>

#include "downwash/base/export.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// A problem before it is planned as one self-contained HTML file: the page of a run without a flight. The vehicle
/// stands at its start, in the plane and in three dimensions.
/// @param reference what solution.json would say of the problem: its file, warnings, and what was read
/// @param text effective.yaml   @param model of the problem   @param threads at least 1; the page does not depend on it
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string problem_page(const Problem& problem, const ProblemReference& reference,
                                                       const std::string& text, const FlightModel& model,
                                                       int threads = 1);

/// The data within that page, as JSON (`downwash/report/v1`). The status of its solution is "unplanned".
[[nodiscard]] DOWNWASH_EXPORT std::string problem_page_data(const Problem& problem, const ProblemReference& reference,
                                                            const std::string& text, const FlightModel& model,
                                                            int threads = 1);

}  // namespace downwash
