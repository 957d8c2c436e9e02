#include "downwash/judge/space_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "downwash/judge/placement.hpp"
#include "downwash/judge/space_goals.hpp"
#include "downwash/judge/space_loop.hpp"
#include "downwash/judge/space_reference.hpp"
#include "downwash/judge/space_touch_lead.hpp"
#include "downwash/judge/space_umpire.hpp"

namespace downwash::judge {
namespace {

/// A hover of this length brings a vehicle to rest at its start.
constexpr double settling_s = 20;

SpaceCoordinates coordinates_of(const SpaceJudgedMotion& motion, int joints) {
    SpaceCoordinates at;
    at.position_m = vector_of(motion.position_m);
    at.attitude =
        Eigen::Quaterniond(motion.attitude[0], motion.attitude[1], motion.attitude[2], motion.attitude[3]).normalized();
    at.velocity_m_s = vector_of(motion.velocity_m_s);
    at.body_rate_rad_s = vector_of(motion.body_rates_rad_s);
    at.joints_rad = Eigen::Map<const Eigen::VectorXd>(motion.joints_rad.data(), joints);
    at.joint_rates_rad_s = Eigen::Map<const Eigen::VectorXd>(motion.joint_rates_rad_s.data(), joints);
    return at;
}

/// Whether a vehicle is level and does not move.
bool is_at_rest(const SpaceCoordinates& at) {
    return at.attitude.x() == 0 && at.attitude.y() == 0 && at.velocity_m_s.isZero(0) && at.body_rate_rad_s.isZero(0) &&
           at.joint_rates_rad_s.isZero(0);
}

/// The reference that rests where a vehicle is.
SpacePoint rest_at(const SpaceCoordinates& at) {
    SpacePoint here;
    std::copy_n(at.position_m.data(), 3, here.position);
    const Eigen::Vector3d ahead = at.attitude * Eigen::Vector3d::UnitX();
    here.position[space::yaw] = std::atan2(ahead.y(), ahead.x());
    std::copy_n(at.joints_rad.data(), at.joints_rad.size(), here.position + space::first_joint);
    return here;
}

/// Whether a vehicle could hover where it is.
bool settles(SpaceLoop& loop, const SpaceCoordinates& start, double tick_s) {
    const SpacePoint here = rest_at(start);
    SpaceStability stability;
    for (std::int64_t tick = 0; tick < std::llround(settling_s / tick_s); ++tick) {
        loop.next(tick, here);
        if (!stability.is_stable(loop.coordinates(), here)) {
            return false;
        }
    }
    return true;
}

SpaceJudgedRecord record_of(const SpaceLoop& loop) {
    SpaceJudgedRecord record{motion_of(loop.seen()), loop.commands().thrust_n, {}};
    const Eigen::VectorXd& joints_nm = loop.commands().joints_nm;
    record.joint_torque_nm.assign(joints_nm.data(), joints_nm.data() + joints_nm.size());
    return record;
}

/// A stay of a plan, and where it and what followed are among the rows.
struct FlownStay {
    SpaceStay stay;
    std::optional<std::size_t> row, row_after;
    std::optional<SpaceJudgedTouch> touch;
};

bool is_met(const SpaceJudgedTouch& touch) {
    return touch.is_force_met && touch.is_place_met && touch.is_free;
}

/// Goes through the goals at the end of a flight.
void judge_goals(const SpaceGoals& goals, const std::vector<FlownStay>& stays, const SpaceWorld& world, double tick_s,
                 SpaceJudgedFlight& flight) {
    constexpr double settling_at_goal_s = 1;
    constexpr double slow_m_s = 0.05;
    const auto settling = static_cast<std::size_t>(std::llround(settling_at_goal_s / tick_s));
    flight.goals.resize(goals.count());
    for (std::size_t goal = 0; goal < goals.count(); ++goal) {
        const auto found =
            std::find_if(stays.begin(), stays.end(), [goal](const FlownStay& each) { return each.stay.goal == goal; });
        const FlownStay flown = found != stays.end() ? *found : FlownStay{{goal, 0, {}}, {}, {}, {}};
        SpaceJudgedGoal& judged = flight.goals[goal];
        judged.is_met = flown.row.has_value() && (!flown.touch || (is_met(*flown.touch) && flown.row_after));
        judged.touch = flown.touch;
        const auto look = [&](std::size_t last, std::size_t ticks) {
            for (std::size_t i = last - std::min(last, ticks); i <= last; ++i) {
                const SpaceJudgedMotion& motion = flight.rows[i].motion;
                const SpaceGoalDistance off = goals.distance(flown.stay, motion, world);
                judged.error_m = std::max(judged.error_m, off.distance_m);
                judged.is_met =
                    judged.is_met && off.used_share <= 1 && vector_of(motion.velocity_m_s).norm() < slow_m_s;
            }
        };
        if (flown.row) {
            look(*flown.row, settling);
        } else if (!flight.rows.empty()) {
            look(flight.rows.size() - 1, 0);
        }
        if (flown.row_after) {
            look(*flown.row_after, settling);
        }
        if (!judged.is_met && flight.outcome == Outcome::ok) {
            flight.outcome = Outcome::goal_missed;
        }
    }
}

}  // namespace

struct SpaceJudge::Shared {
    SpaceRobot robot;
    std::vector<Obstacle> all;
    std::optional<SpaceSurfaces> surfaces;  ///< empty where they do nothing
    SpaceObstacles obstacles;
    SpaceControl control;
};

SpaceJudge::SpaceJudge(const SpaceRobot& robot, const std::vector<Obstacle>& obstacles, const AeroSettings& aero)
    : shared_(new Shared{robot,
                         obstacles,
                         aero.enabled ? std::optional<SpaceSurfaces>(
                                            std::in_place, std::make_shared<const Scene>(obstacles), aero, robot)
                                      : std::nullopt,
                         {obstacles, robot},
                         SpaceControl(robot)}) {}

SpaceJudge::~SpaceJudge() = default;

SpaceJudgedFlight SpaceJudge::fly(const SpacePlan& plan, const SpaceFlightConditions& conditions) const {
    const Shared& shared = *shared_;
    const SpaceWorld nominal_world{};
    const SpaceWorld world = conditions.world.value_or(nominal_world);
    const SpaceSurfaces* felt = conditions.aero && shared.surfaces ? &*shared.surfaces : nullptr;
    const SpaceSurroundings surfaces(felt, world);
    const SpaceSurroundings nominal_surfaces(felt, nominal_world);
    const SpaceVehicle vehicle = vehicle_in(world, shared.robot);
    const SpacePlant plant(vehicle, surfaces);
    const SpaceCoordinates start = coordinates_of(conditions.start, shared.robot.joints());
    const double tick_s = shared.control.tick_s();
    const bool is_in_flight = !conditions.rotor_thrust_n.empty() || !conditions.controller_memory.empty();
    const bool hovers_first = conditions.world && !is_in_flight && is_at_rest(start);
    SpaceLoop loop(shared.control, nominal_surfaces, plant, hovers_first ? judge::without_noise(world) : world,
                   shared.robot, start);
    loop.carry(conditions.rotor_thrust_n, conditions.controller_memory);
    SpaceJudgedFlight flight;
    if (hovers_first) {
        if (!settles(loop, start, tick_s)) {
            flight.outcome = Outcome::unstable;
            return flight;
        }
        loop.forget(world);
    }
    std::optional<SpaceGoals> goals;
    std::vector<FlownStay> stays;
    if (!conditions.goals.empty()) {
        goals.emplace(shared.robot, shared.all, shared.obstacles, conditions.goals, conditions.in_any_order);
        for (SpaceStay& stay : goals->stays(plan)) {
            stays.push_back({std::move(stay), {}, {}, {}});
        }
    }
    SpaceUmpire umpire(shared.obstacles, surfaces, shared.robot, world, tick_s, flight);
    const std::int64_t end = stays.empty() ? plan.reference.back().tick + conditions.hold_ticks : stays.back().stay.end;
    SpacePoint now = reference_at(plan, 0);
    bool goes_on = umpire.sees(loop, now);
    std::int64_t flown = 0;  // ticks, touches included
    auto stay = stays.begin();
    for (std::int64_t tick = 0; tick < end && goes_on; ++tick) {
        loop.next(flown++, now);
        if (conditions.records) {
            flight.records.push_back(record_of(loop));
        }
        now = reference_at(plan, tick + 1);
        goes_on = umpire.sees(loop, now);
        if (!goes_on || stay == stays.end() || stay->stay.end != tick + 1) {
            continue;
        }
        stay->row = flight.rows.size() - 1;
        if (const auto& touch = stay->stay.touch) {
            const SpaceTouchSurface surface(*touch, world);
            const SpacePlant touched(vehicle, surfaces, std::nullopt, &surface);
            loop.fly_with(touched);
            TouchCourse course = course_of(*touch, shared.robot);
            const SpaceTouchLead lead(course, *touch, shared.robot, now);
            while (goes_on && !course.is_over()) {
                const bool is_holding = course.is_holding();
                loop.next(flown++, lead.reference(), course.is_at_surface(), lead.push());
                if (conditions.records) {
                    flight.records.push_back(record_of(loop));
                }
                course.next(loop.state().contact_n);
                goes_on = umpire.sees_touch(loop, lead.reference(), surface, is_holding);
            }
            loop.fly_with(plant);
            stay->touch = umpire.touch(*touch, course.hold());
            if (goes_on) {
                stay->row_after = flight.rows.size() - 1;
            }
            if (goes_on && !is_met(*stay->touch)) {
                flight.outcome = Outcome::goal_missed;
                goes_on = false;
            }
        }
        ++stay;
    }
    if (goals) {
        judge_goals(*goals, stays, world, tick_s, flight);
    }
    if (flight.outcome == Outcome::ok && conditions.energy_budget_j && flight.energy_j > *conditions.energy_budget_j) {
        flight.outcome = Outcome::over_budget;
    }
    return flight;
}

}  // namespace downwash::judge
