// An inspection mission in space: targets in any order with one battery, and back. The planner makes one certified
// flight to all targets if it finds one, and else several that begin and end at safe stops. On the way a sensor finds
// an obstacle 5 cm lower than the drawing has it, and the vehicle goes on along a plan from the middle of its flight.
// An independent judge flies every flight among the true obstacles. mission.py is the same in Python. Usage: mission
// PROBLEM.yaml OBSTACLE [ITERATIONS]
//   ITERATIONS: of each search, which makes a mission repeatable; default: 120 s before a flight, and in flight 0.4 s
// Exit codes: 0 all targets seen and all flights good, 1 not all of them, 2 bad input.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <downwash/base/key_error.hpp>
#include <downwash/judge/space_plan_judge.hpp>
#include <downwash/planner/planner.hpp>
#include <downwash/problems/space_problem_reader.hpp>

using namespace downwash;

namespace {

constexpr double lower_m = 0.05;  ///< than on the drawing
constexpr double sight_m = 1.5;   ///< of the sensor, from the multirotor's centre of mass
constexpr double sensor_period_s = 0.1;
constexpr double lead_s = 0.5;          ///< from what the sensor says to the first tick of the new plan
constexpr double planning_share = 0.8;  ///< of the lead, for planning
constexpr double on_ground_s = 120;     ///< for the plan of a flight

/// The obstacle of that name, which has to be a box.
Obstacle& obstacle_in(SpaceProblem& problem, const std::string& name) {
    const auto found = std::ranges::find(problem.obstacles, name, &Obstacle::name);
    if (found == problem.obstacles.end() || !std::holds_alternative<Box>(found->shape)) {
        throw_input_error("has no box called '" + name + "'", "environment.obstacles");
    }
    return *found;
}

/// From a place to a box whose edges are along the axes [m].
double distance_m(const Vector3& at_m, const Obstacle& box) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double half_m = 0.5 * std::get<Box>(box.shape).size_m[i];
        const double beyond_m = std::max(0.0, std::abs(at_m[i] - box.center_world_m[i]) - half_m);
        square += beyond_m * beyond_m;
    }
    return std::sqrt(square);
}

std::string numbers_of(const std::vector<std::size_t>& targets) {
    std::string text;
    for (const std::size_t target : targets) {
        text += " " + std::to_string(target + 1);
    }
    return text;
}

/// A vehicle that hovers where a plan ends.
SpaceStart hovering_at_end(const SpacePlan& plan) {
    const double* at = plan.reference.back().point.position;
    SpaceStart start;
    start.position_m = {at[space::x], at[space::y], at[space::z]};
    start.yaw_rad = at[space::yaw];
    start.joints_rad.assign(at + space::first_joint, at + space::first_joint + plan.joints);
    return start;
}

SpaceGoal hover_at(const SpaceStart& start) {
    SpaceGoal goal;
    goal.kind = SpaceConfigurationGoal{start.position_m[0], start.position_m[1], start.position_m[2], start.yaw_rad,
                                       start.joints_rad};
    return goal;
}

class Mission {
 public:
    Mission(const SpaceProblem& drawing, const std::string& obstacle)
        : drawing_(drawing), believed_(drawing), truth_(drawing), name_(obstacle) {
        if (!drawing.in_any_order || !drawing.return_to) {
            throw_input_error("is no mission: expected in_any_order and return_to", "goal");
        }
        obstacle_in(truth_, name_).center_world_m[2] -= lower_m;
        for (std::size_t i = 0; i < drawing.goals.size(); ++i) {
            left_.push_back(i);
        }
    }

    /// @return whether all targets were seen and all flights were good
    bool run() {
        std::vector<std::size_t> asked = left_;
        while (!asked.empty()) {
            if (const auto found = plan_to(asked)) {
                fly(asked, *found);
                asked = left_;
            } else if (asked.size() > 1) {
                std::printf("no certified flight to the targets%s: fewer at once\n", numbers_of(asked).c_str());
                asked.resize((asked.size() + 1) / 2);
            } else {
                std::printf("no certified flight to target%s\n", numbers_of(asked).c_str());
                std::erase(left_, asked.front());
                asked = left_;
            }
        }
        std::printf("%zu of %zu targets seen in %d flights, of which %d good\n", seen_, drawing_.goals.size(), flights_,
                    good_);
        return seen_ == drawing_.goals.size() && good_ == flights_;
    }

 private:
    /// A flight to some of the targets, from where the vehicle is, and back. It visits one at least.
    std::optional<SpaceSearchResult> plan_to(const std::vector<std::size_t>& asked) {
        believed_.goals.clear();
        for (const std::size_t target : asked) {
            believed_.goals.push_back(drawing_.goals[target]);
        }
        planner_ = std::make_unique<SpacePlanner>(believed_, SpaceSolveOptions{.stop_at_first_solution = true});
        const SpaceSearchResult& found = planner_->solve();
        const bool is_good = found.status == Status::solved && found.order && !found.order->visits.empty();
        return is_good ? std::optional(found) : std::nullopt;
    }

    void fly(const std::vector<std::size_t>& asked, const SpaceSearchResult& found) {
        std::vector<std::size_t> visits;
        for (const Visit& visit : found.order->visits) {
            visits.push_back(asked[visit.target]);
        }
        const SpacePlan& first = *found.plan;
        std::printf("flight %d: %.2f s to the targets%s\n", ++flights_, first.duration_s(), numbers_of(visits).c_str());
        if (const auto& certificate = found.certificate) {
            std::printf("          certificate: %llu failures in %llu worlds\n",
                        static_cast<unsigned long long>(certificate->failures),
                        static_cast<unsigned long long>(certificate->worlds));
        }
        const std::vector<SpaceGoal> goals = planner_->problem().goals;  // in their order, and the place to return to
        const auto seen_at = knows_ ? std::nullopt : obstacle_seen(first, goals);
        if (!seen_at) {
            judge(first, goals, visits);
            return;
        }
        knows_ = true;
        const SpaceAnswer answer = replan(first, *seen_at);
        const std::int64_t from = *seen_at + ticks(lead_s, first);
        const SpacePlan flown = first.beginning(from).followed_by(answer.plan);
        if (answer.advice == Advice::keep || answer.advice == Advice::follow) {
            judge(flown, goals, visits);
        } else {
            // The goals that are left are those after the visited ones.
            const std::size_t visited = goals.size() - planner_->problem().goals.size();
            visits.resize(visited);
            std::vector<SpaceGoal> short_goals(goals.begin(), goals.begin() + static_cast<std::ptrdiff_t>(visited));
            short_goals.push_back(hover_at(hovering_at_end(flown)));
            judge(flown, short_goals, visits, false);
            believed_.start = hovering_at_end(flown);
        }
    }

    /// The tick of a plan at which the sensor first sees the obstacle.
    std::optional<std::int64_t> obstacle_seen(const SpacePlan& plan, const std::vector<SpaceGoal>& goals) {
        const SpaceFlight flight = SpaceProblemModel(flown_problem(goals)).execute(plan);
        const Obstacle& obstacle = obstacle_in(truth_, name_);
        for (std::size_t tick = 0; tick < flight.rows.size(); tick += ticks(sensor_period_s, plan)) {
            if (distance_m(flight.rows[tick].motion.position_m, obstacle) < sight_m) {
                return static_cast<std::int64_t>(tick);
            }
        }
        return std::nullopt;
    }

    SpaceAnswer replan(const SpacePlan& plan, std::int64_t seen_at) {
        const double seen_s = static_cast<double>(seen_at) * plan.tick_s;
        std::printf("%8.2f s  %s is %.3f m lower than on the drawing\n", seen_s, name_.c_str(), lower_m);
        obstacle_in(believed_, name_) = obstacle_in(truth_, name_);
        SpaceSceneChange change;
        change.put = {obstacle_in(truth_, name_)};
        SpaceReplanOptions how;
        how.max_iterations = drawing_.planner.max_iterations;
        if (!how.max_iterations) {
            how.time_limit_s = planning_share * lead_s;
        }
        how.on_answer = [seen_s](const SpaceAnswer& answer) {
            const double* end = answer.plan.reference.back().point.position;
            std::printf("%8.2f s  %s: %.2f s to (%.3f, %.3f, %.3f) m\n", seen_s,
                        std::string(name_of(answer.advice)).c_str(), answer.plan.duration_s(), end[space::x],
                        end[space::y], end[space::z]);
        };
        const std::int64_t from = seen_at + ticks(lead_s, plan);
        return planner_->replan(planner_->predicted(believed_.start, plan, from), from, change, how);
    }

    /// Flies a plan among the true obstacles, and keeps account of targets and battery.
    /// @param is_back whether it leads home, where there is a fresh battery
    void judge(const SpacePlan& plan, const std::vector<SpaceGoal>& goals, const std::vector<std::size_t>& visits,
               bool is_back = true) {
        const judge::SpaceJudgedFlight flight = judge::SpacePlanJudge(flown_problem(goals)).fly(plan);
        std::printf("%8.2f s  %s, least clearance %.3f m, %.1f of %.1f kJ\n", flight.duration_s,
                    std::string(name_of(flight.outcome)).c_str(), flight.min_clearance_m, 1e-3 * flight.energy_j,
                    1e-3 * believed_.energy_budget_j.value_or(INFINITY));
        if (flight.outcome == judge::Outcome::ok) {
            ++good_;
            seen_ += visits.size();
        }
        for (const std::size_t target : visits) {
            std::erase(left_, target);
        }
        believed_.start = drawing_.start;
        if (believed_.energy_budget_j) {
            believed_.energy_budget_j =
                is_back ? *drawing_.energy_budget_j : *believed_.energy_budget_j - flight.energy_j;
        }
    }

    /// The true problem of a flight that begins where the vehicle is.
    [[nodiscard]] SpaceProblem flown_problem(const std::vector<SpaceGoal>& goals) const {
        SpaceProblem problem = truth_;
        problem.start = believed_.start;
        problem.energy_budget_j = believed_.energy_budget_j;
        problem.goals = goals;
        problem.in_any_order = false;
        problem.return_to.reset();
        return problem;
    }

    static std::int64_t ticks(double time_s, const SpacePlan& plan) { return std::llround(time_s / plan.tick_s); }

    const SpaceProblem drawing_;
    SpaceProblem believed_;  ///< with the vehicle where it is, and what is left in its battery
    SpaceProblem truth_;
    const std::string name_;         ///< of the obstacle
    bool knows_ = false;             ///< where the obstacle is
    std::vector<std::size_t> left_;  ///< targets that no flight has visited
    std::unique_ptr<SpacePlanner> planner_;
    std::size_t seen_ = 0;
    int flights_ = 0, good_ = 0;
};

}  // namespace

int main(int count, char** words) {
    if (count != 3 && count != 4) {
        std::fprintf(stderr, "usage: %s PROBLEM.yaml OBSTACLE [ITERATIONS]\n", words[0]);
        return 2;
    }
    try {
        SpaceProblem drawing = read_space_problem(words[1]);
        drawing.planner.max_iterations.reset();
        drawing.planner.time_limit_s = on_ground_s;
        if (count == 4) {
            drawing.planner.max_iterations = std::stoull(words[3]);
            drawing.planner.time_limit_s.reset();
        }
        return Mission(drawing, words[2]).run() ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
