#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "downwash/bench/awareness_study/awareness_cells.hpp"
#include "downwash/bench/awareness_study/awareness_rows.hpp"

namespace downwash::bench {

/// Name of the file of rows in the folder of the study.
inline constexpr const char* awareness_rows_file = "runs.jsonl";

/// How to run the study.
struct AwarenessRunOptions {
    std::filesystem::path out;                ///< folder of the results; it is there
    TaskShare share;                          ///< which runs are ours
    std::optional<std::uint64_t> jobs;        ///< searches at a time, one thread each; empty: one per processor
    std::vector<std::string> same_as;         ///< other commits whose rows are kept: their plans are the same
    std::filesystem::path map_cache;          ///< folder in which aero maps are kept between runs; empty: nowhere
    std::stop_token stop;                     ///< ends the study; an interrupted search is not kept
    std::function<void(double)> on_progress;  ///< share of our runs that is done; called from the calling thread
};

/// What a run depends on apart from its seed and the commit of the program, as SHA-256: another hash, another run.
/// @param worlds in which the plan is flown
[[nodiscard]] std::string run_hash(const AwarenessSettings& settings, const AwarenessTask& task, std::uint64_t worlds);

/// The rows in a folder that were made with these problems and robots by this program, or by one whose commit is among
/// `same_as`. Of several of one run the last one. Rows of more seeds than the lines have are among them.
/// @throws InputError when the file cannot be read
[[nodiscard]] std::vector<AwarenessRow> current_rows(const AwarenessSettings& settings,
                                                     const std::filesystem::path& out,
                                                     const std::vector<std::string>& same_as);

/// The runs of a share that have no current row.
/// @param rows as of current_rows()
[[nodiscard]] std::vector<AwarenessTask> missing_tasks(const AwarenessSettings& settings, const TaskShare& share,
                                                       const std::vector<AwarenessRow>& rows);

/// How long so many runs take on so many threads [s]: by the rows of the same line where there are some, otherwise by
/// expected_s().
[[nodiscard]] double estimated_s(const AwarenessSettings& settings, const std::vector<AwarenessTask>& tasks,
                                 const std::vector<AwarenessRow>& rows, std::uint64_t jobs);

/// Runs what is missing of our share. Every run is written as soon as it is finished.
/// @throws InputError when results cannot be written
void run_awareness(const AwarenessSettings& settings, const AwarenessRunOptions& options);

/// Searches at a time without a number of jobs.
[[nodiscard]] std::uint64_t default_jobs();

}  // namespace downwash::bench
