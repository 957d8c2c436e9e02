#include <fmt/core.h>

#include <optional>

#include "downwash/base/files.hpp"
#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/report/run_page.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
    std::string folder;
    std::optional<std::string> out;
    bool no_cache = false;
};

ExitCode run(const ReportArguments& arguments) {
    if (!has_pages()) {
        throw UsageError(
            "this build brings no pages: install what viewer/README.md names (./dev setup does), and build again");
    }
    const fs::path file = arguments.out ? fs::path(*arguments.out) : fs::path(arguments.folder) / "report.html";
    try {
        require_writable(file);
        write_file(file, page_of(arguments.folder, 1, nullptr, arguments.no_cache ? fs::path() : cache_folder()));
    } catch (const FileError& fault) {
        throw UsageError(file.string() + " " + fault.what());
    }
    fmt::print("{}\n", file.string());
    return ExitCode::done;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ReportArguments>();
    CLI::App* command = program.add_subcommand(
        "report", "Show a run as one HTML page that needs nothing else: scene, flight with playback, plots, search");
    command->add_option("DIR", arguments->folder, "folder that `solve` or `execute` wrote to")->required();
    command->add_option("-o,--out", arguments->out, "the page; default report.html in that folder")->type_name("FILE");
    command->add_flag("--no-cache", arguments->no_cache, "neither read nor write the cache of aero maps");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
