#include <fmt/core.h>

#include <optional>
#include <utility>
#include <vector>

#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/report/run_figures.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
    std::string folder;
    std::optional<std::string> out;
    bool as_svg = false, as_png = false, as_pdf = false;
    std::optional<int> width_px;
    bool no_cache = false;

    [[nodiscard]] bool wants_pictures() const { return as_svg || as_png || as_pdf; }
};

void write_pictures(const ReportArguments& arguments, const ShownRun& run) {
    const FieldFigure flight = snapshot_figure(run.record, *run.model, run.map.get());
    const std::vector<CurveFigure> plots = time_figures(run.record);
    std::vector<std::pair<std::string, std::string>>
        pictures;  // names and contents: all are drawn before one is written
    using Wanted = std::pair<bool, std::pair<PictureFormat, std::string>>;
    for (const auto& [is_wanted, as] : {Wanted{arguments.as_svg, {PictureFormat::svg, ".svg"}},
                                        Wanted{arguments.as_png, {PictureFormat::png, ".png"}},
                                        Wanted{arguments.as_pdf, {PictureFormat::pdf, ".pdf"}}}) {
        if (is_wanted) {
            const PictureSettings settings{as.first, arguments.width_px.value_or(PictureSettings{}.width_px)};
            pictures.emplace_back("flight" + as.second, draw(flight, settings));
            pictures.emplace_back("plots" + as.second, draw(plots, settings));
        }
    }
    const OutputFolder folder(arguments.out.value_or(arguments.folder));
    for (const auto& [name, content] : pictures) {
        folder.write(name, content);
        fmt::print("{}\n", (folder.path() / name).string());
    }
}

ExitCode run(const ReportArguments& arguments) {
    if (arguments.width_px && !arguments.wants_pictures()) {
        throw UsageError("--width: of which picture? Expected --svg, --png or --pdf with it");
    }
    if (!arguments.wants_pictures()) {
        require_pages();
    }
    const ShownRun run = shown_run(arguments.folder, nullptr, arguments.no_cache ? fs::path() : cache_folder());
    if (arguments.wants_pictures()) {
        write_pictures(arguments, run);
    } else {
        const fs::path page = arguments.out ? fs::path(*arguments.out) : fs::path(arguments.folder) / "report.html";
        write_result(page, page_of(run));
        fmt::print("{}\n", page.string());
    }
    return ExitCode::done;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<ReportArguments>();
    CLI::App* command = program.add_subcommand(
        "report",
        "Show a run: one HTML page that needs nothing else, with scene, playback, plots and search; or, with --svg, "
        "--png or --pdf, pictures for papers instead: the snapshot diagram flight.* and the time plots plots.*");
    command->add_option("DIR", arguments->folder, "folder that `solve` or `execute` wrote to")->required();
    command
        ->add_option("-o,--out", arguments->out,
                     "the page, default report.html in that folder; or the folder of the pictures, default the same")
        ->type_name("FILE|DIR");
    command->add_flag("--svg", arguments->as_svg, "pictures as SVG");
    command->add_flag("--png", arguments->as_png, "pictures as PNG");
    command->add_flag("--pdf", arguments->as_pdf, "pictures as PDF");
    command->add_option("--width", arguments->width_px, "of the pictures: 400 to 8000, default 1200")
        ->type_name("PX")
        ->check(CLI::Range(least_picture_width_px, most_picture_width_px));
    command->add_flag("--no-cache", arguments->no_cache, "neither read nor write the cache of aero maps");
    command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
