#include "downwash/comparison/compared_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

constexpr double far_m = 1e6;

std::string name_of_obstacle(const Scene& scene, const std::optional<std::size_t>& nearest) {
    return nearest ? scene.obstacles()[*nearest].name : std::string();
}

class PlanarPlan final : public ComparedPlan {
 public:
    PlanarPlan(const Problem& problem, Plan plan)
        : problem_(problem), plan_(std::move(plan)), model_(make_flight_model(problem)), goals_(goals_of(problem)) {}

    [[nodiscard]] bool is_in_plane() const noexcept override { return true; }
    [[nodiscard]] std::size_t joints() const noexcept override { return 1; }
    [[nodiscard]] bool has_uncertainty() const noexcept override { return problem_.uncertainty.has_value(); }
    [[nodiscard]] double safety_margin_m() const noexcept override { return problem_.planner.safety_margin_m; }

    [[nodiscard]] PlannedFlight fly(bool aero) const override {
        const Execution flight = execute(*model_, start_state(*model_, problem_.start), plan_.reference, goals_, aero);
        PlannedFlight planned{plan_.tick_s, std::string(name_of(flight.outcome)), {}};
        planned.rows.reserve(flight.rows.size());
        for (const FlightRow& row : flight.rows) {
            PlannedRow& to = planned.rows.emplace_back();
            to.t_s = row.t_s;
            to.reference_m = {row.reference.position[plane::x], 0, row.reference.position[plane::z]};
            to.reference_velocity_m_s = {row.reference.velocity[plane::x], 0, row.reference.velocity[plane::z]};
            to.reference_joints_rad[0] = row.reference.position[plane::arm];
            to.position_m = {row.q[0], 0, row.q[1]};
            to.clearance_m = row.clearance_m;
            to.thrust_n = row.thrust_command_n;
        }
        return planned;
    }

    [[nodiscard]] std::vector<Vector3> fly_in_world(std::uint64_t seed, std::uint64_t index) const override {
        const FlownWorld world =
            make_world(problem_.robot, draw_world(*problem_.uncertainty, problem_.robot, seed, index));
        const FlightWorld in{&world, 0};
        FlightState nominal = start_state(*model_, problem_.start);
        nominal.world = memory_at_start(world, nominal.plant);
        const auto start = is_at_rest(problem_.start) ? hovering_start(*model_, nominal, true, in) : nominal;
        std::vector<Vector3> places;
        if (start) {
            for (const FlightRow& row : execute(*model_, *start, plan_.reference, goals_, true, in).rows) {
                places.push_back({row.q[0], 0, row.q[1]});
            }
        }
        return places;
    }

    [[nodiscard]] double clearance_m(const FlownPose& pose) const override {
        return model_->collisions().clearance_m(in_plane(pose));
    }
    [[nodiscard]] std::string nearest_obstacle(const FlownPose& pose) const override {
        return name_of_obstacle(model_->scene(), model_->collisions().nearest_obstacle(in_plane(pose), far_m));
    }

 private:
    static PlanarPose in_plane(const FlownPose& pose) {
        // The body's x axis in the plane; it is positive nose down.
        const Matrix3 rotation = rotation_of(pose.attitude);
        const double pitch_rad = std::atan2(-rotation[2][0], std::hypot(rotation[0][0], rotation[1][0]));
        return {pose.position_m[0], pose.position_m[2], pitch_rad, pose.joints_rad[0], pose.position_m[1]};
    }

    Problem problem_;
    Plan plan_;
    std::shared_ptr<const FlightModel> model_;
    std::vector<Goal> goals_;
};

class PlanInSpace final : public ComparedPlan {
 public:
    PlanInSpace(const SpaceProblem& problem, SpacePlan plan) : model_(problem), plan_(std::move(plan)) {}

    [[nodiscard]] bool is_in_plane() const noexcept override { return false; }
    [[nodiscard]] std::size_t joints() const noexcept override { return static_cast<std::size_t>(plan_.joints); }
    [[nodiscard]] bool has_uncertainty() const noexcept override { return model_.problem().uncertainty.has_value(); }
    [[nodiscard]] double safety_margin_m() const noexcept override { return model_.problem().planner.safety_margin_m; }

    [[nodiscard]] PlannedFlight fly(bool aero) const override {
        SpaceExecutionSettings settings;
        settings.aero = aero;
        const SpaceFlight flight = model_.execute(plan_, settings);
        PlannedFlight planned{plan_.tick_s, std::string(name_of(flight.outcome)), {}};
        planned.rows.reserve(flight.rows.size());
        for (const SpaceFlightRow& row : flight.rows) {
            PlannedRow& to = planned.rows.emplace_back();
            to.t_s = row.t_s;
            std::copy_n(row.reference.position, 3, to.reference_m.begin());
            std::copy_n(row.reference.velocity, 3, to.reference_velocity_m_s.begin());
            to.reference_yaw_rad = row.reference.position[space::yaw];
            std::copy_n(row.reference.position + space::first_joint, max_joints, to.reference_joints_rad.begin());
            to.position_m = row.motion.position_m;
            to.clearance_m = row.clearance_m;
            for (int i = 0; i < flight.rotor_count; ++i) {
                to.thrust_n += row.rotor_command_n[i];
            }
        }
        return planned;
    }

    [[nodiscard]] std::vector<Vector3> fly_in_world(std::uint64_t seed, std::uint64_t index) const override {
        SpaceExecutionSettings settings;
        settings.world = draw_space_world(*model_.problem().uncertainty, model_.problem().robot, seed, index);
        settings.measures_clearance = false;  // places are all that is asked for
        std::vector<Vector3> places;
        for (const SpaceFlightRow& row : model_.execute(plan_, settings).rows) {
            places.push_back(row.motion.position_m);
        }
        return places;
    }

    [[nodiscard]] double clearance_m(const FlownPose& pose) const override {
        return model_.collisions().clearance_m(in_space(pose));
    }
    [[nodiscard]] std::string nearest_obstacle(const FlownPose& pose) const override {
        return name_of_obstacle(model_.scene(), model_.collisions().nearest_obstacle(in_space(pose), far_m));
    }

 private:
    static SpacePose in_space(const FlownPose& pose) {
        SpacePose placed{pose.position_m, pose.attitude, {}};
        std::copy_n(pose.joints_rad.begin(), std::min(pose.joints_rad.size(), placed.joints_rad.size()),
                    placed.joints_rad.begin());
        return placed;
    }

    SpaceProblemModel model_;
    SpacePlan plan_;
};

}  // namespace

std::unique_ptr<const ComparedPlan> compared_plan(const Problem& problem, const Plan& plan) {
    return std::make_unique<PlanarPlan>(problem, plan);
}

std::unique_ptr<const ComparedPlan> compared_plan(const SpaceProblem& problem, const SpacePlan& plan) {
    return std::make_unique<PlanInSpace>(problem, plan);
}

}  // namespace downwash
