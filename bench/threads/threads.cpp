// What more threads bring to a search: measured with one and two, and by simulating the schedule of recorded searches
// with up to 32. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "schedule.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr std::array thread_counts{1, 2, 4, 8, 16, 32};

struct Given {
    std::vector<std::string> problems;
    std::uint64_t iterations = 150;           ///< in worlds
    std::uint64_t nominal_iterations = 1000;  ///< in the nominal world
    std::uint32_t seeds = 2;
};

double process_time_s() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Time that all processors have worked since the machine started [s]; 0 where the system does not say.
double machine_busy_s() {
    std::ifstream stat("/proc/stat");
    std::string word;
    double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0;
    stat >> word >> user >> nice >> system >> idle >> wait >> irq >> soft;
    return stat ? 0.01 * (user + nice + system + irq + soft) : 0;
}

/// Time that something took.
struct Took {
    double wall_s = 0, processor_s = 0, others_s = 0;

    Took& operator+=(const Took& other) {
        wall_s += other.wall_s;
        processor_s += other.processor_s;
        others_s += other.others_s;
        return *this;
    }
};

template <class Work>
Took timed(const Work& work) {
    const double wall_0 = wall_s(), processor_0 = process_time_s(), busy_0 = machine_busy_s();
    work();
    Took took{wall_s() - wall_0, process_time_s() - processor_0, 0};
    took.others_s = std::max(0.0, machine_busy_s() - busy_0 - took.processor_s);
    return took;
}

/// How long a thread that waits for a batch takes to begin with it, both ways included [s]: what a second thread adds
/// to a batch of three flights of one tick.
double measured_wake_s(const FlightModel& model, const Problem& problem) {
    constexpr int batches = 4000;
    const ReferencePoint here = at_rest(problem.start.configuration());
    const ReferenceSegment segment(here, here, 1, model.tick().tick_s);
    double took_s[2] = {};
    for (const int threads : {1, 2}) {
        FlightPool pool(model, nullptr, {}, nullptr, threads);
        std::vector<double> times;
        for (int i = 0; i < batches; ++i) {
            std::vector<FlightJob> jobs(3, FlightJob{start_state(model, problem.start), {{segment}}});
            const double begin_s = wall_s();
            pool.fly(jobs);
            times.push_back(wall_s() - begin_s);
        }
        std::nth_element(times.begin(), times.begin() + batches / 2, times.end());
        took_s[threads - 1] = times[batches / 2];
    }
    return std::max(0.0, took_s[1] - took_s[0]);
}

bool is_same(const Solution& a, const Solution& b) {
    const auto& x = a.plan ? a.plan->reference : std::vector<ReferenceKnot>{};
    const auto& y = b.plan ? b.plan->reference : std::vector<ReferenceKnot>{};
    return a.status == b.status && a.planning.edges_simulated == b.planning.edges_simulated && x.size() == y.size() &&
           std::memcmp(&a.cost, &b.cost, sizeof a.cost) == 0 &&
           std::equal(x.begin(), x.end(), y.begin(), [](const ReferenceKnot& p, const ReferenceKnot& q) {
               return p.tick == q.tick && p.point == q.point;
           });
}

/// The searches of one problem.
struct Measured {
    std::string name;
    std::vector<SearchWork> searches;
    Took one, two;
    double recorded_s = 0;  ///< processor time of the recorded searches
};

Measured measured(const std::string& file, bool in_worlds, const Given& given) {
    Problem problem = read_problem(file);
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.max_iterations = in_worlds ? given.iterations : given.nominal_iterations;
    if (!in_worlds) {
        problem.uncertainty.reset();
    }
    problem.planner.time_limit_s.reset();
    Measured all{problem.name, {}, {}, {}, 0};
    SolveOptions options;
    options.map = make_flight_model(problem)->make_map(problem.bounds);
    for (std::uint32_t seed = 1; seed <= given.seeds; ++seed) {
        problem.planner.seed = seed;
        WorkRecorder recorder;
        options.threads = 1;
        options.recorder = &recorder;
        const double begin_s = WorkRecorder::now_s();
        const Solution recorded = solve(problem, options);
        const double end_s = WorkRecorder::now_s();
        all.searches.push_back(search_work(recorder.take(), begin_s, end_s));
        all.recorded_s += end_s - begin_s;
        options.recorder = nullptr;
        for (const int threads : {1, 2}) {
            options.threads = threads;
            Solution solution;
            (threads == 1 ? all.one : all.two) += timed([&] { solution = solve(problem, options); });
            if (!is_same(solution, recorded)) {
                throw std::runtime_error(
                    fmt::format("{}, seed {}: the plan depends on threads or on the recorder", file, seed));
            }
        }
    }
    return all;
}

SchedulePolicy with_threads(int threads, double wake_s) {
    SchedulePolicy policy;
    policy.threads = threads;
    policy.wake_s = wake_s;
    return policy;
}

Schedule simulated(const std::vector<SearchWork>& searches, const SchedulePolicy& policy) {
    Schedule sum;
    const auto add = [](Schedule::Idle& to, const Schedule::Idle& from) {
        to.serial_s += from.serial_s;
        to.flights_s += from.flights_s;
    };
    for (const SearchWork& search : searches) {
        const Schedule one = simulate(search, policy);
        sum.wall_s += one.wall_s;
        sum.work_s += one.work_s;
        sum.narrow_s += one.narrow_s;
        add(sum.outside, one.outside);
        add(sum.inside, one.inside);
        add(sum.round_end, one.round_end);
    }
    return sum;
}

double work_s(const std::vector<SearchWork>& searches) {
    double sum = 0;
    for (const SearchWork& search : searches) {
        sum += shares_of(search).all_s();
    }
    return sum;
}

void print_measured(const std::vector<Measured>& problems, double wake_s) {
    fmt::print(
        "### One and two threads\n\nThe columns of times are sums over seeds. Work: processor time of the recorded "
        "searches on one thread. "
        "Others: the share of both processors that other programs took while two threads searched; it can only lower "
        "the measured speed-up.\n\n"
        "| problem | work | 1 thread | 2 threads | speed-up | simulated | error | processor time, 2 over 1 | others |\n"
        "| --- | --: | --: | --: | --: | --: | --: | --: | --: |\n");
    std::vector<SearchWork> all;
    Took one, two;
    const auto row = [&](const std::string& name, const std::vector<SearchWork>& searches, const Took& a,
                         const Took& b) {
        const double base_s = simulated(searches, {}).wall_s;
        const double expected = base_s / simulated(searches, with_threads(2, wake_s)).wall_s;
        const double found = a.wall_s / b.wall_s;
        fmt::print("| {} | {:.2f} s | {:.2f} s | {:.2f} s | {:.2f} | {:.2f} | {:+.1f} % | {:.3f} | {:.0f} % |\n", name,
                   work_s(searches), a.wall_s, b.wall_s, found, expected, 100 * (expected / found - 1),
                   b.processor_s / a.processor_s, 100 * b.others_s / (2 * b.wall_s));
    };
    for (const Measured& problem : problems) {
        row(problem.name, problem.searches, problem.one, problem.two);
        all.insert(all.end(), problem.searches.begin(), problem.searches.end());
        one += problem.one;
        two += problem.two;
    }
    row("all", all, one, two);
    constexpr double noticeable = 0.03;
    if (two.others_s > noticeable * 2 * two.wall_s) {
        fmt::print(
            "\n**Other programs shared the machine**, so the measured speed-ups of this table are too low and the "
            "errors too large.\n");
    }
}

void print_shares(const std::vector<Measured>& problems) {
    fmt::print(
        "\n### What a search is made of\n\nShares of the processor time on one thread. Serial: sampling, neighbours, "
        "checks of "
        "references, insertion, the direct flight, and everything else that is not a flight of a batch.\n\n"
        "| problem | before and between rounds | execution: serial | flights | tree: serial | flights | refinement: "
        "serial | "
        "flights | rounds | steps a round | batches a step | jobs a batch |\n"
        "| --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |\n");
    for (const Measured& problem : problems) {
        WorkShares sum;
        for (const SearchWork& search : problem.searches) {
            const WorkShares one = shares_of(search);
            sum.outside_serial_s += one.outside_serial_s;
            sum.outside_flights_s += one.outside_flights_s;
            for (std::size_t i = 0; i < 3; ++i) {
                sum.task_serial_s[i] += one.task_serial_s[i];
                sum.task_flights_s[i] += one.task_flights_s[i];
            }
            sum.rounds += one.rounds;
            sum.steps += one.steps;
            sum.batches += one.batches;
            sum.jobs += one.jobs;
        }
        const auto percent = [&](double s) { return fmt::format("{:.0f} %", 100 * s / sum.all_s()); };
        const auto ratio = [](std::size_t a, std::size_t b) {
            return static_cast<double>(a) / static_cast<double>(std::max<std::size_t>(1, b));
        };
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} | {:.0f} | {:.1f} | {:.1f} |\n", problem.name,
                   percent(sum.outside_serial_s + sum.outside_flights_s), percent(sum.task_serial_s[0]),
                   percent(sum.task_flights_s[0]), percent(sum.task_serial_s[1]), percent(sum.task_flights_s[1]),
                   percent(sum.task_serial_s[2]), percent(sum.task_flights_s[2]),
                   ratio(sum.rounds, problem.searches.size()), ratio(sum.steps, sum.rounds),
                   ratio(sum.batches, sum.steps), ratio(sum.jobs, sum.batches));
    }
}

std::string headline() {
    std::string head = "|", line = "| ---";
    for (const int threads : thread_counts) {
        head += fmt::format(" {} |", threads);
        line += " | --:";
    }
    return head + "\n" + line + " |\n";
}

void print_simulated(const std::vector<Measured>& problems, const std::vector<SearchWork>& all, double wake_s) {
    fmt::print(
        "\n### More threads, in simulation\n\nThe speed-up over one thread of the schedule as it is, on as many "
        "processors as threads.\n\n| problem {}",
        headline());
    const auto row = [&](const std::string& name, const std::vector<SearchWork>& searches) {
        const double base_s = simulated(searches, {}).wall_s;
        fmt::print("| {} |", name);
        for (const int threads : thread_counts) {
            fmt::print(" {:.2f} |", base_s / simulated(searches, with_threads(threads, wake_s)).wall_s);
        }
        fmt::print("\n");
    };
    for (const Measured& problem : problems) {
        row(problem.name, problem.searches);
    }
    row("all", all);
    fmt::print(
        "\n### Where the processors' time goes\n\nAll problems, in simulation; shares of threads times wall time.\n\n| "
        "{}",
        headline());
    std::vector<Schedule> schedules;
    schedules.reserve(thread_counts.size());
    for (const int threads : thread_counts) {
        schedules.push_back(simulated(all, with_threads(threads, wake_s)));
    }
    struct Loss {
        const char* name;
        double (*of)(const Schedule&);
    };
    constexpr std::array losses{
        Loss{"flights in narrower batches", [](const Schedule& s) { return s.narrow_s; }},
        Loss{"idle in a round, during serial work", [](const Schedule& s) { return s.inside.serial_s; }},
        Loss{"idle in a round, too few flights", [](const Schedule& s) { return s.inside.flights_s; }},
        Loss{"idle at the end of a round, during serial work", [](const Schedule& s) { return s.round_end.serial_s; }},
        Loss{"idle at the end of a round, too few flights", [](const Schedule& s) { return s.round_end.flights_s; }},
        Loss{"idle before and between rounds, during serial work",
             [](const Schedule& s) { return s.outside.serial_s; }},
        Loss{"idle before and between rounds, too few flights", [](const Schedule& s) { return s.outside.flights_s; }},
    };
    const auto percent = [&](std::size_t i, double seconds) {
        return 100 * seconds / (thread_counts[i] * schedules[i].wall_s);
    };
    fmt::print("| work |");
    for (std::size_t i = 0; i < schedules.size(); ++i) {
        fmt::print(" {:.1f} % |", percent(i, schedules[i].work_s));
    }
    fmt::print("\n");
    for (const Loss& loss : losses) {
        fmt::print("| {} |", loss.name);
        for (std::size_t i = 0; i < schedules.size(); ++i) {
            fmt::print(" {:.1f} % |", percent(i, std::max(0.0, loss.of(schedules[i]))));
        }
        fmt::print("\n");
    }
    fmt::print("\nThe largest loss:");
    for (std::size_t i = 1; i < schedules.size(); ++i) {
        const auto* const largest =
            std::ranges::max_element(losses, {}, [&](const Loss& loss) { return loss.of(schedules[i]); });
        fmt::print("{} on {} threads {} ({:.1f} %)", i > 1 ? ";" : "", thread_counts[i], largest->name,
                   percent(i, largest->of(schedules[i])));
    }
    fmt::print(".\n");
}

void print_policies(const std::vector<SearchWork>& all, double wake_s) {
    fmt::print(
        "\n### Other schedules, in simulation\n\nThe speed-up over one thread of the schedule as it is; all "
        "problems. The rows marked \"same\" plan the same bytes as today. For the others the simulation assumes that "
        "they do "
        "the same work, though edges in flight together cannot know of each other.\n\n"
        "| schedule | bytes {}",
        headline());
    const double base_s = simulated(all, {}).wall_s;
    struct Row {
        const char* name;
        const char* bytes;
        SchedulePolicy policy;
    };
    const auto with = [](auto set) {
        SchedulePolicy policy;
        set(policy);
        return policy;
    };
    using P = SchedulePolicy;
    const std::vector<Row> rows{
        {"as it is", "same", {}},
        {"two tasks of a round at a time", "same", with([](P& p) { p.max_workers = 2; })},
        {"certificates chunk by chunk", "same", with([](P& p) { p.flies_ahead = false; })},
        {"direct flights before certificates", "same", with([](P& p) { p.flies_beside = false; })},
        {"all three of these, as before", "same",
         with([](P& p) { p.max_workers = 2, p.flies_ahead = false, p.flies_beside = false; })},
        {"80 % of the serial work of tree and refinement divided", "same", with([](P& p) { p.divided_share = 0.8; })},
        {"batches of 2 steps flown as one", "differ", with([](P& p) { p.steps_merged = 2; })},
        {"batches of 4 steps flown as one", "differ", with([](P& p) { p.steps_merged = 4; })},
        {"2 steps of a task in flight", "differ", with([](P& p) { p.steps_in_flight = 2; })},
        {"4 steps of a task in flight", "differ", with([](P& p) { p.steps_in_flight = 4; })},
        {"8 steps of a task in flight", "differ", with([](P& p) { p.steps_in_flight = 8; })},
        {"rounds 4 times as long", "differ", with([](P& p) { p.rounds_merged = 4; })},
        {"rounds 4 times as long, 8 steps in flight", "differ",
         with([](P& p) { p.rounds_merged = 4, p.steps_in_flight = 8; })},
    };
    for (const Row& row : rows) {
        fmt::print("| {} | {} |", row.name, row.bytes);
        for (const int threads : thread_counts) {
            SchedulePolicy policy = row.policy;
            policy.threads = threads;
            policy.wake_s = wake_s;
            fmt::print(" {:.2f} |", base_s / simulated(all, policy).wall_s);
        }
        fmt::print("\n");
    }
}

void run(const Given& given) {
    const double load = system_load();
    const Problem first = read_problem(given.problems.front());
    const double wake_s = measured_wake_s(*make_flight_model(first), first);
    fmt::print(
        "# Threads of a search\n\nCommit {}; {}. MP-ARM-ADA, seeds 1 to {}, aero maps ready. `bench/threads.sh` writes "
        "this page. When it began, the load of the machine was "
        "{:.2f}. A thread that waits for a batch takes {:.0f} us to begin and report.\n\n"
        "Each search is recorded on one thread: how long its serial work takes and how many ticks each flight of each "
        "batch has, by processor time. The simulation deals this work out to threads as the planner does: tasks of a "
        "round "
        "to workers, flights to the lanes of each thread. It does not know that threads share caches and memory, so it "
        "promises a little too much. The plans and counts of all searches were the same, recorded or not, on one "
        "thread and on "
        "two.\n\n",
        source_commit(), processor(), given.seeds, load, 1e6 * wake_s);
    for (const bool in_worlds : {true, false}) {
        std::vector<Measured> problems;
        std::vector<SearchWork> all;
        for (const std::string& file : given.problems) {
            problems.push_back(measured(file, in_worlds, given));
            all.insert(all.end(), problems.back().searches.begin(), problems.back().searches.end());
        }
        fmt::print("## {}: {} iterations\n\n",
                   in_worlds ? "In worlds, with the problems' own uncertainty" : "In the nominal world",
                   in_worlds ? given.iterations : given.nominal_iterations);
        print_measured(problems, wake_s);
        print_shares(problems);
        print_simulated(problems, all, wake_s);
        print_policies(all, wake_s);
        fmt::print("\n");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Given given;
    CLI::App program("What more threads bring to a search, as Markdown");
    program.add_option("PROBLEM", given.problems, "problem files")->required();
    program.add_option("--iterations", given.iterations, "of each search in worlds")->check(CLI::Range(50, 1000000));
    program.add_option("--nominal-iterations", given.nominal_iterations, "the same in the nominal world")
        ->check(CLI::Range(50, 1000000));
    program.add_option("--seeds", given.seeds, "of each problem, from 1")->check(CLI::Range(1, 1000));
    return run_program(program, argc, argv, [&given] { run(given); });
}
