#include "downwash/python/core_starts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/controllers/space_axes.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/simulation/space_tool.hpp"

namespace downwash::python {
namespace {

template <class Point>
Point point_of(const double* numbers, std::size_t axes) {
    Point point;
    for (double* to : {point.position, point.velocity, point.acceleration}) {
        std::copy_n(numbers, axes, to);
        numbers += axes;
    }
    return point;
}

void require_count(const std::vector<double>& numbers, std::size_t count, const std::string& what) {
    if (numbers.size() != count) {
        throw_input_error(
            what + " has " + std::to_string(numbers.size()) + " numbers: expected " + std::to_string(count), "start");
    }
}

/// Fills a plan without knots.
template <class AnyPlan>
AnyPlan with_knots(AnyPlan plan, const Points& knots, std::size_t axes) {
    const auto columns = static_cast<py::ssize_t>(1 + 3 * axes);
    if (knots.ndim() != 2 || knots.shape(0) < 1 || knots.shape(1) != columns) {
        throw_input_error("has no knots: expected columns as solution.plan has them", "plan");
    }
    using Knot = typename decltype(plan.reference)::value_type;
    const auto at = knots.unchecked<2>();
    for (py::ssize_t i = 0; i < knots.shape(0); ++i) {
        for (py::ssize_t k = 0; k < columns; ++k) {
            if (!std::isfinite(at(i, k))) {
                throw_input_error("has a number that is not finite in its row " + std::to_string(i), "plan");
            }
        }
        const double ticks = at(i, 0) / plan.tick_s;
        const double before = i == 0 ? -1 : static_cast<double>(plan.reference.back().tick);
        const bool is_in_order = i == 0 ? std::round(ticks) == 0 : std::round(ticks) > before;
        if (std::abs(ticks - std::round(ticks)) > 1e-3 || !is_in_order || ticks > max_plan_ticks) {
            throw_input_error("has t_s = " + std::to_string(at(i, 0)) + " in its row " + std::to_string(i) +
                                  ": expected times on control ticks that rise from 0, at most an hour",
                              "plan");
        }
        plan.reference.push_back({std::llround(ticks), point_of<decltype(Knot::point)>(knots.data(i, 1), axes)});
    }
    return plan;
}

template <class AnyProblem>
auto any_plan_of(const Points& knots, const AnyProblem& problem) {
    return with_knots(no_knots(problem), knots, axes_of(problem).size());
}

}  // namespace

std::span<const Axis> axes_of(const Problem& problem) {
    return problem.axes();
}

std::span<const Axis> axes_of(const SpaceProblem& problem) {
    return axes_in_space(problem.robot.joints());
}

Plan no_knots(const Problem& problem) {
    Plan plan;
    plan.tick_s = 1 / problem.robot.controller.rate_hz;
    plan.axes = problem.axes();
    return plan;
}

SpacePlan no_knots(const SpaceProblem& problem) {
    return {{}, 1 / problem.robot.controller.rate_hz, problem.robot.joints()};
}

Start start_of(const CoreStart& given, const Problem& problem) {
    const auto& [v, joints, joint_rates, reference, rotor_thrust_n, memory] = given;
    require_count(v, 8, "a vehicle in a vertical plane");
    Start start{{v[0], v[1], v[2]}, v[3], {v[4], v[5], v[7]}, v[6], {}, rotor_thrust_n, memory};
    if (reference) {
        const std::size_t axes = problem.axes().size();
        require_count(*reference, 3 * axes, "its reference");
        start.reference = point_of<ReferencePoint>(reference->data(), axes);
    }
    return start;
}

SpaceStart start_of(const CoreStart& given, const SpaceProblem& problem) {
    const auto& [v, joints, joint_rates, reference, rotor_thrust_n, memory] = given;
    require_count(v, 13, "a vehicle in space");
    SpaceStart start;
    start.position_m = {v[0], v[1], v[2]};
    start.attitude = {v[3], v[4], v[5], v[6]};
    start.yaw_rad = yaw_of(*start.attitude);
    start.velocity_m_s = {v[7], v[8], v[9]};
    start.body_rates_rad_s = {v[10], v[11], v[12]};
    start.joints_rad = joints;
    start.joint_rates_rad_s = joint_rates;
    if (reference) {
        const std::size_t axes = axes_of(problem).size();
        require_count(*reference, 3 * axes, "its reference");
        const double* from = reference->data();
        start.reference = {{from, from + axes}, {from + axes, from + 2 * axes}, {from + 2 * axes, from + 3 * axes}};
    }
    start.carry = {rotor_thrust_n, memory};
    return start;
}

CoreStart numbers_of(const Start& s) {
    return {{s.at[plane::x], s.at[plane::z], s.at[plane::arm], s.pitch_rad, s.velocity[plane::x], s.velocity[plane::z],
             s.pitch_rate_rad_s, s.velocity[plane::arm]},
            {},
            {},
            s.reference ? std::optional(numbers_of(*s.reference, max_axes)) : std::nullopt,
            s.rotor_thrust_n,
            s.controller_memory};
}

CoreStart numbers_of(const SpaceStart& s) {
    const SpaceMotion motion = start_motion(s);
    std::vector<double> vehicle;
    std::optional<std::vector<double>> reference;
    const auto append = [](std::vector<double>& to, const auto& numbers) {
        to.insert(to.end(), numbers.begin(), numbers.end());
    };
    append(vehicle, motion.position_m);
    append(vehicle, motion.attitude);
    append(vehicle, motion.velocity_m_s);
    append(vehicle, motion.body_rates_rad_s);
    if (s.reference) {
        reference.emplace();
        append(*reference, s.reference->position);
        append(*reference, s.reference->velocity);
        append(*reference, s.reference->acceleration);
    }
    return {vehicle, s.joints_rad, s.joint_rates_rad_s, reference, s.carry.rotor_thrust_n, s.carry.controller_memory};
}

Plan plan_of(const Points& knots, const Problem& problem) {
    return any_plan_of(knots, problem);
}

SpacePlan plan_of(const Points& knots, const SpaceProblem& problem) {
    return any_plan_of(knots, problem);
}

}  // namespace downwash::python
