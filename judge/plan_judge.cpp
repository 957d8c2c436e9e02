#include "downwash/judge/plan_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/judge/control_law.hpp"
#include "downwash/judge/goals.hpp"
#include "downwash/judge/obstacles.hpp"
#include "downwash/judge/reference.hpp"
#include "downwash/judge/sensors.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash::judge {
namespace {

constexpr std::string_view outcome_names[] = {"ok", "collision", "unstable", "left_flyable_area", "goal_missed"};

// docs/model.md 7.1 and 7.4, section 9 for the hover at the start.
constexpr double unstable_pitch_rad = 80 * std::numbers::pi / 180;
constexpr double unstable_error_m = 3;
constexpr double hover_before_start_s = 20;
constexpr double settling_s = 1;
constexpr double slow_m_s = 0.05;
/// Between two poses a tick apart contact is looked for down to stretches in which nothing moves farther [m].
constexpr double unseen_motion_m = 1e-4;

/// Of the point that the robot file calls the centre of mass, which goals, sensors and obstacles refer to.
Motion of_file_point(const Vehicle& vehicle, Motion motion) {
    const Planar lever = from_body(vehicle.center_of_mass_m, motion.pitch_rad);
    motion.position_m = motion.position_m - lever;
    motion.velocity_m_s = motion.velocity_m_s - turned(motion.pitch_rate_rad_s, lever);
    return motion;
}

/// The reverse: of the true centre of mass.
Motion of_true_point(const Vehicle& vehicle, Motion motion) {
    const Planar lever = from_body(vehicle.center_of_mass_m, motion.pitch_rad);
    motion.position_m = motion.position_m + lever;
    motion.velocity_m_s = motion.velocity_m_s + turned(motion.pitch_rate_rad_s, lever);
    return motion;
}

PlanarPose pose_of(const Motion& motion) {
    return {motion.position_m.x, motion.position_m.z, motion.pitch_rad, motion.arm_rad};
}

double error_m(const Motion& motion, const ReferencePoint& reference) {
    return std::hypot(motion.position_m.x - reference.position[0], motion.position_m.z - reference.position[1]);
}

bool is_stable(const Motion& m, const ReferencePoint& reference) {
    const double all[] = {m.position_m.x,   m.position_m.z,   m.pitch_rad,        m.arm_rad,
                          m.velocity_m_s.x, m.velocity_m_s.z, m.pitch_rate_rad_s, m.arm_rate_rad_s};
    return std::all_of(std::begin(all), std::end(all), [](double x) { return std::isfinite(x); }) &&
           std::abs(m.pitch_rad) <= unstable_pitch_rad && error_m(m, reference) <= unstable_error_m;
}

/// How far from the multirotor's centre of mass a body reaches [m].
double reach_of(const BodyShape& body) {
    struct Radius {
        double operator()(const Box& b) const { return 0.5 * std::sqrt(dot(b.size_m, b.size_m)); }
        double operator()(const Cylinder& c) const { return std::hypot(c.radius_m, 0.5 * c.length_m); }
        double operator()(const Sphere& s) const { return s.radius_m; }
    };
    return std::sqrt(dot(body.center_body_m, body.center_body_m)) + std::visit(Radius{}, body.shape);
}

double norm(Planar v) {
    return std::hypot(v.x, v.z);
}

}  // namespace

std::string_view name_of(Outcome outcome) noexcept {
    return outcome_names[static_cast<std::size_t>(outcome)];
}

/// What all flights share.
struct PlanJudge::Setting {
    Problem problem;
    SurfaceEffects effects;
    Obstacles obstacles;
    ControlLaw law;
    double body_reach_m = 0;

    explicit Setting(const Problem& of)
        : problem(of), obstacles(of.obstacles, of.plane, of.robot.shape(), of.robot.rotors.radius_m), law(of.robot) {
        if (of.aero.enabled) {
            effects.all = make_flight_model(of);
            effects.ceilings = effects.all->ceilings_only();
            effects.has_fountain = !of.aero.map && of.aero.ground.model == EffectModel::multirotor_body;
        }
        for (const BodyShape& body : of.robot.body) {
            body_reach_m = std::max(body_reach_m, reach_of(body));
        }
    }
};

namespace {

/// A vehicle in closed loop, tick by tick.
class Loop {
 public:
    Loop(const ControlLaw& law, const Plant& plant, const World& world, const Robot& robot, const PlantState& state,
         const ControlMemory& memory)
        : law_(law),
          plant_(plant),
          world_(world),
          sensors_(world, robot, of_file_point(plant.vehicle(), state.motion)),
          gusts_(world, law.tick_s()),
          state_(state),
          memory_(memory) {}

    [[nodiscard]] const PlantState& state() const noexcept { return state_; }
    [[nodiscard]] const ControlMemory& memory() const noexcept { return memory_; }
    /// Of the point of the robot file.
    [[nodiscard]] Motion motion() const { return of_file_point(plant_.vehicle(), state_.motion); }

    /// Goes on by a tick. @param tick from the start of the flight
    void next(std::int64_t tick, const ReferencePoint& reference) {
        const Tape tape = tape_at(world_, tick);
        const Motion now = motion();
        before_ = state_;
        command_ = law_.command(sensors_.seen(now, tape), state_.thrust_n, reference, memory_);
        wind_ = gusts_.wind();
        state_ = plant_.after(state_, command_, wind_, law_.tick_s());
        sensors_.remember(now);
        gusts_.next(tape);
    }

    /// The motion of the file's point so long after the beginning of the last tick.
    [[nodiscard]] Motion motion_within(double since_s) const {
        return of_file_point(plant_.vehicle(), plant_.after(before_, command_, wind_, since_s).motion);
    }

 private:
    const ControlLaw& law_;
    const Plant& plant_;
    const World& world_;
    Sensors sensors_;
    Gusts gusts_;
    PlantState state_, before_;
    ControlMemory memory_;
    Command command_;
    Planar wind_;
};

/// An instant within a tick.
struct Instant {
    double since_s;
    Motion motion;
    double clearance_m;
};

/// Writes down a flight and finds out how it ends.
class Umpire {
 public:
    Umpire(const Problem& problem, const SurfaceEffects* effects, const Obstacles& obstacles, double body_reach_m,
           const World& world, double tick_s, JudgedFlight& flight)
        : problem_(problem),
          effects_(effects),
          obstacles_(obstacles),
          body_reach_m_(body_reach_m),
          world_(world),
          tick_s_(tick_s),
          flight_(flight) {}

    /// Looks at the vehicle at a tick; false if the flight ends here.
    bool sees(const Loop& loop, const ReferencePoint& reference) {
        const Motion motion = loop.motion();
        const double clearance_m = obstacles_.clearance_m(among_obstacles(motion));
        const bool is_contact = clearance_m <= 0;
        add_row(motion, reference, clearance_m, loop.state().energy_j);
        if (!is_stable(motion, reference)) {
            flight_.outcome = Outcome::unstable;
        } else if (is_contact || touches_within_tick(loop, motion, clearance_m)) {
            flight_.outcome = Outcome::collision;
            flight_.min_clearance_m = 0;
        } else if (!is_flyable(motion)) {
            flight_.outcome = Outcome::left_flyable_area;
        }
        last_ = motion;
        return flight_.outcome == Outcome::ok;
    }

    /// Goes through the goals at the end of a flight.
    void sees_goals(const std::vector<Goal>& goals, const std::vector<std::int64_t>& ends) {
        const auto ticks = static_cast<std::int64_t>(flight_.rows.size());
        const std::int64_t settling = std::llround(settling_s / tick_s_);
        for (std::size_t i = 0; i < goals.size(); ++i) {
            const bool is_flown = i < ends.size() && ends[i] < ticks;
            const std::int64_t last = is_flown ? ends[i] : ticks - 1;
            bool is_met = is_flown;
            for (std::int64_t t = std::max<std::int64_t>(0, last - (is_flown ? settling : 0)); t <= last; ++t) {
                const JudgedRow& row = flight_.rows[static_cast<std::size_t>(t)];
                const GoalDistance off = goal_distance(goals[i], problem_.robot.arm, row.pose);
                flight_.goal_error_m = std::max(flight_.goal_error_m, off.distance_m);
                is_met = is_met && off.used_share <= 1 && std::hypot(row.vx_m_s, row.vz_m_s) < slow_m_s;
            }
            if (!is_met && flight_.outcome == Outcome::ok) {
                flight_.outcome = Outcome::goal_missed;
            }
        }
    }

 private:
    [[nodiscard]] PlanarPose among_obstacles(const Motion& motion) const {
        PlanarPose pose = pose_of(motion);
        pose.x_m -= world_.scene_x_m;
        pose.z_m -= world_.scene_z_m;
        return pose;
    }

    void add_row(const Motion& motion, const ReferencePoint& reference, double clearance_m, double energy_j) {
        JudgedRow row;
        row.t_s = static_cast<double>(flight_.rows.size()) * tick_s_;
        row.pose = pose_of(motion);
        row.vx_m_s = motion.velocity_m_s.x;
        row.vz_m_s = motion.velocity_m_s.z;
        row.reference_x_m = reference.position[0];
        row.reference_z_m = reference.position[1];
        row.reference_arm_rad = reference.position[2];
        row.clearance_m = clearance_m;
        row.energy_j = energy_j;
        if (!flight_.rows.empty()) {
            const PlanarPose& from = flight_.rows.back().pose;
            const double turn_m = 0.5 * problem_.robot.arm.length_m * (row.pose.arm_rad - from.arm_rad);
            flight_.length_m += std::hypot(row.pose.x_m - from.x_m, row.pose.z_m - from.z_m, turn_m);
            flight_.clearance_integral += tick_s_ / (std::max(clearance_m, 0.0) + 0.1);
        }
        flight_.rows.push_back(row);
        flight_.min_clearance_m = std::min(flight_.min_clearance_m, clearance_m);
        flight_.max_tracking_error_m = std::max(flight_.max_tracking_error_m, error_m(motion, reference));
        flight_.energy_j = energy_j;
        flight_.duration_s = row.t_s;
    }

    [[nodiscard]] bool touches_within_tick(const Loop& loop, const Motion& motion, double clearance_m) const {
        return flight_.rows.size() > 1 &&
               touches_between(loop, {0, last_, flight_.rows[flight_.rows.size() - 2].clearance_m},
                               {tick_s_, motion, clearance_m});
    }

    /// Whether the robot touches something between two instants at which it does not. It cannot where it moves less
    /// than its distances at both ends; other stretches are halved, at poses that the plant gives there.
    [[nodiscard]] bool touches_between(const Loop& loop, const Instant& from, const Instant& to) const {
        const double motion_m = max_speed(from.motion, to.motion) * (to.since_s - from.since_s);
        if (from.clearance_m + to.clearance_m > motion_m || motion_m < unseen_motion_m) {
            return false;
        }
        Instant middle{0.5 * (from.since_s + to.since_s), {}, 0};
        middle.motion = loop.motion_within(middle.since_s);
        middle.clearance_m = obstacles_.clearance_m(among_obstacles(middle.motion));
        return middle.clearance_m <= 0 || touches_between(loop, from, middle) || touches_between(loop, middle, to);
    }

    /// No point of the robot is faster between two instants of a tick [m/s]: the greater speed of both, and all of the
    /// change, as accelerations hardly change while commands are held.
    [[nodiscard]] double max_speed(const Motion& a, const Motion& b) const {
        const ArmParameters& arm = problem_.robot.arm;
        const auto speed = [&](Planar velocity, double pitch_rate, double arm_rate) {
            const double joint_m = std::hypot(arm.joint_x_m, arm.joint_z_m);
            return norm(velocity) +
                   std::max(body_reach_m_ * std::abs(pitch_rate),
                            joint_m * std::abs(pitch_rate) + arm.length_m * std::abs(pitch_rate + arm_rate));
        };
        return std::max(speed(a.velocity_m_s, a.pitch_rate_rad_s, a.arm_rate_rad_s),
                        speed(b.velocity_m_s, b.pitch_rate_rad_s, b.arm_rate_rad_s)) +
               speed(b.velocity_m_s - a.velocity_m_s, b.pitch_rate_rad_s - a.pitch_rate_rad_s,
                     b.arm_rate_rad_s - a.arm_rate_rad_s);
    }

    /// Whether all rotor discs keep their distance (docs/model.md 4.4).
    [[nodiscard]] bool is_flyable(const Motion& motion) const {
        if (effects_ == nullptr) {
            return true;
        }
        const RotorParameters& rotors = problem_.robot.rotors;
        const double distance_m = problem_.aero.min_distance_radii * rotors.radius_m;
        const PlanarPose pose = among_obstacles(motion);
        for (std::size_t i = 0; i < rotors.positions_m.size(); ++i) {
            const Vector3& hub_m = rotors.positions_m[i];
            const Planar hub = Planar{pose.x_m, pose.z_m} + from_body({hub_m[0], hub_m[2]}, pose.pitch_rad);
            if (!obstacles_.disc_keeps(distance_m, hub.x, hub_m[1], hub.z)) {
                return false;
            }
            // A given map says itself where it is defined.
            if (problem_.aero.map && !effects_->all->effect(static_cast<int>(i))
                                          .is_flyable(problem_.plane.to_world(hub.x, hub_m[1], hub.z))) {
                return false;
            }
        }
        return true;
    }

    const Problem& problem_;
    const SurfaceEffects* effects_;
    const Obstacles& obstacles_;
    double body_reach_m_;
    const World& world_;
    double tick_s_;
    JudgedFlight& flight_;
    Motion last_;
};

/// The vehicle at the start of a problem, its rotors carrying the weight.
PlantState start_of(const Problem& problem, const ControlLaw& law, const Vehicle& vehicle) {
    const Start& s = problem.start;
    PlantState state;
    state.motion = of_true_point(
        vehicle, {{s.x_m, s.z_m}, {s.vx_m_s, s.vz_m_s}, s.pitch_rad, s.pitch_rate_rad_s, s.arm_rad, s.arm_rate_rad_s});
    state.thrust_n = law.resting_thrust_n();
    return state;
}

}  // namespace

PlanJudge::PlanJudge(const Problem& problem) : setting_(std::make_unique<const Setting>(problem)) {}
PlanJudge::~PlanJudge() = default;

const Problem& PlanJudge::problem() const noexcept {
    return setting_->problem;
}

JudgedFlight PlanJudge::fly(const Plan& plan, const FlightConditions& conditions) const {
    const Setting& setting = *setting_;
    const Problem& problem = setting.problem;
    const World world = conditions.world.value_or(World{});
    const SurfaceEffects* effects = conditions.aero && problem.aero.enabled ? &setting.effects : nullptr;
    const Vehicle vehicle = vehicle_in(world, problem.robot);
    const Surroundings surroundings(effects, world);
    const Plant plant(vehicle, surroundings);
    PlantState state = start_of(problem, setting.law, vehicle);
    ControlMemory memory;
    memory.pitch_reference_rad = problem.start.pitch_rad;
    JudgedFlight flight;

    // In a world a vehicle at rest has hovered at its start, in calm air and with quiet sensors.
    if (conditions.world && is_at_rest(problem.start)) {
        const World quiet = without_noise(world);
        const ReferencePoint here = at_rest(problem.start.configuration());
        Loop hover(setting.law, plant, quiet, problem.robot, state, memory);
        const std::int64_t ticks = std::llround(hover_before_start_s / setting.law.tick_s());
        for (std::int64_t tick = 0; tick < ticks; ++tick) {
            hover.next(tick, here);
            if (!is_stable(hover.motion(), here)) {
                flight.outcome = Outcome::unstable;
                break;
            }
        }
        state = hover.state();
        state.energy_j = 0;
        memory = hover.memory();
    }

    Loop loop(setting.law, plant, world, problem.robot, state, memory);
    Umpire umpire(problem, effects, setting.obstacles, setting.body_reach_m, world, setting.law.tick_s(), flight);
    Reference reference(plan);
    const std::vector<Goal> goals = goals_of(problem);
    const std::int64_t end = last_tick(plan, goals.back(), problem.robot.arm);
    ReferencePoint now = reference.at(0);
    bool goes_on = flight.outcome == Outcome::ok;
    goes_on = umpire.sees(loop, now) && goes_on;
    for (std::int64_t tick = 0; tick < end && goes_on; ++tick) {
        loop.next(tick, now);
        now = reference.at(tick + 1);
        goes_on = umpire.sees(loop, now);
    }
    umpire.sees_goals(goals, hover_ends(plan, goals, problem.robot.arm));
    return flight;
}

}  // namespace downwash::judge
