#include "downwash/cli/run_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// @param problem a Problem or SpaceProblem
template <class AnyProblem>
RunFolder claimed(const fs::path& path, const AnyProblem& problem, const std::string& problem_file, bool force) {
    try {
        return {path, problem, problem_file, force};
    } catch (const OtherRunError& error) {
        throw UsageError(
            "{}; choose another folder with --out DIR, or replace what is there with --force; without --out, the "
            "folder is named by the problem's `name`",
            error.what());
    } catch (const FolderError& error) {
        throw UsageError("{}; choose another folder with --out", error.what());
    }
}

}  // namespace

void add_force(Command command, bool& force) {
    command.add_flag("--force", force, "replace what is in the folder; even a run of another problem");
}

RunFolder claimed_folder(const fs::path& path, const Problem& problem, const std::string& problem_file, bool force) {
    return claimed(path, problem, problem_file, force);
}

RunFolder claimed_folder(const fs::path& path, const SpaceProblem& problem, const std::string& problem_file,
                         bool force) {
    return claimed(path, problem, problem_file, force);
}

SourceFile source_of(const fs::path& folder, const std::string& solution_text) {
    return {folder / run_file_names().front(), solution_text};
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
    const std::vector<std::string>& ours = run_file_names();
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
    const std::string text = joined(std::span(names).first(std::min(names.size(), shown)), ", ", excerpt);
    return names.size() > shown ? text + fmt::format(" and {} more", names.size() - shown) : text;
}

}  // namespace downwash::cli
