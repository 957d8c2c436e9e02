#include <fmt/core.h>

#include <optional>
#include <utility>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/run_report.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/report/run_figures.hpp"
#include "downwash/report/run_page.hpp"
#include "downwash/report/space_page.hpp"
#include "downwash/report/space_problem_figure.hpp"

namespace downwash::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
    std::string folder;
    std::optional<std::string> out;
    bool as_svg = false, as_png = false, as_pdf = false;
    std::optional<int> width_px;
    int threads = default_threads();
    bool no_labels = false;

    [[nodiscard]] bool wants_pictures() const { return as_svg || as_png || as_pdf; }
};

/// @param flight figure of the flight   @param solution_text of the run
template <class Figure>
void write_pictures(const ReportArguments& given, const std::string& solution_text, const Figure& flight,
                    const std::vector<CurveFigure>& plots) {
    struct Wanted {
        bool is_wanted;
        PictureFormat format;
        const char* extension;
    };
    NamedTexts pictures;  // all are drawn before one is written
    for (const Wanted& as : {Wanted{given.as_svg, PictureFormat::svg, ".svg"},
                             {given.as_png, PictureFormat::png, ".png"},
                             {given.as_pdf, PictureFormat::pdf, ".pdf"}}) {
        if (as.is_wanted) {
            const PictureSettings settings{as.format, given.width_px.value_or(PictureSettings{}.width_px),
                                           given.threads};
            pictures.emplace_back(std::string("flight") + as.extension, draw(flight, settings));
            pictures.emplace_back(std::string("plots") + as.extension, draw(plots, settings));
        }
    }
    const OutputFolder folder(given.out.value_or(run_folder(given.folder)));
    write_made_from(source_of(run_folder(given.folder), solution_text), folder.path(), pictures);
    for (const auto& [name, content] : pictures) {
        fmt::print("{}\n", (folder.path() / name).string());
    }
}

void write_pictures(const ReportArguments& given, const SpaceRunRecord& run) {
    SpaceFigure flight = space_run_figure(run, Scene(run.problem.obstacles));
    flight.has_names = !given.no_labels;
    write_pictures(given, run.solution_text, flight, time_figures(run));
}

void write_pictures(const ReportArguments& given, const RunRecord& run) {
    const auto model = make_flight_model(run.problem);
    FieldFigure flight = snapshot_figure(run, *model);
    flight.has_names = !given.no_labels;
    write_pictures(given, run.solution_text, flight, time_figures(run));
}

void write_page(const fs::path& folder, const fs::path& file, const std::string& solution_text,
                const std::string& page) {
    write_made_from(source_of(folder, solution_text), file.parent_path(), {{file.filename().string(), page}});
}

ExitCode run(const ReportArguments& given) {
    if (given.width_px && !given.wants_pictures()) {
        throw UsageError("--width goes with pictures only: expected --svg, --png or --pdf with it");
    }
    if (given.no_labels && !given.wants_pictures()) {
        throw UsageError("--no-labels goes with pictures only: expected --svg, --png or --pdf with it");
    }
    const fs::path folder = run_folder(given.folder);
    if (given.wants_pictures() && is_space_run(folder)) {
        write_pictures(given, read_space_run(folder));
    } else if (given.wants_pictures()) {
        write_pictures(given, read_run(folder));
    } else {
        require_pages();
        const fs::path page = given.out ? fs::path(*given.out) : folder / run_page_name;
        if (is_space_run(folder)) {
            const SpaceRunRecord shown = read_space_run(folder);
            write_page(folder, page, shown.solution_text, space_page(shown.problem, shown_run(shown)));
        } else {
            const RunRecord shown = read_run(folder);
            write_page(folder, page, shown.solution_text,
                       run_page(shown, *make_flight_model(shown.problem), given.threads));
        }
        fmt::print("{}\n", page.string());
    }
    return ExitCode::done;
}

}  // namespace

void add_report(Command program, Action& action) {
    auto [command, given] = add_command<ReportArguments>(
        program, action, "report",
        "Show a run as one self-contained HTML page with scene, playback, plots and search; with --svg, --png or "
        "--pdf, draw pictures for papers instead: the snapshot diagram flight.*, in space in three views, and the time "
        "plots plots.*",
        run);
    add_run(command, given.folder);
    add_out(command, "FILE|DIR", given.out,
            "the page, default report.html in that folder; or the folder for the pictures, default the same");
    command.add_flag("--svg", given.as_svg, "pictures as SVG");
    command.add_flag("--png", given.as_png, "pictures as PNG");
    command.add_flag("--pdf", given.as_pdf, "pictures as PDF");
    add_width(command, given.width_px);
    add_no_labels(command, given.no_labels);
    add_threads(command, given.threads);
}

}  // namespace downwash::cli
