#pragma once

#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Whether this build brings the pages, which need esbuild at build time.
[[nodiscard]] DOWNWASH_EXPORT bool has_pages() noexcept;

/// A run as one self-contained HTML file: scene, flight with playback, plots, search, and how to repeat the run.
/// The numbers of the flight equal those of trajectory.csv to the last bit.
/// @param model of run.problem   @param threads at least 1; the page does not depend on it
/// @pre has_pages()
[[nodiscard]] DOWNWASH_EXPORT std::string run_page(const RunRecord& run, const FlightModel& model, int threads = 1);

/// The data within that page, as JSON (`downwash/report/v1`).
[[nodiscard]] DOWNWASH_EXPORT std::string run_page_data(const RunRecord& run, const FlightModel& model,
                                                        int threads = 1);

}  // namespace downwash
