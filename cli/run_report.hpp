#pragma once

#include <filesystem>
#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// A run with what it takes to show it.
struct ShownRun {
    RunRecord record;
    std::shared_ptr<const FlightModel> model;
    std::shared_ptr<const AeroMap> map;  ///< empty without surface effects
};

/// Completes a run that was read from its folder or is still in memory.
/// @param map of the run's problem, if it is at hand; otherwise it is built   @param cache folder of aero maps; empty:
/// none   @param is_quiet whether to keep silent while a map is built
[[nodiscard]] ShownRun shown_run(RunRecord record, std::shared_ptr<const AeroMap> map,
                                 const std::filesystem::path& cache, bool is_quiet = false,
                                 int threads = default_threads());

/// The aero map of a problem for its page: from the cache, or built. Empty without surface effects.
[[nodiscard]] std::shared_ptr<const AeroMap> map_for_page(const Problem& problem, const FlightModel& model,
                                                          const std::filesystem::path& cache, bool is_quiet,
                                                          int threads = default_threads());

/// @throws UsageError unless this build contains pages
void require_pages();

/// Writes the page of a run beside its other files, if this build contains pages. The run stands without it: an error
/// is reported on standard error. The parameters are those of shown_run().
void write_page(const std::filesystem::path& folder, const RunRecord& record, std::shared_ptr<const AeroMap> map,
                const std::filesystem::path& cache, bool is_quiet = false, int threads = default_threads());

}  // namespace downwash::cli
