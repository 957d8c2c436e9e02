#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/course.hpp"
#include "downwash/planner/leg_estimates.hpp"
#include "downwash/planner/order_search.hpp"
#include "downwash/planner/search_budget.hpp"
#include "downwash/planner/solve_options.hpp"
#include "downwash/problems/visit_order.hpp"

namespace downwash::planning {

/// What the ways between the start, the targets with their alternatives, and the place to return to cost. A leg is
/// flown by a short search from the vehicle that hovers where the first leg to its place ended. Before it is flown, in
/// the plane its cost is a lower bound: that of straight motion in free air to the goal region, and the hold there. In
/// space it is what the way of the level vehicle around obstacles takes, from corner to corner.
template <class Family>
class DOWNWASH_EXPORT LegTableOf {
 public:
    using Problem = typename Family::Problem;
    using Goal = typename Family::Goal;
    using Configuration = typename Family::Configuration;
    using PlannerModel = PlannerModelOf<Family>;
    using SolveOptions = SolveOptionsOf<Family>;
    using Course = CourseOf<Family>;

    /// @param problem with targets   @param options for threads and stop   @pre all outlive it
    LegTableOf(const Problem& problem, const PlannerModel& model, const SolveOptions& options);
    ~LegTableOf();
    LegTableOf(const LegTableOf&) = delete;
    LegTableOf& operator=(const LegTableOf&) = delete;

    /// Costs of the legs that were flown in this pass, and estimates of the others; legs to which no flight was found
    /// are infinite.
    [[nodiscard]] const LegCosts& estimates() const noexcept { return estimates_; }
    /// The same with lower bounds of the legs that were not flown.
    [[nodiscard]] const LegCosts& at_least() const noexcept { return at_least_; }
    /// The cheapest flights of all passes alone: other legs are infinite.
    [[nodiscard]] LegCosts flown_costs() const;
    /// The cheapest flights of all passes, with estimates of the legs that have none.
    [[nodiscard]] LegCosts likely_costs() const { return flown_or(estimates_); }
    /// The cheapest flights of all passes, with lower bounds of the legs that have none.
    [[nodiscard]] LegCosts lower_bounds() const { return flown_or(at_least_); }
    /// Begins a pass: legs are to be flown anew, those that were not found are not.
    void begin_pass();

    /// Whether a leg was flown in this pass, or is none.
    [[nodiscard]] bool is_known(std::size_t from, std::size_t to) const;
    /// Legs that were flown.
    [[nodiscard]] std::uint64_t legs_flown() const noexcept { return legs_flown_; }

    /// Searches for a flight along a leg in the nominal world. The vehicle starts as it hovers after the first leg to
    /// the place where this leg begins; without such a leg nothing is searched. After two failed searches the leg
    /// counts as infinite. Where the time is over before the direct flight of a plan, the planner's own cost counts.
    /// @param budget of the search, doubled for each one that failed before   @param most_s it takes no more time [s]
    /// @return the work of the search; whether there is a flight, is_known() tells
    SearchRecord fly(std::size_t from, std::size_t to, const SearchBudget& budget, double most_s);

    /// Allows one more search for each leg that counts as infinite. @return whether there is one
    bool search_on();

    /// A flight along this leg was tried in vain from where others ended.
    void give_up(std::size_t from, std::size_t to);
    /// Legs to a place that were not flown yet count as infinite until search_on(): the ways to it take long to find.
    void put_off(std::size_t to);

    /// How a leg is likely to be flown; nothing is known of it in the plane.
    [[nodiscard]] ExpectedLegOf<Family> expected(std::size_t from, std::size_t to) const;

    [[nodiscard]] Visit visit_at(std::size_t place) const { return places_[place].visit; }
    /// Whether no leg to a target can be flown.
    [[nodiscard]] bool is_out_of_reach(std::size_t target) const;

 private:
    struct Place {
        Visit visit;
        Goal goal;
        Configuration at;             ///< place in the goal region, until a leg ends there
        std::optional<Course> hover;  ///< hover at the end of the first leg to it
    };
    struct LegState {
        bool is_known = false;  ///< whether the leg is known in this pass
        int failures = 0;
        bool is_given_up = false;
        LegCost flown = {};  ///< the cheapest flight of all passes; infinite without one
    };

    [[nodiscard]] std::size_t number_of(std::size_t from, std::size_t to) const {
        return from * (estimates_.outside() + 1) + to;
    }
    [[nodiscard]] LegState& leg(std::size_t from, std::size_t to) { return legs_[number_of(from, to)]; }
    [[nodiscard]] const LegState& leg(std::size_t from, std::size_t to) const { return legs_[number_of(from, to)]; }
    [[nodiscard]] bool is_leg(std::size_t from, std::size_t to) const;
    /// Whether no further search for a leg is made.
    [[nodiscard]] bool is_closed(const LegState& state) const {
        return state.is_given_up || state.failures >= most_failures_;
    }
    void bound_legs_from(std::size_t from);
    /// A leg costs this, whatever was thought before.
    void set(std::size_t from, std::size_t to, const LegCost& cost);
    /// The cheapest flights in the place of other costs.
    [[nodiscard]] LegCosts flown_or(LegCosts costs) const;

    const Problem& problem_;
    const PlannerModel& model_;
    const SolveOptions& options_;
    std::vector<std::unique_ptr<LegBoundsOf<Family>>> bounds_;  ///< of the ways to each place
    std::vector<Place> places_;  ///< the last one is the place to return to, if there is one
    Course start_;
    std::vector<LegState> legs_;
    std::vector<ExpectedLegOf<Family>> expected_;  ///< numbered as legs; empty in the plane
    LegCosts estimates_, at_least_;
    std::uint64_t legs_flown_ = 0;
    int most_failures_ = 2;
    std::uint32_t pass_ = 0;  ///< number of the pass; in each one the searches draw other samples
};
using LegTable = LegTableOf<Plane>;

}  // namespace downwash::planning
