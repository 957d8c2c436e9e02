#pragma once

#include <filesystem>
#include <string>

#include "downwash/cli/command_line.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/results/run_folder.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash::cli {

/// Adds --force.
void add_force(Command command, bool& force);

/// The folder for the results of a run. @throws UsageError with remedies if RunFolder cannot be made
[[nodiscard]] RunFolder claimed_folder(const std::filesystem::path& path, const Problem& problem,
                                       const std::string& problem_file, bool force);
[[nodiscard]] RunFolder claimed_folder(const std::filesystem::path& path, const SpaceProblem& problem,
                                       const std::string& problem_file, bool force);

/// A file from which others are made, as it was read.
struct SourceFile {
    std::filesystem::path path;
    std::string text;
};

/// The solution.json of a run in a folder. @param solution_text what it holds
[[nodiscard]] SourceFile source_of(const std::filesystem::path& folder, const std::string& solution_text);

/// Writes files into a folder; see write_together(). Beside their source they are written only while it is the same.
/// @throws UsageError if that fails
void write_made_from(const SourceFile& source, const std::filesystem::path& folder, const NamedTexts& files);

/// Checks that a plan from a folder belongs to what is beside it; one from a file stands for itself.
/// @param given to --plan; see plan_file()   @throws InputError or ProblemFileError as require_whole_run()
void require_whole_plan(const std::string& given);

/// Names of files in the folder of a run that are not part of it; at most three, and how many more.
[[nodiscard]] std::string other_files_in(const std::filesystem::path& folder);

}  // namespace downwash::cli
