#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/whole_folder.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// The page in the folder of a run.
inline constexpr char run_page_name[] = "report.html";

/// The names of all files that a run can have. The first one, solution.json, makes a folder that of a run.
[[nodiscard]] DOWNWASH_EXPORT const std::vector<std::string>& run_file_names();

/// A folder holds what a run must not replace unasked; what() says what that is.
struct DOWNWASH_EXPORT OtherRunError : FolderError {
    using FolderError::FolderError;
};

/// The folder for the results of a run. They appear as one; see WholeFolder.
class DOWNWASH_EXPORT RunFolder {
 public:
    /// Claims the folder before anything is computed.
    /// @param problem_file as the user gave it   @param force whether anything that is there may be replaced
    /// @throws FolderError if it cannot be written, or another process is going to write it
    /// @throws OtherRunError if it holds a run of another problem, one from another file and with another digest, or
    /// files with names of ours that are part of no run
    RunFolder(std::filesystem::path path, const Problem& problem, const std::string& problem_file, bool force);

    /// The same for a flight in space.
    RunFolder(std::filesystem::path path, const SpaceProblem& problem, const std::string& problem_file, bool force);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    /// Writes effective.yaml, trajectory.csv, tree.csv and solution.json, which replace the run of before, its page
    /// included. Once for a folder.
    /// @param problem_file as the user gave it   @param warnings of reading it   @param inputs what of it was read
    /// @return the same run, as read_run() would read it from the folder
    /// @throws FolderError
    RunRecord write(const Problem& problem, const std::string& problem_file, const std::vector<LocatedError>& warnings,
                    const Solution& solution, const std::optional<InputFacts>& inputs = {});

    /// The same for a flight in space; tree.csv is that of its search, if there was one. @return the same run, as
    /// read_space_run() would read it
    /// @pre the solution has an execution
    SpaceRunRecord write(const SpaceProblem& problem, const std::string& problem_file,
                         const std::vector<LocatedError>& warnings, const SpaceSolution& solution,
                         const std::optional<SpaceInputFacts>& inputs = {});

 private:
    template <class Record>
    void write_files(std::vector<std::pair<std::string, std::string>>& files, Record& record);

    std::filesystem::path path_;
    WholeFolder whole_;
};

}  // namespace downwash
