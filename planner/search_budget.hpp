#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "downwash/problems/problem.hpp"
#include "downwash/search/search_record.hpp"

namespace downwash::planning {

/// What is left of a search's limits.
class SearchBudget {
 public:
    explicit SearchBudget(const PlannerSettings& settings) : iterations_(settings.max_iterations) {
        if (settings.time_limit_s || !settings.max_iterations) {
            time_s_ = settings.time_limit_s.value_or(default_time_limit_s);
        }
    }

    /// A part of what is left. Where iterations are limited they alone are divided: how far each part gets then does
    /// not depend on how fast the machine is.
    [[nodiscard]] SearchBudget part(double share) const {
        SearchBudget some = *this;
        if (iterations_) {
            some.iterations_ = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(*iterations_)));
        } else {
            some.time_s_ = share * time_s_;
        }
        return some;
    }

    /// This budget, but no more than another one.
    [[nodiscard]] SearchBudget at_most(const SearchBudget& other) const {
        SearchBudget less = *this;
        if (iterations_) {
            less.iterations_ = std::min(*iterations_, *other.iterations_);
        }
        less.time_s_ = std::min(time_s_, other.time_s_);
        return less;
    }

    /// This budget, or another one where that is more.
    [[nodiscard]] SearchBudget at_least(const SearchBudget& other) const {
        SearchBudget more = *this;
        if (iterations_) {
            more.iterations_ = std::max(*iterations_, *other.iterations_);
        }
        more.time_s_ = std::max(time_s_, other.time_s_);
        return more;
    }

    /// This budget, but no more than so many seconds; one of iterations stays.
    [[nodiscard]] SearchBudget within_s(double most_s) const {
        SearchBudget less = *this;
        if (!iterations_) {
            less.time_s_ = std::min(time_s_, most_s);
        }
        return less;
    }

    /// This budget, but at least so many seconds; one of iterations stays.
    [[nodiscard]] SearchBudget at_least_s(double least_s) const {
        SearchBudget more = *this;
        if (!iterations_) {
            more.time_s_ = std::max(time_s_, least_s);
        }
        return more;
    }

    /// This budget, but at least so many iterations; one of time stays.
    [[nodiscard]] SearchBudget at_least_iterations(std::uint64_t least) const {
        SearchBudget more = *this;
        if (iterations_) {
            more.iterations_ = std::max(*iterations_, least);
        }
        return more;
    }

    /// Time that is left [s]; infinite without a limit of it.
    [[nodiscard]] double time_s() const { return time_s_; }

    /// What part of this budget some work took; at most 1.
    [[nodiscard]] double share_of(const SearchRecord& work) const {
        const double share = iterations_ ? static_cast<double>(work.iterations) / static_cast<double>(*iterations_)
                                         : work.wall_s / time_s_;
        return std::min(share, 1.0);
    }

    /// What part of this budget was spent until another one was left of it.
    [[nodiscard]] double share_between(const SearchBudget& left) const {
        SearchRecord spent;
        spent.iterations = iterations_ ? *iterations_ - *left.iterations_ : 0;
        spent.wall_s = time_s_ - left.time_s_;
        return share_of(spent);
    }

    void limit(PlannerSettings& settings) const {
        constexpr double min_s = 1e-6;
        settings.max_iterations = iterations_;
        settings.time_limit_s = std::isfinite(time_s_) ? std::optional(std::max(min_s, time_s_)) : std::nullopt;
    }

    /// Charges a search that found nothing with the whole budget: it may have ended before, and more would not help.
    void charge(SearchRecord& work) const {
        if (iterations_) {
            work.iterations = std::max(work.iterations, *iterations_);
        } else {
            work.wall_s = std::max(work.wall_s, time_s_);
        }
    }

    void spend(const SearchRecord& work) {
        if (iterations_) {
            *iterations_ -= std::min(*iterations_, work.iterations);
        }
        time_s_ -= work.wall_s;
    }

    [[nodiscard]] bool is_used_up() const { return time_s_ <= 0 || (iterations_ && *iterations_ == 0); }

 private:
    std::optional<std::uint64_t> iterations_;
    double time_s_ = std::numeric_limits<double>::infinity();
};

/// Adds the work of a part of a search, whatever came of it.
inline void add_work(SearchRecord& sum, const SearchRecord& part) {
    sum.wall_s += part.wall_s;
    sum.iterations += part.iterations;
    sum.edges_simulated += part.edges_simulated;
    sum.simulated_s += part.simulated_s;
    sum.states_checked += part.states_checked;
    for (const auto& [cause, count] : part.rejected) {
        sum.rejected[cause] += count;
    }
    for (const auto& [obstacle, count] : part.stopped_by) {
        sum.stopped_by[obstacle] += count;
    }
    sum.candidates.checked += part.candidates.checked;
    sum.candidates.failed_execution += part.candidates.failed_execution;
    sum.candidates.failed_certificate += part.candidates.failed_certificate;
    sum.candidates.worse_stops += part.candidates.worse_stops;
    sum.candidates.unfinished += part.candidates.unfinished;
}

/// Notes when a part of a search found its first plans, unless one before did.
/// @param begun_at_s wall time of the whole at which the part began
inline void note_first_plans(SearchRecord& whole, const SearchRecord& part, double begun_at_s) {
    if (!whole.first_solution_wall_s && part.first_solution_wall_s) {
        whole.first_solution_wall_s = begun_at_s + *part.first_solution_wall_s;
    }
    if (!whole.first_certified_wall_s && part.first_certified_wall_s) {
        whole.first_certified_wall_s = begun_at_s + *part.first_certified_wall_s;
    }
}

}  // namespace downwash::planning
