#include <fmt/core.h>

#include <optional>
#include <utility>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/report/run_figures.hpp"
#include "downwash/report/run_page.hpp"

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
    void add_to(CLI::App& command);
    [[nodiscard]] ExitCode run() const;
};

void write_pictures(const ReportArguments& arguments, const ShownRun& run) {
    const FieldFigure flight = snapshot_figure(run.record, *run.model, run.map.get());
    const std::vector<CurveFigure> plots = time_figures(run.record);
    struct Wanted {
        bool is_wanted;
        PictureFormat format;
        const char* extension;
    };
    std::vector<std::pair<std::string, std::string>>
        pictures;  // names and contents: all are drawn before one is written
    for (const Wanted& as : {Wanted{arguments.as_svg, PictureFormat::svg, ".svg"},
                             {arguments.as_png, PictureFormat::png, ".png"},
                             {arguments.as_pdf, PictureFormat::pdf, ".pdf"}}) {
        if (as.is_wanted) {
            const PictureSettings settings{as.format, arguments.width_px.value_or(PictureSettings{}.width_px)};
            pictures.emplace_back(std::string("flight") + as.extension, draw(flight, settings));
            pictures.emplace_back(std::string("plots") + as.extension, draw(plots, settings));
        }
    }
    const OutputFolder folder(arguments.out.value_or(arguments.folder));
    for (const auto& [name, content] : pictures) {
        folder.write(name, content);
        fmt::print("{}\n", (folder.path() / name).string());
    }
}

ExitCode ReportArguments::run() const {
    if (width_px && !wants_pictures()) {
        throw UsageError("--width: of which picture? Expected --svg, --png or --pdf with it");
    }
    if (!wants_pictures()) {
        require_pages();
    }
    const ShownRun shown = shown_run(read_run(folder), nullptr, cache_folder(no_cache));
    if (wants_pictures()) {
        write_pictures(*this, shown);
    } else {
        const fs::path page = out ? fs::path(*out) : fs::path(folder) / "report.html";
        write_result(page, run_page(shown.record, *shown.model, shown.map.get()));
        fmt::print("{}\n", page.string());
    }
    return ExitCode::done;
}

void ReportArguments::add_to(CLI::App& command) {
    command.add_option("DIR", folder, "folder that `solve` or `execute` wrote to")->required();
    command
        .add_option("-o,--out", out,
                    "the page, default report.html in that folder; or the folder for the pictures, default the same")
        ->type_name("FILE|DIR");
    command.add_flag("--svg", as_svg, "pictures as SVG");
    command.add_flag("--png", as_png, "pictures as PNG");
    command.add_flag("--pdf", as_pdf, "pictures as PDF");
    add_width(command, width_px);
    add_no_cache(command, no_cache);
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
    add_command<ReportArguments>(
        program, action, "report",
        "Show a run as one self-contained HTML page with scene, playback, plots and search; with --svg, --png or "
        "--pdf, "
        "draw pictures for papers instead: the snapshot diagram flight.* and the time plots plots.*");
}

}  // namespace downwash::cli
