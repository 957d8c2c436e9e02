#pragma once

#include <filesystem>

#include "downwash/results/run_record.hpp"

namespace downwash::cli {

/// @throws UsageError unless this build contains pages
void require_pages();

/// Writes the page of a run beside its other files, if this build contains pages. The run stands without it: an error
/// is reported on standard error.
void write_page(const std::filesystem::path& folder, const RunRecord& record, int threads);
/// The same of a flight in space.
void write_page(const std::filesystem::path& folder, const SpaceRunRecord& record);

}  // namespace downwash::cli
