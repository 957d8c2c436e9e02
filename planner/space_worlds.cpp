#include "downwash/planner/space_worlds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/planner/braking_parts.hpp"
#include "downwash/planner/certificate_record.hpp"
#include "downwash/planner/family_parts.hpp"
#include "downwash/planner/search_quantiles.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash::planning {
namespace {

std::vector<double> quantiles_of_world(const SpaceRobot& robot, std::uint64_t number) {
    std::vector<DangerQuantiles> dangers;
    for (const SpaceWorldParameter* parameter : space_world_parameters_of(robot)) {
        dangers.push_back(parameter->danger);
    }
    return search_quantiles(dangers, dangers.size(), number);
}

/// The legs of a plan from one of its knots to another.
std::vector<SpaceFlightLeg> legs_of(const SpacePlan& plan, std::size_t first, std::size_t last) {
    std::vector<SpaceFlightLeg> legs;
    for (std::size_t knot = first + 1; knot <= last; ++knot) {
        legs.push_back({plan.segment_to(knot)});
    }
    return legs;
}

/// The ways to the hovers of a plan from one of its knots on, one after the other; the last hover lasts to the end of
/// the plan.
std::vector<SpaceProblemWorlds::Way> ways_to(const std::vector<SpaceGoalHover>& hovers, const SpacePlan& plan,
                                             std::size_t first) {
    std::vector<SpaceProblemWorlds::Way> ways;
    std::size_t knot = first;
    for (std::size_t i = 0; i < hovers.size(); ++i) {
        std::size_t last = plan.reference.size() - 1;
        if (i + 1 < hovers.size()) {
            const auto end = std::ranges::find(plan.reference, hovers[i].end_tick, &SpaceKnot::tick);
            last = static_cast<std::size_t>(end - plan.reference.begin());
        }
        if (last > first) {
            ways.push_back({i, std::exchange(knot, last), last});
        }
    }
    return ways;
}

/// Leaves out jobs that were rejected; the others go on where they have ended.
/// @param world_of of each job   @param on_rejected called with the world of each rejected job, and with the job
template <class OnRejected>
void keep_accepted(std::vector<SpaceFlightJob>& jobs, std::vector<std::size_t>& world_of,
                   const OnRejected& on_rejected) {
    std::vector<SpaceFlightJob> left;
    std::vector<std::size_t> worlds_left;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (jobs[i].rejection() != Rejection::none) {
            on_rejected(world_of[i], jobs[i]);
            continue;
        }
        left.push_back({jobs[i].end(), {}, jobs[i].world, jobs[i].first_tick});
        worlds_left.push_back(world_of[i]);
    }
    jobs = std::move(left);
    world_of = std::move(worlds_left);
}

/// Enough to tell which flights came nearest.
constexpr ClearanceError rough_clearance{0.1, 0.02};

/// Lets flights ask a condition as long as a call goes on.
class Asking {
 public:
    Asking(StopCondition& asked, const StopCondition& condition)
        : asked_(asked), before_(std::exchange(asked, condition)) {}
    ~Asking() { asked_ = std::move(before_); }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

 private:
    StopCondition& asked_;
    StopCondition before_;
};

}  // namespace

std::vector<SpaceWorld> search_worlds(const SpaceProblem& problem) {
    std::vector<SpaceWorld> worlds;
    for (std::uint64_t i = 1; i < problem.planner.worlds; ++i) {
        const std::uint64_t tape = simulation::mixed(~std::uint64_t{problem.planner.seed} ^ simulation::mixed(i));
        worlds.push_back(
            space_world_at(*problem.uncertainty, problem.robot, quantiles_of_world(problem.robot, i), tape));
    }
    return worlds;
}

SpaceProblemWorlds::SpaceProblemWorlds(const SpaceProblem& problem, const PlannerModelOf<Space>& model, int threads)
    : problem_(problem),
      model_(model),
      threads_(threads),
      among_surfaces_(problem.goals.size()),
      own_(problem.goals.size()),
      search_worlds_(problem.uncertainty ? search_worlds(problem) : std::vector<SpaceWorld>()),
      searching_(problem.goals.size()),
      screened_(problem.goals.size() + 1),
      refused_(problem.goals.size()) {
    for (const SpaceGoal& goal : problem.goals) {
        rules_.push_back(
            std::make_unique<SpaceGoalRule>(problem.robot, model.flight->shared_scene(), std::vector<SpaceGoal>{goal}));
    }
}

SpacePool& SpaceProblemWorlds::pool(std::size_t goal, bool among_surfaces) {
    auto& pools = among_surfaces ? among_surfaces_ : own_;
    const auto& map = among_surfaces ? model_.true_map : model_.own_map;
    if (pools[goal] == nullptr) {
        SpacePoolSetup setup{model_.flight->problem().robot};
        if (map != nullptr) {
            setup.aero = simulation::space_aero(problem_.aero, problem_.robot.rotor_radius_m);
            setup.volumes = map.get();
        }
        setup.checker = &model_.flight->collisions();
        setup.goal = rules_[goal].get();
        if (among_surfaces) {
            setup.finds_min_clearance = rough_clearance;
        }
        setup.is_over = [this] { return is_over_ && is_over_(); };
        pools[goal] = std::make_unique<SpacePool>(setup, threads_);
    }
    return *pools[goal];
}

SpaceWorld SpaceProblemWorlds::world(std::uint64_t index) const {
    return draw_space_world(*problem_.uncertainty, problem_.robot, problem_.planner.seed, index);
}

SpaceProblemWorlds::Vehicles SpaceProblemWorlds::starts_in(std::span<const SpaceWorld> worlds, bool among_surfaces) {
    const SpaceMotion motion = start_motion(problem_.start);
    SpacePool& flights = pool(0, among_surfaces);
    std::vector<SpaceWorld> quiet;
    quiet.reserve(worlds.size());
    std::vector<SpaceFlightJob> jobs;
    const SpacePoint here = at_rest(configuration_of(reference_at(problem_.start)));
    const double tick_s = 1 / problem_.robot.controller.rate_hz;
    const SpaceSegment hover(here, here, std::llround(settling_before_start_s / tick_s), tick_s);
    Vehicles vehicles;
    if (!is_at_rest(problem_.start)) {
        for (const SpaceWorld& world : worlds) {
            vehicles.emplace_back(flights.state_at(motion, &world, problem_.start.carry));
        }
        return vehicles;
    }
    for (const SpaceWorld& world : worlds) {
        quiet.push_back(without_noise(world));
        jobs.push_back({flights.state_at(motion, &quiet.back()), {{hover}}, &quiet.back()});
    }
    flights.fly(jobs);
    throw_if_over(is_over_);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        std::optional<AnySpaceState>& vehicle = vehicles.emplace_back();
        if (jobs[i].rejection() == Rejection::none) {
            vehicle = begun_in(jobs[i].end(), &worlds[i]);
            vehicle->plant.energy_j = 0;
        }
    }
    return vehicles;
}

SearchWorldsOf<Space> SpaceProblemWorlds::for_search(const CourseOf<Space>& before) {
    // Courses grow goal by goal: the fleet flies on from the farthest place where it was before.
    std::size_t known = before.goals.size() + 1;
    while (known > 0 && (searching_[known - 1].vehicles.empty() || !is_flown(searching_[known - 1], before.plan))) {
        --known;
    }
    FlownFleetOf<Space> fleet =
        known > 0 ? searching_[known - 1] : FlownFleetOf<Space>{{}, starts_in(search_worlds_, false), {}};
    advance(fleet.vehicles, before, fleet.reference.empty() ? 0 : fleet.reference.size() - 1, search_worlds_);
    fleet.reference = before.plan.reference;
    SearchWorldsOf<Space> search = worlds_of_search<Space>(search_worlds_, fleet.vehicles);
    searching_[before.goals.size()] = std::move(fleet);
    return search;
}

void SpaceProblemWorlds::advance(std::vector<SpaceFlightJob>& jobs, const SpacePlan& plan, const Way& way,
                                 bool is_certificate) {
    const SpaceKnot& at = plan.reference[way.last];
    for (SpaceFlightJob& job : jobs) {
        job.legs = legs_of(plan, way.first, way.last);
        job.judged_ticks = is_certificate ? std::llround(goal_settling_s / plan.tick_s) : 0;
    }
    pool(way.goal, is_certificate).fly(jobs);
    throw_if_over(is_over_);  // then some were interrupted
    for (SpaceFlightJob& job : jobs) {
        job.first_tick += at.tick - plan.reference[way.first].tick;
    }
    const SpaceGoalRule& rule = *rules_[way.goal];
    const SpaceGoalHover hover = rule.hover_at(0, at.point);
    if (!hover.touch) {
        return;
    }
    const auto& map = is_certificate ? model_.true_map : model_.own_map;
    run_parallel(jobs.size(), threads_, [&](std::size_t i) {
        SpaceFlightJob& job = jobs[i];
        if (job.rejection() == Rejection::none) {
            SpaceFlightLeg& last = job.legs.back();
            const SpaceTouchFlown touch = fly_touch(*model_.flight, map.get(), rule, hover, at.point, job.world,
                                                    job.first_tick, last.end, is_over_);
            last.flight.rejection = touch.rejection;
            job.first_tick += touch.ticks;
        }
    });
}

SpaceProblemWorlds::Vehicles SpaceProblemWorlds::vehicles_after(const CourseOf<Space>& before,
                                                                std::span<const SpaceWorld> worlds) {
    Vehicles vehicles = starts_in(worlds, false);
    advance(vehicles, before, 0, worlds);
    return vehicles;
}

void SpaceProblemWorlds::advance(Vehicles& vehicles, const CourseOf<Space>& before, std::size_t first,
                                 std::span<const SpaceWorld> worlds) {
    const SpacePlan& plan = before.plan;
    if (first + 1 >= plan.reference.size()) {
        return;
    }
    std::vector<SpaceFlightJob> jobs;
    std::vector<std::size_t> world_of;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (vehicles[i]) {
            jobs.push_back({*vehicles[i], {}, &worlds[i], plan.reference[first].tick});
            world_of.push_back(i);
        }
    }
    const SpaceGoalRule rule(problem_.robot, model_.flight->shared_scene(), before.goals);
    for (const Way& way : ways_to(rule.hovers(plan), plan, first)) {
        advance(jobs, plan, way, false);
        keep_accepted(jobs, world_of, [&](std::size_t world, const SpaceFlightJob&) { vehicles[world].reset(); });
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        vehicles[world_of[i]] = jobs[i].start;
    }
}

void SpaceProblemWorlds::advance(std::vector<SpaceFlightJob>& jobs, const SpacePlan& plan) {
    if (plan.reference.size() < 2) {
        return;
    }
    for (SpaceFlightJob& job : jobs) {
        job.legs = legs_of(plan, 0, plan.reference.size() - 1);
    }
    pool(0, true).fly(jobs);
}

std::vector<WorldSample> SpaceProblemWorlds::fly(const SpacePlan& plan, std::span<const SpaceWorld> worlds,
                                                 const StopCondition& is_over) {
    const Asking scope(is_over_, is_over);
    Vehicles vehicles = starts_in(worlds, true);
    return fly_on(vehicles, plan, 0, goals(), 1, worlds, is_over);
}

std::vector<CounterexampleOf<Space>> SpaceProblemWorlds::counterexamples(const Certificate& certificate,
                                                                         const CourseOf<Space>& before) {
    std::vector<SpaceWorld> worlds;
    for (const std::uint64_t index : failed_on_way_to(before.goals.size(), certificate)) {
        worlds.push_back(world(index));
    }
    return counterexamples_of<Space>(worlds, vehicles_after(before, worlds));
}

std::vector<WorldSample> SpaceProblemWorlds::fly_on(Vehicles& vehicles, const SpacePlan& plan, std::size_t first,
                                                    std::size_t visits, std::uint64_t first_world,
                                                    std::span<const SpaceWorld> worlds, const StopCondition& is_over) {
    const Asking scope(is_over_, is_over);
    const std::vector<SpaceGoal> goals(problem_.goals.begin(),
                                       problem_.goals.begin() + static_cast<std::ptrdiff_t>(visits));
    const SpaceGoalRule rule(problem_.robot, model_.flight->shared_scene(), goals);
    const std::vector<SpaceGoalHover> hovers = rule.hovers(plan);
    const SpacePlan held = plan.held_for(hovers.back().end_tick - plan.reference.back().tick);
    std::vector<WorldSample> samples(worlds.size());
    std::vector<SpaceFlightJob> jobs;
    std::vector<std::size_t> world_of;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        samples[i] = {first_world + i, Outcome::unstable, 0, 0, false};
        if (vehicles[i]) {
            jobs.push_back({*vehicles[i], {}, &worlds[i], plan.reference[first].tick});
            world_of.push_back(i);
            samples[i].outcome = Outcome::ok;
            samples[i].min_clearance_m = infinity;
            vehicles[i].reset();
        }
    }
    const auto measure = [&](WorldSample& sample, const SpaceFlightJob& job) {
        for (const SpaceFlightLeg& leg : job.legs) {
            sample.min_clearance_m = std::min(sample.min_clearance_m, leg.flight.min_clearance_m);
        }
    };
    for (const Way& way : ways_to(hovers, held, first)) {
        advance(jobs, held, way, true);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            measure(samples[world_of[i]], jobs[i]);
        }
        keep_accepted(jobs, world_of, [&](std::size_t world, const SpaceFlightJob& job) {
            WorldSample& sample = samples[world];
            sample.outcome = outcome_of(job.rejection());
            sample.goal = way.goal;
            sample.min_clearance_m = sample.outcome == Outcome::collision ? 0 : sample.min_clearance_m;
        });
    }
    const bool misses_a_goal = hovers.size() < visits;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        WorldSample& sample = samples[world_of[i]];
        if (misses_a_goal) {
            sample.outcome = Outcome::goal_missed;
            sample.goal = hovers.size();
        } else if (problem_.energy_budget_j && jobs[i].start.plant.energy_j > *problem_.energy_budget_j) {
            sample.outcome = Outcome::over_budget;
            sample.goal = visits - 1;
        } else {
            vehicles[world_of[i]] = jobs[i].start;
        }
    }
    return samples;
}

void SpaceProblemWorlds::fly_directly(const SpacePlan& plan, WorldSample& sample, const StopCondition& is_over) const {
    const SpaceGoalRule rule(problem_.robot, model_.flight->shared_scene(), problem_.goals);
    SpaceExecutionSettings settings;
    settings.world = world(sample.world);
    settings.goals = &rule;
    settings.is_over = is_over;
    const SpaceFlight flight = model_.flight->execute(plan, settings);
    sample.outcome = flight.outcome;
    sample.min_clearance_m = flight.min_clearance_m;
    const auto missed = std::ranges::find_if(flight.goals, [](const SpaceGoalVisit& visit) { return !visit.is_met; });
    sample.goal = missed != flight.goals.end() ? static_cast<std::size_t>(missed - flight.goals.begin()) : 0;
}

Certificate SpaceProblemWorlds::tested(const Test& test, const StopCondition& is_over, const WorldCounter& counter,
                                       CertificateRecord record) {
    constexpr std::uint64_t chunk = 64;  // a bad plan fails in the first of them
    // With direct aerodynamics: volumes are not the last word. A screening is none either.
    const std::size_t flown_again = test.fly_directly ? 2 : 0;
    bool is_checked = false;
    try {
        for (;;) {
            throw_if_over(is_over);
            if (counter) {
                counter(record.worlds(), record.failures());
            }
            const std::uint64_t wanted = record.worlds_wanted();
            if (wanted == 0) {
                if (!record.passes()) {
                    break;
                }
                std::vector<WorldSample> again = record.nearest_successes(flown_again);
                run_parallel(again.size(), threads_, [&](std::size_t i) { test.fly_directly(again[i]); });
                is_checked = !record.replace(again);
                if (is_checked) {
                    break;
                }
                continue;
            }
            std::vector<SpaceWorld> worlds;
            const std::uint64_t number = record.worlds();
            for (std::uint64_t i = 0; i < std::min(chunk, wanted); ++i) {
                worlds.push_back(world(test.first_world + number + i));
            }
            for (const WorldSample& sample : test.fly(number, worlds)) {
                record.add(sample);
            }
            record.give_up_if_hopeless();
        }
    } catch (const WorkStopped&) {  // it has what was flown so far
    }
    return record.certificate(is_checked);
}

Certificate SpaceProblemWorlds::certify(const SpacePlan& whole, std::uint64_t attempt, const StopCondition& is_over,
                                        const WorldCounter& counter) {
    const PlannerSettings& settings = problem_.planner;
    const std::uint64_t first_world = attempt * worlds_per_attempt;
    const auto fly = [&](std::uint64_t number, std::span<const SpaceWorld> worlds) {
        const Asking scope(is_over_, is_over);
        Vehicles vehicles = starts_in(worlds, true);
        return fly_on(vehicles, whole, 0, goals(), first_world + number, worlds, is_over);
    };
    const auto fly_again = [&](WorldSample& sample) { fly_directly(whole, sample, is_over); };
    return tested({first_world, fly, fly_again}, is_over, counter,
                  CertificateRecord(settings.max_failure_probability, settings.confidence, attempt));
}

const FlownFleetOf<Space>& SpaceProblemWorlds::screened(const CourseOf<Space>& course, std::uint64_t worlds,
                                                        const StopCondition& is_over) {
    FlownFleetOf<Space>& fleet = screened_[course.goals.size()];
    if (!is_flown(fleet, course.plan) || fleet.reference.size() != course.plan.reference.size()) {
        fleet = {course.plan.reference, {}, {}};
    }
    const std::uint64_t known = fleet.vehicles.size();
    std::vector<SpaceWorld> more;
    for (std::uint64_t i = known; i < worlds; ++i) {
        more.push_back(world(first_screening + i));
    }
    if (more.empty()) {
        return fleet;
    }
    const Asking scope(is_over_, is_over);
    Vehicles vehicles = starts_in(more, true);
    if (!course.goals.empty()) {
        SpacePlan flown = course.plan;
        flown.reference.pop_back();  // the hover for its last goal, which is flown again
        for (const WorldSample& sample :
             fly_on(vehicles, flown, 0, course.goals.size(), first_screening + known, more, is_over)) {
            fleet.lost_on.push_back(sample.goal);
        }
    }
    fleet.lost_on.resize(worlds);
    fleet.vehicles.insert(fleet.vehicles.end(), vehicles.begin(), vehicles.end());
    return fleet;
}

Certificate SpaceProblemWorlds::screen(const CourseOf<Space>& before, const SpacePlan& part,
                                       const StopCondition& is_over, const WorldCounter& counter) {
    // Until a flight has failed as a whole, a part only has to do as well as the whole must. To tell that each keeps
    // its share of the failures takes thousands of worlds, and most parts take next to nothing of it. So every flight
    // that fails as a whole makes it harder for parts, down to that share. Many parts begin half way to it, and none
    // may fail at all: another way is found sooner than the failure probability of this one. Where none is better, each
    // that was refused lets the next one fail once more.
    constexpr double first_confidence = 0.5, confidence = 0.8;
    constexpr std::size_t many = 8;
    const bool are_many = goals() >= many, is_first = before.attempts == 0;
    const auto parts = static_cast<double>(goals());
    const double weak_parts =
        std::min(parts, (are_many ? std::sqrt(parts) : 1) * (1 + static_cast<double>(before.attempts)));
    const std::size_t visited = before.goals.size();
    const SpacePlan whole = before.plan.followed_by(part);
    const std::size_t first = before.plan.reference.empty() ? 0 : before.plan.reference.size() - 1;
    FlownFleetOf<Space> after{with_hover(whole, problem_.goals[visited], *model_.flight).reference, {}, {}};
    const auto fly = [&](std::uint64_t number, std::span<const SpaceWorld> worlds) {
        const FlownFleetOf<Space>& fleet = screened(before, number + worlds.size(), is_over);
        const auto begin = fleet.vehicles.begin() + static_cast<std::ptrdiff_t>(number);
        Vehicles vehicles(begin, begin + static_cast<std::ptrdiff_t>(worlds.size()));
        std::vector<WorldSample> samples =
            fly_on(vehicles, whole, first, visited + 1, first_screening + number, worlds, is_over);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!fleet.vehicles[number + i]) {
                samples[i].goal = fleet.lost_on[number + i];
            }
            after.lost_on.push_back(samples[i].goal);
        }
        after.vehicles.insert(after.vehicles.end(), vehicles.begin(), vehicles.end());
        return samples;
    };
    const double share = problem_.planner.max_failure_probability / weak_parts;
    const CertificateRecord record(share, is_first ? first_confidence : confidence, 1, visited,
                                   are_many ? std::optional(refused_[visited]) : std::nullopt);
    Certificate certificate = tested({first_screening, fly}, is_over, counter, record);
    if (certificate.is_given) {
        screened_[visited + 1] = std::move(after);
    } else if (certificate.is_refused) {
        ++refused_[visited];
    }
    return certificate;
}

}  // namespace downwash::planning
