#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "downwash/aeromap/aero_map.hpp"

namespace downwash::cli {

/// The page of the run in a folder.
/// @param map of the run's problem, where it is at hand  @param cache folder of aero maps; empty: nowhere
/// @pre has_pages()
[[nodiscard]] std::string page_of(const std::filesystem::path& folder, int threads, std::shared_ptr<const AeroMap> map,
                                  const std::filesystem::path& cache);

}  // namespace downwash::cli
