#pragma once

#include <filesystem>
#include <string>

#include "downwash/base/whole_folder.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/results/run_record.hpp"

namespace CLI {
class App;
}

namespace downwash::cli {

/// The page in the folder of a run.
inline constexpr char run_page_name[] = "report.html";

/// Adds --force.
void add_force(CLI::App& command, bool& force);

/// The folder for the results of a run. They appear as one; see WholeFolder.
class RunFolder {
 public:
    /// Claims the folder before anything is computed.
    /// @param problem_file as the user gave it   @param force whether anything that is there may be replaced
    /// @throws UsageError if it cannot be written, another process is going to write it, or it holds a run of another
    /// problem: one from another file, and with another digest
    RunFolder(std::filesystem::path path, const Problem& problem, const std::string& problem_file, bool force);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    /// Replaces the run in the folder, its page included. @throws FolderError
    void write(const NamedTexts& files) { whole_.write(files); }

 private:
    std::filesystem::path path_;
    WholeFolder whole_;
};

/// A file from which others are made, as it was read.
struct SourceFile {
    std::filesystem::path path;
    std::string text;
};

/// The solution.json of a run in a folder.
[[nodiscard]] SourceFile source_of(const std::filesystem::path& folder, const RunRecord& run);

/// Writes files into a folder; see write_together(). Beside their source they are written only while it is the same.
/// @throws UsageError if that fails
void write_made_from(const SourceFile& source, const std::filesystem::path& folder, const NamedTexts& files);

/// Checks that a plan from a folder belongs to what is beside it; one from a file stands for itself.
/// @param given to --plan; see plan_file()   @throws InputError or ProblemFileError as require_whole_run()
void require_whole_plan(const std::string& given);

/// Names of files in the folder of a run that are not part of it; at most three, and how many more.
[[nodiscard]] std::string other_files_in(const std::filesystem::path& folder);

}  // namespace downwash::cli
