#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/cli/output_folder.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {

/// A run with what it takes to show it.
struct ShownRun {
    RunRecord record;
    std::shared_ptr<const FlightModel> model;
    std::shared_ptr<const AeroMap> map;  ///< empty without surface effects
};

/// Reads the run in a folder.
/// @param map of the run's problem, where it is at hand  @param cache folder of aero maps; empty: nowhere
/// @param is_quiet whether to keep silent while a map is built
[[nodiscard]] ShownRun shown_run(const std::filesystem::path& folder, std::shared_ptr<const AeroMap> map,
                                 const std::filesystem::path& cache, bool is_quiet = false);

/// @throws UsageError unless this build brings pages
void require_pages();

/// The page of a run. @pre has_pages()
[[nodiscard]] std::string page_of(const ShownRun& run);

/// Writes the page of the run in a folder beside its other files, if this build brings pages. A run stands without it:
/// what goes wrong is said on standard error, and no page of an earlier run stays.
void write_page(const OutputFolder& folder, std::shared_ptr<const AeroMap> map, const std::filesystem::path& cache,
                bool is_quiet = false);

}  // namespace downwash::cli
