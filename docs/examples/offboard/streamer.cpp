#include "streamer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <variant>
#include <vector>

#include "obstacles.hpp"
#include "px4.hpp"

using namespace downwash;

namespace {

constexpr double sight_m = 1.5;            ///< at which the obstacle is seen, from the multirotor's centre of mass
constexpr double lead_s = 3;               ///< from what is seen to the first tick of the new plan
constexpr double planning_share = 0.4;     ///< of the lead, for the search; then the plan is looked at
constexpr double between_moments_s = 0.5;  ///< of a plan at which it is looked at
constexpr double max_error_m = 0.04;       ///< of PX4's loops along a plan
constexpr double min_clearance_m = 0.1;    ///< of what is flown in silence
constexpr double min_speed_m_s = 0.1;
constexpr double request_period_s = 0.5, heartbeat_period_s = 1;

/// From a place to a box whose edges are along the axes [m].
double distance_m(const std::array<double, 3>& at_m, const Obstacle& box) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double half_m = 0.5 * std::get<Box>(box.shape).size_m[i];
        const double beyond_m = std::max(0.0, std::abs(at_m[i] - box.center_world_m[i]) - half_m);
        square += beyond_m * beyond_m;
    }
    return std::sqrt(square);
}

/// From a place to that of a reference [m].
double distance_m(const std::array<double, 3>& at_m, const SpacePoint& reference) {
    return std::hypot(at_m[0] - reference.position[space::x], at_m[1] - reference.position[space::y],
                      at_m[2] - reference.position[space::z]);
}

/// A hover where a plan ends, for a second.
SpaceGoal hover_at_end(const SpacePlan& plan) {
    const double* at = plan.reference.back().point.position;
    SpaceGoal goal;
    goal.kind =
        SpaceConfigurationGoal{at[space::x], at[space::y], at[space::z], at[space::yaw],
                               std::vector<double>(at + space::first_joint, at + space::first_joint + plan.joints)};
    goal.hold_s = 1;
    return goal;
}

SpaceSolveOptions until_first_plan() {
    SpaceSolveOptions options;
    options.stop_at_first_solution = true;
    return options;
}

bool leads_to_goal(const SpaceAnswer& answer) {
    return answer.advice == Advice::keep || answer.advice == Advice::follow;
}

template <class... Values>
std::string text(const char* format, Values... values) {
    constexpr std::size_t longest = 200;
    char line[longest];
    std::snprintf(line, longest, format, values...);
    return line;
}

mavlink::CommandLong mode_request(std::uint32_t mode) {
    mavlink::CommandLong command;
    command.command = mavlink::CommandLong::do_set_mode;
    command.param1 = mavlink::custom_mode_enabled;
    command.param2 = static_cast<float>(mode >> 16U & 0xffU);
    command.param3 = static_cast<float>(mode >> 24U);
    command.target_system = 1;
    command.target_component = mavlink::autopilot_component;
    return command;
}

}  // namespace

Streamer::Streamer(const SpaceProblem& drawing, const StreamerOptions& options) : options_(options), drawing_(drawing) {
    if (!options_.lower.empty()) {
        box_in(drawing_, options_.lower);
    }
}

bool Streamer::plan() {
    for (SpaceProblem slower = drawing_; slower.motion.max_speed_m_s > min_speed_m_s;
         slower.motion.max_speed_m_s /= 2) {
        believed_ = slower;
        planner_.emplace(believed_, until_first_plan());
        const SpaceSearchResult& found = planner_->solve();
        if (found.status != Status::solved) {
            say("no plan");
            return false;
        }
        plan_ = *found.plan;
        say(text("a plan of %.2f s at up to %.3f m/s", plan_.duration_s(), believed_.motion.max_speed_m_s));
        const auto objection = objection_to(plan_, 0);
        if (!objection) {
            say("it is safe wherever the link may fall silent");
            return true;
        }
        say(*objection);
    }
    return false;
}

void Streamer::adopt(const SpaceProblem& planned, const SpacePlan& plan) {
    believed_ = planned;
    planner_.emplace(believed_, until_first_plan());
    planner_->adopt(plan);
    plan_ = plan;
}

/// Why a plan is not to be flown, from a tick on.
std::optional<std::string> Streamer::objection_to(const SpacePlan& plan, std::int64_t from) const {
    SpaceProblem problem = believed_;
    for (std::int64_t tick = from; tick < plan.reference.back().tick; tick += ticks(between_moments_s)) {
        const double moment_s = static_cast<double>(tick) * plan.tick_s;
        problem.start = planner_->predicted(believed_.start, plan, tick);
        if (const double off_m = distance_m(problem.start.position_m, plan.at(tick)); off_m > max_error_m) {
            return text("PX4 would be %.3f m off at %.2f s", off_m, moment_s);
        }
        const SpacePlan silent = flown_in_silence(plan, tick, px4_of(problem.robot));
        problem.goals = {hover_at_end(silent)};
        const SpaceFlight flight = SpaceProblemModel(problem, planner_->model()).execute(silent);
        if (flight.outcome != Outcome::ok || flight.min_clearance_m < min_clearance_m) {
            return text("silence at %.2f s would lead too close to an obstacle", moment_s);
        }
    }
    return std::nullopt;
}

std::int64_t Streamer::ticks(double time_s) const {
    return std::llround(time_s * drawing_.robot.controller.rate_hz);
}

std::string Streamer::greeting() {
    mavlink::Heartbeat heartbeat;
    heartbeat.type = mavlink::onboard_controller_type;
    heartbeat.autopilot = mavlink::no_autopilot;
    heartbeat.system_status = mavlink::active_state;
    return writer_.frame(heartbeat);
}

std::string Streamer::answer(std::string_view datagram) {
    bool has_position = false;
    for (const mavlink::Frame& frame : mavlink::FrameReader().take(datagram)) {
        if (const auto heartbeat = mavlink::message_in<mavlink::Heartbeat>(frame)) {
            mode_ = heartbeat->custom_mode;
            if (heartbeat->system_status == mavlink::emergency_state) {
                end("the vehicle is lost");
            }
        } else if (const auto position = mavlink::message_in<mavlink::LocalPositionNed>(frame)) {
            has_position = true;
            now_s_ = 1e-3 * position->time_boot_ms;
            at_m_ = turned_over(position->x, position->y, position->z);
        }
    }
    if (!has_position || is_over()) {
        return {};
    }
    proceed();
    return is_over() ? std::string() : frames();
}

void Streamer::proceed() {
    const bool is_offboard = mode_ == mavlink::px4_offboard_mode;
    if (since_s_ < 0) {
        since_s_ = now_s_;
        next_request_s_ = now_s_ + warm_up_s + 0.1;  // the first set-points may be late
    }
    if (phase_ == Phase::offering && is_offboard) {
        say("offboard");
        phase_ = Phase::flying;
        since_s_ = now_s_;
    }
    if (phase_ == Phase::stopping && !is_offboard) {
        has_arrived_ = leads_to_goal_;
        end(text("hold, at most %.3f m from the plan so far", max_distance_m_));
    } else if (phase_ == Phase::flying && !is_offboard) {
        end("the vehicle holds, since set-points did not come");
    } else if (phase_ != Phase::offering) {
        tick_ = ticks(now_s_ - since_s_);
        take_new_plan();
        max_distance_m_ = std::max(max_distance_m_, distance_m(at_m_, plan_.at(tick_)));
        look_around();
        const bool is_at_end = tick_ >= plan_.reference.back().tick + ticks(believed_.goals.back().hold_s);
        if (is_at_end && phase_ == Phase::flying && new_plan_from_ < 0) {
            phase_ = Phase::stopping;
        }
    }
}

/// A sensor sees that an obstacle is lower, and a new plan is made while the old one is flown.
void Streamer::look_around() {
    if (options_.lower.empty() || knows_) {
        return;
    }
    Obstacle lower = box_in(drawing_, options_.lower);
    lower.center_world_m[2] -= options_.lower_m;
    if (distance_m(at_m_, lower) < sight_m) {
        say(text("%s is %.3f m lower than on the drawing", options_.lower.c_str(), options_.lower_m));
        knows_ = true;
        box_in(believed_, options_.lower) = lower;
        new_plan_from_ = tick_ + ticks(lead_s);
        answer_ = std::async(std::launch::async, [this] { return replan(); });
    }
}

/// What to fly from new_plan_from_ on: the best answer to which there is no objection. A stop is always one.
SpaceAnswer Streamer::replan() {
    SpaceSceneChange change;
    change.put = {box_in(believed_, options_.lower)};
    SpaceReplanOptions how;
    how.max_iterations = options_.max_iterations;
    if (!how.max_iterations) {
        how.time_limit_s = planning_share * lead_s;
    }
    std::vector<SpaceAnswer> answers;  // each better than the one before; the first is a stop
    how.on_answer = [&](const SpaceAnswer& answer) { answers.push_back(answer); };
    const std::int64_t from = new_plan_from_;
    planner_->replan(planner_->predicted(believed_.start, plan_, from), from, change, how);
    while (leads_to_goal(answers.back()) && answers.size() > 1 &&
           objection_to(plan_.beginning(from).followed_by(answers.back().plan), from)) {
        answers.pop_back();
    }
    return answers.back();
}

void Streamer::take_new_plan() {
    if (new_plan_from_ < 0 || tick_ < new_plan_from_) {
        return;
    }
    const SpaceAnswer answer = answer_.get();
    plan_ = plan_.beginning(new_plan_from_).followed_by(answer.plan);
    new_plan_from_ = -1;
    leads_to_goal_ = leads_to_goal(answer);
    const double* to = answer.plan.reference.back().point.position;
    say(text("%s: %.2f s to (%.3f, %.3f, %.3f) m", std::string(name_of(answer.advice)).c_str(),
             answer.plan.duration_s(), to[space::x], to[space::y], to[space::z]));
}

void Streamer::end(const std::string& why) {
    if (!is_over()) {
        say(why);
        phase_ = Phase::over;
    }
}

/// What is sent now.
std::string Streamer::frames() {
    std::string datagram;
    if (now_s_ >= next_heartbeat_s_) {
        datagram += greeting();
        next_heartbeat_s_ = now_s_ + heartbeat_period_s;
    }
    if (phase_ != Phase::flying && now_s_ >= next_request_s_) {
        datagram += writer_.frame(
            mode_request(phase_ == Phase::offering ? mavlink::px4_offboard_mode : mavlink::px4_hold_mode));
        next_request_s_ = now_s_ + request_period_s;
    }
    const SpacePoint reference = plan_.at(phase_ == Phase::offering ? 0 : tick_);
    return datagram + writer_.frame(actuators_of(reference, drawing_.robot)) +
           writer_.frame(setpoint_of(reference, now_s_));
}

void Streamer::say(const std::string& line) const {
    if (!options_.is_quiet) {
        std::printf("%8.2f s  %s\n", now_s_, line.c_str());
        std::fflush(stdout);
    }
}
