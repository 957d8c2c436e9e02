#include "downwash/cli/progress.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "downwash/cli/output.hpp"

namespace downwash::cli {
namespace {

constexpr char erase_line[] = "\r\x1b[K";

/// Whether standard error is a terminal that understands erasing a line.
bool is_live_terminal() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string text_of_progress(const Progress& progress) {
    const std::string best =
        progress.best_cost ? fmt::format("best planned cost {:.6g}", *progress.best_cost) : "no plan yet";
    if (progress.legs) {
        return fmt::format("{:.1f} s, comparing orders of {} goals: {} legs flown, {}", progress.wall_s, progress.goals,
                           *progress.legs, best);
    }
    std::string text = fmt::format("{:.1f} s, {} iterations, {} nodes, {} rejected, {}", progress.wall_s,
                                   progress.iterations, progress.nodes, progress.rejected, best);
    if (progress.goals > 1) {
        text = fmt::format("goal {} of {}, {}", progress.goal, progress.goals, text);
    }
    if (progress.round > 1) {
        text = fmt::format("round {}, {}", progress.round, text);
    }
    if (progress.worlds) {
        text += fmt::format("; certifying a plan: {} worlds, {} failed", *progress.worlds, progress.failures);
        if (*progress.worlds > 0) {
            text += fmt::format(": at most {:.1f} % so far", 100 * progress.failure_bound);
        }
    }
    return text;
}

/// A line with the time of day before it.
void log(const std::string& text) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    print_error(fmt::format("[{:%H:%M:%S}] {}\n", *localtime_r(&now, &local), text));
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool is_quiet) : is_quiet_(is_quiet), is_live_(is_live_terminal()) {}

ProgressDisplay::~ProgressDisplay() {
    clear();
}

void ProgressDisplay::say(const std::string& text) {
    if (is_quiet_) {
        return;
    }
    clear();
    log(text);
}

void ProgressDisplay::show(const Progress& progress) {
    if (is_quiet_) {
        return;
    }
    if (is_live_) {
        show_live(text_of_progress(progress));
    } else if (Clock::now() >= next_log_) {
        log(text_of_progress(progress));
        next_log_ = Clock::now() + search_period;
    }
}

void ProgressDisplay::show(const std::string& task, double share) {
    constexpr int width = 30;
    constexpr double min_step = 0.1;
    if (is_quiet_) {
        return;
    }
    if (task != task_ || share < logged_share_) {
        task_ = task;
        logged_share_ = 0;
        task_began_ = Clock::now();
    }
    if (is_live_) {
        const int done = static_cast<int>(share * width);
        show_live(fmt::format("{} [{:=<{}}{: <{}}] {:3.0f} %{}", task, "", done, "", width - done, 100 * share,
                              time_left(share)));
    } else if (share >= logged_share_ + min_step && Clock::now() >= next_task_log_) {
        log(fmt::format("{}: {:.0f} %{}", task, 100 * share, time_left(share)));
        logged_share_ = share;
        next_task_log_ = Clock::now() + task_period;
    }
}

/// Of the task, if its work is spread evenly; nothing before that can be told.
std::string ProgressDisplay::time_left(double share) const {
    constexpr double min_s = 2;
    const double spent_s = std::chrono::duration<double>(Clock::now() - task_began_).count();
    const double left_s = spent_s * (1 - share) / share;
    return spent_s > min_s && share > 0 && share < 1 ? fmt::format(", about {:.0f} s left", std::ceil(left_s)) : "";
}

void ProgressDisplay::show_live(const std::string& text) {
    print_error(fmt::format("{}{}", erase_line, text));
    has_line_ = true;
}

void ProgressDisplay::clear() {
    if (has_line_) {
        print_error(erase_line);
        has_line_ = false;
    }
}

}  // namespace downwash::cli
