#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

#include "downwash/planner/certificate.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// What every search has in common: its limit of time, its record, and whom it tells.
class SearchClock {
 public:
    /// @param check_time_s how long after the beginning a check of a plan may end, if that is more than the limit [s]
    template <class Family>
    SearchClock(const PlannerSettings& settings, const SolveOptionsOf<Family>& options, double check_time_s = 0)
        : stop_(options.stop),
          on_progress_(options.on_progress),
          stops_at_first_(options.stop_at_first_solution),
          confidence_(settings.confidence) {
        if (settings.time_limit_s || !settings.max_iterations) {
            limit_s_ = settings.time_limit_s.value_or(default_time_limit_s);
            check_limit_s_ = std::max(*limit_s_, check_time_s);
        }
    }

    SearchRecord record;  ///< how the search goes

    /// Since construction [s].
    [[nodiscard]] double seconds() const { return clock_.seconds(); }

    /// Whether time, the caller or a first solution ends the search. Long work asks it all the time, from any thread:
    /// solve()'s own tells the caller how the search goes.
    [[nodiscard]] bool is_over() { return is_over_at(limit_s_); }
    /// The same for a check of a plan that has begun.
    [[nodiscard]] bool is_over_for_checks() { return is_over_at(check_limit_s_); }

    /// The planner's own model has accepted a plan.
    void found_first(double at_s) {
        if (!record.first_solution_wall_s) {
            record.first_solution_wall_s = at_s;
        }
    }

    /// A better plan counts.
    void improved(double at_s, double cost, std::uint64_t iteration, std::optional<double> flown_cost) {
        record.improvements.push_back({at_s, iteration, cost, flown_cost});
    }

    /// A plan is flown in worlds: how many so far, and in how many it failed. From any thread.
    void certifies(std::uint64_t worlds, std::uint64_t failures) {
        certified_in_ = worlds;
        failed_in_ = failures;
        is_certifying_ = true;
    }
    /// That is over.
    void has_certified() { is_certifying_ = false; }

    /// How far the search has come.
    void note(std::uint64_t iterations, std::uint64_t nodes, std::uint64_t rejected) {
        progress_.iterations = iterations;
        progress_.nodes = nodes;
        progress_.rejected = rejected;
        report();
    }

 private:
    [[nodiscard]] bool is_over_at(const std::optional<double>& limit_s) {
        if (std::this_thread::get_id() == thread_) {
            report();
        }
        return stop_.stop_requested() || (limit_s && clock_.seconds() >= *limit_s) ||
               (stops_at_first_ && !record.improvements.empty());
    }

    /// Tells the caller how the search goes, ten times a second.
    void report() {
        constexpr double period_s = 0.1;
        const double now_s = clock_.seconds();
        if (!on_progress_ || now_s < progress_.wall_s + period_s) {
            return;
        }
        progress_.wall_s = now_s;
        const auto& improvements = record.improvements;
        progress_.best_cost = improvements.empty() ? std::nullopt : std::optional(improvements.back().cost);
        progress_.worlds = is_certifying_ ? std::optional(certified_in_.load()) : std::nullopt;
        progress_.failures = failed_in_;
        progress_.failure_bound = failure_interval(failed_in_, certified_in_, confidence_).high;
        on_progress_(progress_);
    }

    std::stop_token stop_;
    std::function<void(const Progress&)> on_progress_;
    bool stops_at_first_;
    double confidence_;
    Stopwatch clock_;
    std::optional<double> limit_s_, check_limit_s_;
    Progress progress_;  ///< as reported last
    std::atomic<bool> is_certifying_ = false;
    std::atomic<std::uint64_t> certified_in_ = 0, failed_in_ = 0;
    std::thread::id thread_ = std::this_thread::get_id();
};

}  // namespace downwash::planning
