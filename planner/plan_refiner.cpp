#include "downwash/planner/plan_refiner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/planner/solve.hpp"

namespace downwash::planning {
namespace {

constexpr int changes_side_by_side = 8;

/// Largest changes; a track begins with them and ends with a hundredth.
constexpr double largest_shift_m = 1.0;
constexpr double largest_speed_change = 0.5;  ///< share of the limit of motion
constexpr double least_step = 0.01;

/// A plan that did not get better for so many waves is given up, or, as the champion, begun anew with large steps.
constexpr int most_failures = 60;

/// A plan so much dearer than the champion is not worth working on.
constexpr double most_cost_ratio = 1.5;

constexpr double shortest_split_s = 1.0;

Configuration configuration_of(const ReferencePoint& point) {
    return {point.position[0], point.position[1], point.position[2]};
}

double distance_m(const ReferencePoint& a, const ReferencePoint& b) {
    const double dx = b.position[0] - a.position[0];
    const double dz = b.position[1] - a.position[1];
    return std::sqrt(dx * dx + dz * dz);
}

}  // namespace

PlanRefiner::PlanRefiner(const Problem& problem, const SearchSpace& space, PlannedFlights& flights, Random& random)
    : problem_(problem), space_(space), flights_(flights), random_(random) {}

const FlownPlan* PlanRefiner::champion() const noexcept {
    return tracks_.empty() ? nullptr : &tracks_.front().plan;
}

void PlanRefiner::drop_champion() {
    if (!tracks_.empty()) {
        tracks_.erase(tracks_.begin());
    }
}

double PlanRefiner::noise(double size) {
    // A sum of uniform numbers: bell-shaped, bounded, and the same on every machine.
    return size * (random_.uniform(-1, 1) + random_.uniform(-1, 1) + random_.uniform(-1, 1)) / 3;
}

FlightJob PlanRefiner::job_for(const FlownPlan& base, const Change& change) const {
    const double tick_s = flights_.model().tick().tick_s;
    FlightJob job{base.states[change.first], {}, flights_.judged_ticks()};
    for (std::size_t i = change.first; i < change.ticks.size(); ++i) {
        job.legs.push_back({{change.points[i], change.points[i + 1], change.ticks[i], tick_s}});
    }
    job.legs.push_back(flights_.hold_leg(change.points.back()));
    return job;
}

FlownPlan PlanRefiner::flown(const FlownPlan& base, const Change& change, const FlightJob& job) const {
    FlownPlan plan;
    plan.points = change.points;
    plan.ticks = change.ticks;
    const auto kept = static_cast<std::ptrdiff_t>(change.first) + 1;
    plan.states.assign(base.states.begin(), base.states.begin() + kept);
    plan.costs.assign(base.costs.begin(), base.costs.begin() + kept);
    for (std::size_t leg = 0; leg + 1 < job.legs.size(); ++leg) {
        plan.costs.push_back(flights_.cost_after(plan.costs.back(), plan.states.back(), job.legs[leg]));
        plan.states.push_back(job.legs[leg].end);
    }
    plan.cost = flights_.cost_after(plan.costs.back(), plan.states.back(), job.legs.back());
    return plan;
}

void PlanRefiner::take(const Plan& plan) {
    Change change{{}, {}, 0};
    for (std::size_t i = 0; i < plan.reference.size(); ++i) {
        change.points.push_back(plan.reference[i].point);
        if (i > 0) {
            change.ticks.push_back(plan.reference[i].tick - plan.reference[i - 1].tick);
        }
    }
    FlownPlan base;
    base.states.push_back(start_state(flights_.model(), problem_.start));
    base.costs.push_back(0);
    std::vector<FlightJob> jobs{job_for(base, change)};
    flights_.fly(jobs);
    if (jobs[0].fault() != FlightFault::none) {
        return;
    }
    Track track{flown(base, change, jobs[0])};
    if (tracks_.empty() || track.plan.cost < tracks_.front().plan.cost) {
        tracks_.insert(tracks_.begin(), std::move(track));
        tracks_.resize(std::min(tracks_.size(), most_tracks));
    } else if (track.plan.cost < most_cost_ratio * tracks_.front().plan.cost && tracks_.size() < most_tracks) {
        tracks_.push_back(std::move(track));
    }
}

/// Changes a plan's points; returns the first segment that differs, and in `last` the last one. No change: last <
/// first.
std::size_t PlanRefiner::mutate(std::vector<ReferencePoint>& points, const Track& track, std::size_t& last) {
    const MotionLimits& motion = problem_.motion;
    const double shift_m = largest_shift_m * track.step;
    const double most_speed_change = largest_speed_change * track.step;
    const std::size_t segments = points.size() - 1;
    const auto shift = [&](ReferencePoint& p) {
        p.position[0] += noise(shift_m);
        p.position[1] += noise(shift_m);
        p.position[2] += noise(shift_m / space_.arm_weight_m());
    };
    const auto change_speed = [&](ReferencePoint& p) {
        p.velocity[0] += noise(most_speed_change * motion.max_speed_m_s);
        p.velocity[1] += noise(most_speed_change * motion.max_speed_m_s);
        p.velocity[2] += noise(most_speed_change * motion.max_arm_rate_rad_s);
        p.acceleration[0] += noise(most_speed_change * motion.max_acceleration_m_s2);
        p.acceleration[1] += noise(most_speed_change * motion.max_acceleration_m_s2);
        p.acceleration[2] += noise(most_speed_change * motion.max_arm_acceleration_rad_s2);
    };
    const double kind = random_.uniform(0, 1);
    if (segments < 2 || kind < 0.1) {
        if (kind < 0.05) {  // another place at the goal
            last = segments - 1;
            const auto goal = space_.sample_goal_near(configuration_of(points.back()), shift_m, random_);
            if (!goal) {
                last = 0;
                return 1;
            }
            const Configuration to = space_.seen_from(configuration_of(points[segments - 1]), *goal);
            points.back() = at_rest(to);
            return segments - 1;
        }
        // A new corner on the way, moved and passed at another speed.
        const auto i = static_cast<std::size_t>(random_.uniform(0, static_cast<double>(segments)));
        const double tick_s = flights_.model().tick().tick_s;
        const std::int64_t ticks = track.plan.ticks[i];
        if (static_cast<double>(ticks) * tick_s < shortest_split_s) {
            last = 0;
            return 1;
        }
        const double where = random_.uniform(0.2, 0.8);
        ReferencePoint middle = ReferenceSegment(points[i], points[i + 1], ticks, tick_s)
                                    .at_tick(static_cast<std::int64_t>(where * static_cast<double>(ticks)));
        shift(middle);
        change_speed(middle);
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(i) + 1, middle);
        last = i + 1;
        return i;
    }
    const std::size_t corner = 1 + static_cast<std::size_t>(random_.uniform(0, static_cast<double>(segments - 1)));
    last = corner;
    if (kind < 0.2) {  // leave it out
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(corner));
        last = corner - 1;
        return corner - 1;
    }
    ReferencePoint& p = points[corner];
    if (kind < 0.35) {  // fly through it, towards where the corners beside it lead
        const ReferencePoint& before = points[corner - 1];
        const ReferencePoint& after = points[corner + 1];
        const double length_m = std::max(distance_m(before, after), 1e-3);
        const double speed_m_s = random_.uniform(0, 1) * motion.max_speed_m_s;
        for (int axis = 0; axis < 3; ++axis) {
            p.velocity[axis] = speed_m_s / length_m * (after.position[axis] - before.position[axis]);
            p.acceleration[axis] = 0;
        }
        p.velocity[2] = std::clamp(p.velocity[2], -motion.max_arm_rate_rad_s, motion.max_arm_rate_rad_s);
        return corner - 1;
    }
    if (kind < 0.85) {
        shift(p);
    }
    if (kind > 0.5) {
        change_speed(p);
    }
    return corner - 1;
}

std::optional<PlanRefiner::Change> PlanRefiner::changed(const Track& track) {
    Change change{track.plan.points, {}, 0};
    std::size_t last = 0;
    change.first = mutate(change.points, track, last);
    if (last < change.first) {
        return std::nullopt;
    }
    // Segments that do not change keep their ticks; their numbers may have shifted by a corner more or less.
    const std::size_t segments = change.points.size() - 1;
    const std::size_t old_segments = track.plan.ticks.size();
    std::int64_t total = 0;
    for (std::size_t i = 0; i < segments; ++i) {
        if (i >= change.first && i <= last) {
            const ReferenceSegment segment = flights_.fastest_segment(change.points[i], change.points[i + 1]);
            if (!keeps_limits(segment, flights_.limits()) || !flights_.is_worth_flying(segment)) {
                return std::nullopt;
            }
            change.ticks.push_back(segment.ticks());
        } else {
            change.ticks.push_back(track.plan.ticks[i < change.first ? i : i + old_segments - segments]);
        }
        total += change.ticks.back();
    }
    return total <= most_plan_ticks ? std::optional(std::move(change)) : std::nullopt;
}

void PlanRefiner::improve() {
    if (tracks_.empty()) {
        return;
    }
    const std::size_t number = turn_++ % tracks_.size();
    Track& track = tracks_[number];
    std::vector<Change> changes;
    std::vector<FlightJob> jobs;
    for (int tries = 0; tries < 4 * changes_side_by_side && jobs.size() < changes_side_by_side; ++tries) {
        if (auto change = changed(track)) {
            jobs.push_back(job_for(track.plan, *change));
            changes.push_back(std::move(*change));
        }
    }
    flights_.fly(jobs);
    std::optional<FlownPlan> best;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (jobs[i].fault() != FlightFault::none) {
            continue;
        }
        FlownPlan plan = flown(track.plan, changes[i], jobs[i]);
        if (plan.cost < (best ? best->cost : track.plan.cost)) {
            best = std::move(plan);
        }
    }
    if (best) {
        track.plan = std::move(*best);
        track.step = std::min(1.0, 1.5 * track.step);
        track.failures = 0;
    } else {
        track.step = std::max(least_step, 0.9 * track.step);
        ++track.failures;
    }
    if (track.plan.cost < tracks_.front().plan.cost) {
        std::swap(tracks_.front(), track);
    }
    if (tracks_[number].failures >= most_failures) {
        if (number > 0) {
            tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(number));
        } else {
            track.step = 1;
            track.failures = 0;
        }
    }
}

Plan PlanRefiner::plan_of(const FlownPlan& flown) const {
    Plan plan;
    plan.tick_s = flights_.model().tick().tick_s;
    std::int64_t tick = 0;
    for (std::size_t i = 0; i < flown.points.size(); ++i) {
        const ReferencePoint& p = flown.points[i];
        plan.waypoints.push_back({p.position[0], p.position[1], p.position[2]});
        plan.reference.push_back({tick, p});
        tick += i < flown.ticks.size() ? flown.ticks[i] : 0;
    }
    return plan;
}

}  // namespace downwash::planning
