#pragma once

#include "downwash/cli/output.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash::cli {

/// @throws UsageError unless this build contains pages
void require_pages();

/// Writes the page of a run beside its other files, if this build contains pages. The run stands without it: an error
/// is reported on standard error, and no page of an earlier run stays.
void write_page(const OutputFolder& folder, const RunRecord& record, int threads);

/// Removes the page of an earlier run.
void remove_page(const OutputFolder& folder);

}  // namespace downwash::cli
