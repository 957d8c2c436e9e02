#include "downwash/cli/study_commands.hpp"

#include "downwash/cli/common_options.hpp"

namespace downwash::cli {
namespace {

void add_study_uncertainty(Command study, Action& action, ExitCode (*run)(const StudyUncertaintyArguments&)) {
    auto [command, given] =
        add_command(study, action, "uncertainty",
                    "Compare plans for the nominal world, with margins, in one pessimistic world and in "
                    "several worlds: how "
                    "often they are found and fail, what they cost. Continues with the results that are there",
                    run);
    command.add_option("--problem FILE...", given.problems, "problem files; default: all in the folder problems/");
    command.add_option("--seeds N", given.seeds, "searches of each setup on each problem; default 20")
        .in_range(1, 100000);
    command.add_option("--time-limit S", given.time_limit_s, "wall time of a search [s]; default 5")
        .in_range(0.01, 1e6);
    command.add_option("--worlds M", given.worlds, "fresh worlds in which every reported plan is flown; default 300")
        .in_range(1, 1000000);
    add_jobs(command, given.jobs, "one per processor");
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/study-uncertainty/");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

void add_study_awareness(Command study, Action& action, ExitCode (*run)(const StudyAwarenessArguments&)) {
    auto [command, given] =
        add_command(study, action, "awareness",
                    "Compare the three variants as levels of awareness: planning for the nominal world, in worlds "
                    "and for certificates, with and without execution before a plan counts, with several "
                    "controllers, on shipped problems and on others that engineers have. Continues with the results "
                    "that are there",
                    run);
    command.add_option(
        "--line NAME...", given.lines,
        "lines of the table of cells; default: those of docs/awareness.md, seven hours on two processors");
    command.add_option("--only NAME...", given.problems, "names of problems of the study; default: all");
    command
        .add_option("--seeds N", given.seeds, "searches of each setup on each problem; default: as the lines have it")
        .in_range(1, 100000);
    command
        .add_option("--worlds M", given.worlds,
                    "fresh worlds in which every reported plan is flown; first candidates, too; default: as the lines "
                    "have it")
        .in_range(1, 1000000);
    command.add_option("--share I/N", given.share,
                       "makes a part of the runs: several programs can fill one folder at a time");
    command.add_option("--same-as COMMIT...", given.same_as,
                       "also keeps runs of programs of these commits, since which no plan has changed");
    command.add_flag("--estimate", given.only_estimates,
                     "runs nothing: prints the lines, their runs and how long they take");
    command.add_flag("--summary", given.only_reports, "runs nothing: reports what is there");
    add_jobs(command, given.jobs, "one per processor");
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/study-awareness/");
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

/// Adds a study of the thesis' experiments.
void add_thesis_study(Command parent, Action& action, const std::string& name, const std::string& about,
                      ExitCode (*run)(const StudyArguments&)) {
    auto [command, given] = add_command(parent, action, name, about, run);
    given.name = name;
    given.out = "downwash-out/study-" + name;
    add_out(command, "DIR", given.out, "folder for the results; default downwash-out/study-" + name + "/");
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace

void add_study(Command program, Action& action, const StudyCommands& commands) {
    Command study = program.add_command("study", "Check claims by runs of our own");
    study.require_command();
    add_study_uncertainty(study, action, commands.uncertainty);
    add_study_awareness(study, action, commands.awareness);
    add_thesis_study(study, action, "ceiling-envelope",
                     "Compare the rotors of a pitched vehicle under a ceiling (thesis 4.6, figure 4.9)",
                     commands.thesis);
    add_thesis_study(study, action, "ceiling-contact",
                     "Touch a ceiling and leave it under the Lyapunov laws and under a PID (thesis 4.6, 4.7)",
                     commands.thesis);
    add_thesis_study(
        study, action, "partial-ground-effect",
        "Fly a quadrotor over the edge of a plate under three controllers, with every ground model (thesis 3.4)",
        commands.thesis);
    add_thesis_study(study, action, "disturbance-test-bench",
                     "Put a plate under one rotor of a quadrotor that can only pitch (thesis 3.5)", commands.thesis);
}

}  // namespace downwash::cli
