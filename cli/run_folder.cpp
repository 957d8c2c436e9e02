#include "downwash/cli/run_folder.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

constexpr char remedies[] = "choose another folder with --out DIR, or replace what is there with --force";

/// All files that a run can have; solution.json makes a folder one.
const std::vector<std::string>& names_of_files() {
    static const std::vector<std::string> names{"solution.json", "trajectory.csv", "tree.csv", "effective.yaml",
                                                run_page_name};
    return names;
}

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// Whether a run was planned from this file. A relative path counts from the current folder, as it did then.
bool is_from_file(const std::string& claimed, const std::string& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && fs::equivalent(claimed, file, ignored);
}

/// The file that a run was planned from, for a message: its name and the folder that it is in.
std::string shown_file(const fs::path& file) {
    return file.empty() ? "an unknown file" : excerpt((file.parent_path().filename() / file.filename()).string());
}

/// @throws UsageError if the folder holds what a run of this problem must not replace unasked
void require_replaceable(const fs::path& folder, const Problem& problem, const std::string& file) {
    if (!is_there(folder / names_of_files().front())) {
        for (const std::string& name : names_of_files()) {
            if (is_there(folder / name)) {
                throw UsageError("{} would be replaced, and is not part of a run, for there is no {} beside it; {}",
                                 (folder / name).string(), names_of_files().front(), remedies);
            }
        }
        return;
    }
    ProblemReference there;
    try {
        there = problem_of_solution(folder / names_of_files().front());
    } catch (const InputError& error) {
        throw UsageError("{}; {}", error.what(), remedies);
    }
    if (!is_from_file(there.file, file) && there.sha256 != problem_sha256(problem)) {
        throw UsageError(
            "{} holds a run of another problem: {} (name: {}), not of {}; {}; without --out, the folder is named by "
            "the problem's `name`",
            folder.string(), shown_file(there.file), excerpt(there.name), file, remedies);
    }
}

WholeFolder claimed(const fs::path& path) {
    try {
        return WholeFolder(path, names_of_files());
    } catch (const FolderError& error) {
        throw UsageError("{}; choose another folder with --out", error.what());
    }
}

}  // namespace

void add_force(CLI::App& command, bool& force) {
    command.add_flag("--force", force, "replace what is in the folder, even a run of another problem");
}

RunFolder::RunFolder(fs::path path, const Problem& problem, const std::string& problem_file, bool force)
    : path_(std::move(path)), whole_(claimed(path_)) {
    if (!force) {
        require_replaceable(path_, problem, problem_file);
    }
}

SourceFile source_of(const fs::path& folder, const RunRecord& run) {
    return {folder / names_of_files().front(), run.solution_text};
}

void write_made_from(const SourceFile& source, const fs::path& folder, const NamedTexts& files) {
    const fs::path place = folder.empty() ? "." : folder;
    const FolderLock lock(place);
    const bool is_gone = !is_there(source.path) || read_file(source.path, source.text.size() + 1) != source.text;
    if (std::error_code elsewhere;
        is_gone && fs::equivalent(place, fs::absolute(source.path).parent_path(), elsewhere)) {
        throw UsageError("{} was replaced meanwhile, and nothing was written beside it: try again",
                         source.path.string());
    }
    write_together(folder, files);
}

void require_whole_plan(const std::string& given) {
    if (std::error_code ignored; fs::is_directory(given, ignored)) {
        require_whole_run(given);
    }
}

std::string other_files_in(const fs::path& folder) {
    const std::vector<std::string>& ours = names_of_files();
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::string name = at->path().filename().string();
        if (std::find(ours.begin(), ours.end(), name) == ours.end()) {
            names.push_back(std::move(name));
        }
    }
    std::sort(names.begin(), names.end());
    constexpr std::size_t shown = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), shown); ++i) {
        text += (i > 0 ? ", " : "") + excerpt(names[i]);
    }
    return names.size() > shown ? text + fmt::format(" and {} more", names.size() - shown) : text;
}

}  // namespace downwash::cli
