#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/leg_estimates.hpp"
#include "downwash/planner/search_budget.hpp"
#include "downwash/planner/search_result.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/problem.hpp"

namespace downwash::planning {

/// How a sequence of searches uses its limits, and what is known before.
template <class Family>
struct SequenceEffortOf {
    double min_round = 0;  ///< share of the limits that a round after the first takes at least
    /// Where energy is limited: there is plenty of it, so that the first plan of each part will do.
    bool has_energy_to_spare = false;
    /// Where energy is limited: the last part ends with its first plan, too, which makes the whole way one.
    bool ends_with_first_plan = false;
    /// It ends when the searches for the way to one goal took all this in vain, until there is a whole way.
    std::optional<SearchBudget> patience;
    /// In space, for each goal, or empty: the first search for it grows along the way that is expected, and goes on
    /// until its plan costs not much more; later ones grow along ways that were found before.
    std::vector<ExpectedLegOf<Family>> expected;
};
using SequenceEffort = SequenceEffortOf<Plane>;

/// What the first search for each part gets at least where iterations are limited: of fewer nobody learns whether there
/// is a way. In the plane every share counts, however small.
template <class Family>
constexpr std::uint64_t min_iterations_of_part = 0;
template <>
constexpr std::uint64_t min_iterations_of_part<Space> = 24;

/// Plans goals in their order with one search for each, from the whole vehicle that holds at the goal before: in a
/// first round until there is a whole way, then in rounds that take twice as long each, for cheaper ways. Where the
/// flights of a plan fail on the way to an earlier goal, the search goes back to that goal. More of a round's time goes
/// to the parts that became cheaper in the one before. The order is kept, and every part is found by itself: the whole
/// is not the best of all ways through the goals. If no round finds a whole way, what there is of one is `approximate`.
///
/// The sequence says what to search for next and takes what was found:
///
///     while (const auto next = sequence.next()) {
///         sequence.add(search_goal(next->problem, ...));
///     }
template <class Family>
class DOWNWASH_EXPORT GoalSequenceOf {
 public:
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using Found = FoundOf<Family>;
    using SearchResult = SearchResultOf<Family>;
    using Course = CourseOf<Family>;
    using PlannerModel = PlannerModelOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using FoundPlan = FoundPlanOf<Family>;
    using SequenceEffort = SequenceEffortOf<Family>;
    using Configuration = typename Family::Configuration;

    /// @param attempts plans that asked for a certificate before   @pre problem, model and options outlive it
    GoalSequenceOf(const Problem& problem, const PlannerModel& model, const SolveOptions& options,
                   const SequenceEffort& effort, std::uint64_t attempts);
    GoalSequenceOf(const GoalSequenceOf&) = delete;
    GoalSequenceOf& operator=(const GoalSequenceOf&) = delete;

    /// A search for the way to the next goal.
    struct Part {
        Problem problem;       ///< problem with a single goal, the limits and the seed of this search
        const Course* before;  ///< course at whose end the search begins, until add()
        SolveOptions options;  ///< report its progress as that of the whole
        double check_time_s;   ///< PlanChecks::time_s of this search
    };
    /// The next search; empty when all is done.
    [[nodiscard]] std::optional<Part> next();
    /// Takes what the search of the last next() came to.
    void add(SearchResult part);
    /// What all searches came to.
    [[nodiscard]] SearchResult result() &&;

 private:
    /// One try to find a whole way.
    struct Round {
        SearchBudget left;
        std::vector<Course> courses;                        ///< before each part, the one that is searched for included
        Found way;                                          ///< as far as it has come
        std::vector<double> part_costs;                     ///< costs of the parts that were found
        std::vector<std::vector<Configuration>> part_ways;  ///< in space, of each of these: the corners of its plan
    };

    [[nodiscard]] bool is_over() const { return left_.is_used_up() || options_.stop.stop_requested(); }
    [[nodiscard]] bool has_way() const { return best_.status == Status::solved; }
    [[nodiscard]] Round new_round(const SearchBudget& budget) const;
    [[nodiscard]] bool goes_on_after(SearchResult part);
    [[nodiscard]] bool go_back(std::size_t part);
    [[nodiscard]] bool give_up(bool came_nearer);
    [[nodiscard]] bool expects_ways() const { return !effort_.expected.empty(); }
    [[nodiscard]] bool is_thrifty() const { return problem_.energy_budget_j && !effort_.has_energy_to_spare; }
    void end_round();
    [[nodiscard]] SearchBudget budget_of(std::size_t part) const;
    [[nodiscard]] SolveOptions options_of_part();
    void use_what_is_known(std::size_t goal, SolveOptions& options);
    [[nodiscard]] double share(std::size_t part) const;
    [[nodiscard]] double cost_when_flown(const Found& way) const {
        return planning::cost_when_flown(way, problem_.planner.objective);
    }
    [[nodiscard]] bool is_better(const Found& way) const;
    void note_improvements(const Course& before, const SearchRecord& last, double begun_at_s,
                           std::uint64_t iterations_before);
    void keep_if_farther();
    void keep(Round round);

    const Problem& problem_;
    const PlannerModel& model_;
    const SolveOptions& options_;
    SequenceEffort effort_;
    std::vector<Goal> goals_;
    /// Number of searches for the way to each goal so far; each draws other samples.
    std::vector<std::uint32_t> searches_;
    std::vector<std::uint32_t> given_up_;                ///< how many of these took too long
    std::vector<SearchRecord> vain_;                     ///< what these took together
    std::vector<std::vector<Configuration>> left_ways_;  ///< of parts that were found before it went back
    std::optional<std::size_t> hard_goal_;               ///< the goal that patience ended at
    SearchBudget whole_;
    SearchBudget left_;
    SearchBudget part_budget_;  ///< budget of the search that is going on
    std::size_t number_ = 1;    ///< number of the round that is going on
    bool is_last_ = false;      ///< there will be no other round
    bool is_done_ = false;
    SearchRecord round_work_;  ///< what the round that is going on may take
    Round round_;              ///< round that is going on
    Found best_;               ///< the best way so far or, without one, the farthest
    SearchRecord record_;
    std::uint64_t attempts_;                             ///< plans that asked for a certificate
    std::uint64_t nodes_before_ = 0;                     ///< of the searches that are over
    std::uint64_t nodes_of_part_ = 0;                    ///< of the search that is going on, as it told last
    std::vector<double> part_costs_;                     ///< costs of the parts of the best way
    std::vector<std::vector<Configuration>> part_ways_;  ///< and their corners
    std::vector<double> gains_;  ///< by how much each part became cheaper when the best way last did
    double told_cost_ = std::numeric_limits<double>::infinity();  ///< cost of the best way that the caller knows
};
using GoalSequence = GoalSequenceOf<Plane>;

}  // namespace downwash::planning
