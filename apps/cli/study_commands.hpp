#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/command_line.hpp"

namespace downwash::cli {

/// What a study of the thesis' experiments is asked for.
struct StudyArguments {
    std::string name, out;
    bool is_quiet = false, as_json = false;
};

/// What `study uncertainty` is asked for.
struct StudyUncertaintyArguments {
    std::vector<std::string> problems;
    std::string out = "downwash-out/study-uncertainty";
    std::optional<std::uint64_t> seeds, worlds, jobs;
    std::optional<double> time_limit_s;
    bool no_cache = false, is_quiet = false, as_json = false;
};

/// What `study awareness` is asked for.
struct StudyAwarenessArguments {
    std::vector<std::string> problems, lines, same_as;
    std::string out = "downwash-out/study-awareness";
    std::string share = "1/1";
    std::optional<std::uint64_t> seeds, worlds, jobs;
    bool only_estimates = false, only_reports = false;
    bool no_cache = false, is_quiet = false, as_json = false;
};

/// What the commands do; empty in a program that leaves them to downwash-study.
struct StudyCommands {
    ExitCode (*uncertainty)(const StudyUncertaintyArguments&) = nullptr;
    ExitCode (*awareness)(const StudyAwarenessArguments&) = nullptr;
    ExitCode (*thesis)(const StudyArguments&) = nullptr;
};

/// Adds `study` and the commands below it.
void add_study(Command program, Action& action, const StudyCommands& commands);

// The commands of downwash-study.
ExitCode study_uncertainty(const StudyUncertaintyArguments& given);
ExitCode study_awareness(const StudyAwarenessArguments& given);
ExitCode study_thesis(const StudyArguments& given);

}  // namespace downwash::cli
