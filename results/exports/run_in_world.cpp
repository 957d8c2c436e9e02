#include "downwash/exports/run_in_world.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

#include "downwash/controllers/space_axes.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/scene/solid_surface.hpp"

namespace downwash {
namespace {

constexpr double disc_thickness_m = 0.01;

/// A flight lasts longer than its plan, unless it ended early or was not flown.
double end_of_hover_s(const NumberTable& flight, double plan_s, double hold_s) {
    const std::vector<double>* times_s = flight.find("t_s");
    const double end_s = times_s != nullptr && !times_s->empty() ? times_s->back() : 0;
    return end_s > plan_s ? end_s : plan_s + hold_s;
}

TriangleMesh rotor_disc(const Vector3& hub_m, const Vector3& axis, double radius_m) {
    return surface_of(Obstacle{"", Cylinder{radius_m, disc_thickness_m, axis}, hub_m, {}});
}

SpacePose planar_pose(const PlaneOfMotion& plane, double x_m, double z_m, double pitch_rad, double arm_rad) {
    const double sine_h = std::sin(plane.heading_rad() / 2), cosine_h = std::cos(plane.heading_rad() / 2);
    const double sine_p = std::sin(pitch_rad / 2), cosine_p = std::cos(pitch_rad / 2);
    SpacePose pose;
    pose.position_m = plane.to_world(x_m, 0, z_m);
    pose.attitude = {cosine_h * cosine_p, 0. - sine_h * sine_p, cosine_h * sine_p, sine_h * cosine_p};
    pose.joints_rad[0] = arm_rad;
    return pose;
}

RobotSurfaces surfaces_of(const Robot& robot) {
    RobotSurfaces surfaces{robot.name, {}, {}};
    for (const BodyShape& body : robot.body) {
        surfaces.body.emplace_back("body", surface_of(as_obstacle(body)));
    }
    for (const Vector3& hub_m : robot.rotors.positions_m) {
        surfaces.body.emplace_back("rotor", rotor_disc(hub_m, {0, 0, 1}, robot.rotors.radius_m));
    }
    surfaces.links.push_back({"arm",
                              {robot.arm.joint_x_m, 0, robot.arm.joint_z_m},
                              {0, 1, 0},
                              rod_surface(robot.arm.length_m, robot.arm.radius_m)});
    return surfaces;
}

/// Several surfaces as one.
TriangleMesh joined(const std::vector<SpaceBodyShape>& bodies) {
    TriangleMesh all;
    for (const SpaceBodyShape& body : bodies) {
        const TriangleMesh one = surface_of(body);
        const auto first = static_cast<std::uint32_t>(all.vertices_m.size());
        all.vertices_m.insert(all.vertices_m.end(), one.vertices_m.begin(), one.vertices_m.end());
        std::ranges::transform(one.triangles, std::back_inserter(all.triangles), [first](const auto& corners) {
            return std::array<std::uint32_t, 3>{first + corners[0], first + corners[1], first + corners[2]};
        });
    }
    return all;
}

RobotSurfaces surfaces_of(const SpaceRobot& robot) {
    RobotSurfaces surfaces{robot.name, {}, {}};
    for (const SpaceBodyShape& body : robot.body) {
        surfaces.body.emplace_back("body", surface_of(body));
    }
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        surfaces.body.emplace_back("rotor", rotor_disc(rotor.position_m, rotor.axis, robot.rotor_radius_m));
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        const SpaceLink& link = robot.plant.links[i];
        surfaces.links.push_back({"link_" + std::to_string(i + 1), link.joint_m,
                                  1 / std::sqrt(dot(link.axis, link.axis)) * link.axis, joined(robot.links[i].body)});
    }
    return surfaces;
}

/// The numbers of a flight in some columns.
class Columns {
 public:
    Columns(const NumberTable& flight, std::initializer_list<std::string_view> names) {
        for (const std::string_view name : names) {
            add(flight, name);
        }
    }
    void add(const NumberTable& flight, std::string_view name) { columns_.push_back(flight.find(name)); }
    [[nodiscard]] double operator()(std::size_t column, std::size_t row) const { return (*columns_[column])[row]; }
    [[nodiscard]] std::size_t count() const { return columns_.size(); }

 private:
    std::vector<const std::vector<double>*> columns_;
};

bool asks_for_touch(const SpaceGoal& goal) {
    return std::holds_alternative<SpaceContactGoal>(goal.kind) || std::ranges::any_of(goal.any_of, asks_for_touch);
}

SpacePose pose_of(const SpaceMotion& motion) {
    return {motion.position_m, motion.attitude, motion.joints_rad};
}

/// What runs of both families have. @param setpoint as of way_of()
template <class AnyRun, class ToSetpoint>
RunInWorld begun(const AnyRun& run, const ToSetpoint& setpoint) {
    const auto& problem = run.problem;
    RunInWorld seen{.name = problem.name,
                    .solution_text = run.solution_text,
                    .flight = run.flight,
                    .obstacles = problem.obstacles,
                    .rate_hz = problem.robot.controller.rate_hz,
                    .max_speed_m_s = problem.motion.max_speed_m_s};
    if (run.plan) {
        const double hold_s = goals_of(in_order(problem, run.order)).back().hold_s;
        seen.plan = way_of(*run.plan, setpoint);
        seen.plan->end_s = end_of_hover_s(run.flight, seen.plan->duration_s(), hold_s);
    }
    seen.robot = [&problem] { return surfaces_of(problem.robot); };
    return seen;
}

}  // namespace

RunInWorld in_world(const RunRecord& run) {
    const Problem& problem = run.problem;
    const PlaneOfMotion& plane = problem.plane;
    RunInWorld seen =
        begun(run, [&plane](double t_s, const ReferencePoint& point) { return setpoint_of(t_s, point, plane); });
    seen.rotors = problem.robot.rotors.positions_m.size();
    seen.has_touch = std::ranges::any_of(goals_of(problem), may_touch);
    seen.joints = {{"arm_joint", planar_axes[plane::arm]}};
    const Start& start = problem.start;
    seen.start = planar_pose(plane, start.at[plane::x], start.at[plane::z], start.pitch_rad, start.at[plane::arm]);
    seen.pose = [&plane, at = Columns(run.flight, {"x_m", "z_m", "pitch_rad", "arm_rad"})](std::size_t row) {
        return planar_pose(plane, at(0, row), at(1, row), at(2, row), at(3, row));
    };
    seen.end_effector_m = [&plane, at = Columns(run.flight, {"ee_x_m", "ee_z_m"})](std::size_t row) {
        return plane.to_world(at(0, row), 0, at(1, row));
    };
    return seen;
}

RunInWorld in_world(const SpaceRunRecord& run) {
    const SpaceProblem& problem = run.problem;
    const int joints = problem.robot.joints();
    RunInWorld seen =
        begun(run, [joints](double t_s, const SpacePoint& point) { return setpoint_of(t_s, point, joints); });
    seen.rotors = problem.robot.plant.rotors.size();
    seen.turns = true;
    seen.has_touch = std::ranges::any_of(problem.goals, asks_for_touch);
    seen.start = pose_of(start_motion(problem.start));
    Columns columns(run.flight, {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
    const std::size_t first_joint = columns.count();
    for (const Axis& axis : axes_in_space(joints).subspan(space::first_joint)) {
        seen.joints.push_back({"joint_" + std::to_string(seen.joints.size() + 1), axis});
        columns.add(run.flight, axis.position);
    }
    seen.pose = [at = std::move(columns), first_joint](std::size_t row) {
        SpacePose pose{{at(0, row), at(1, row), at(2, row)}, {at(3, row), at(4, row), at(5, row), at(6, row)}, {}};
        for (std::size_t i = first_joint; i < at.count(); ++i) {
            pose.joints_rad[i - first_joint] = at(i, row);
        }
        return pose;
    };
    seen.end_effector_m = [at = Columns(run.flight, {"ee_x_m", "ee_y_m", "ee_z_m"})](std::size_t row) {
        return Vector3{at(0, row), at(1, row), at(2, row)};
    };
    return seen;
}

}  // namespace downwash
