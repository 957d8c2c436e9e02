#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "downwash/bench/campaign_figures.hpp"
#include "downwash/bench/run_figures.hpp"

namespace downwash::bench {

[[nodiscard]] CampaignReport report_of(const CampaignPlan& plan, const std::vector<RunFigures>& runs);

/// The report of what a campaign has left in a folder. It needs some 0.5 kB of memory for a run.
/// @throws CampaignError, DatabaseError as read_runs()
[[nodiscard]] CampaignReport read_report(const std::filesystem::path& folder);

/// The report as a Markdown document.
[[nodiscard]] std::string markdown_of(const CampaignReport& report);

/// The figures of a report as JSON (`downwash/campaign-report/v1`), with those of every seed; null for what is infinite
/// or missing.
[[nodiscard]] std::string json_of(const CampaignReport& report);

/// The figures for a page, which has to stay small: of more than a few thousand seeds and steps it has evenly chosen
/// ones, and `seed_step` says of how many seeds one is there.
[[nodiscard]] std::string page_json_of(const CampaignReport& report);

/// The table of a paper: LaTeX for the package booktabs, a row for every problem and planner.
[[nodiscard]] std::string latex_of(const CampaignReport& report);

/// The figures of every problem and planner as CSV (RFC 4180), empty for what is infinite or missing.
[[nodiscard]] std::string csv_of(const CampaignReport& report);

}  // namespace downwash::bench
