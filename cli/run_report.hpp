#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/problems/run_record.hpp"
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
[[nodiscard]] ShownRun shown_run(const std::filesystem::path& folder, int threads, std::shared_ptr<const AeroMap> map,
                                 const std::filesystem::path& cache);

/// The page of the run in a folder. @pre has_pages()
[[nodiscard]] std::string page_of(const ShownRun& run);

}  // namespace downwash::cli
