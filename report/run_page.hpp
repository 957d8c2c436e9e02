#pragma once

#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Whether this build brings the pages: they are made from viewer/ where esbuild is installed.
[[nodiscard]] DOWNWASH_EXPORT bool has_pages() noexcept;

/// A run as one HTML file that needs nothing else: scene, flight with playback, plots, search, how to repeat it.
/// Numbers of the flight are those of trajectory.csv to the last bit.
/// @param model of run.problem   @param map of it, shown over the scene; nullptr: none
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string run_page(const RunRecord& run, const FlightModel& model, const AeroMap* map);

/// The data within that page, as JSON (`downwash/report/v1`).
[[nodiscard]] DOWNWASH_EXPORT std::string run_page_data(const RunRecord& run, const FlightModel& model,
                                                        const AeroMap* map);

}  // namespace downwash
