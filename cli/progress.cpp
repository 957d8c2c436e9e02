#include "downwash/cli/progress.hpp"
#include "downwash/cli/standard_error.hpp"

#include <fmt/core.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace downwash::cli {
namespace {

constexpr char erase_line[] = "\r\x1b[K";

/// Whether standard error is a terminal that understands erasing a line.
bool is_live_terminal() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string text_of(const Progress& progress) {
    const std::string best = progress.best_cost ? fmt::format("best cost {:.6g}", *progress.best_cost) : "no plan yet";
    return fmt::format("{:.1f} s, {} iterations, {} nodes, {} refused, {}", progress.wall_s, progress.iterations,
                       progress.nodes, progress.rejected, best);
}

spdlog::logger& logger() {
    static const auto log = [] {
        auto made = std::make_shared<spdlog::logger>("downwash", std::make_shared<spdlog::sinks::stderr_sink_st>());
        made->set_pattern("[%H:%M:%S] %v");
        return made;
    }();
    return *log;
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool is_quiet) : is_quiet_(is_quiet), is_live_(is_live_terminal()) {}

ProgressDisplay::~ProgressDisplay() {
    clear_line();
}

void ProgressDisplay::say(const std::string& text) {
    if (is_quiet_) {
        return;
    }
    clear_line();
    logger().info(text);
}

void ProgressDisplay::show(const Progress& progress) {
    if (is_quiet_) {
        return;
    }
    if (is_live_) {
        show_live(text_of(progress));
    } else if (Clock::now() >= next_log_) {
        logger().info(text_of(progress));
        next_log_ = Clock::now() + search_period;
    }
}

void ProgressDisplay::show(const std::string& task, double share) {
    constexpr int width = 30;
    constexpr double least_step = 0.1;
    if (is_quiet_) {
        return;
    }
    if (task != task_) {
        task_ = task;
        logged_share_ = 0;
    }
    if (is_live_) {
        const int done = static_cast<int>(share * width);
        show_live(fmt::format("{} [{:=<{}}{: <{}}] {:3.0f} %", task, "", done, "", width - done, 100 * share));
    } else if (share >= logged_share_ + least_step && Clock::now() >= next_task_log_) {
        logger().info("{}: {:.0f} %", task, 100 * share);
        logged_share_ = share;
        next_task_log_ = Clock::now() + task_period;
    }
}

void ProgressDisplay::show_live(const std::string& text) {
    print_error(fmt::format("{}{}", erase_line, text));
    has_line_ = true;
}

void ProgressDisplay::clear_line() {
    if (has_line_) {
        print_error(erase_line);
        has_line_ = false;
    }
}

}  // namespace downwash::cli
