#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include "downwash/controllers/space_rest.hpp"
#include "downwash/simulation/space_effect_slope.hpp"
#include "downwash/simulation/space_hover_loop.hpp"
#include "downwash/simulation/space_loop_of.hpp"

// The SpaceHoverLoop of one number of joints. Private: each number has a source file of its own, space_hover_<n>.cpp.

namespace downwash::simulation {

/// Equal steps under a command to which something is added between controller and plant.
template <int n>
struct DisturbedSpaceSteps {
    dynamics::SpaceCommand<double, n> added{};
    dynamics::EqualSpaceSteps equal;

    template <class Around>
    dynamics::SpaceState<double, n> operator()(const SpaceModel<n>& model, const dynamics::SpaceState<double, n>& state,
                                               const dynamics::SpaceCommand<double, n>& command, double dt_s,
                                               const Around& around) const {
        dynamics::SpaceCommand<double, n> acting = command;
        for (int i = 0; i < model.rotor_count; ++i) {
            acting.thrust_n[i] += added.thrust_n[i];
        }
        for (int i = 0; i < n; ++i) {
            acting.joint_torque_nm[i] += added.joint_torque_nm[i];
        }
        return equal(model, state, acting, dt_s, around);
    }
};

/// See SpaceHoverLoop.
template <int n>
class SpaceHoverLoopOf final : public SpaceHoverLoop {
 public:
    SpaceHoverLoopOf(const SpaceRobot& robot, const SpaceAero& aero, SpaceEffect& surfaces)
        : robot_(robot),
          model_(make_space_tick_model<n>(robot, aero)),
          world_(make_space_world<n>(robot, {})),
          plant_(plant_in(model_, world_.numbers)),
          surfaces_(surfaces) {
        steps_.equal = {dynamics::joint_steps(model_.nominal.plant, model_.tick_s)};
    }

    void stand(const SpacePoint& place) override {
        SpaceMotion motion;
        std::copy_n(place.position, 3, motion.position_m.begin());
        std::copy_n(place.position + space::first_joint, n, motion.joints_rad.begin());
        at_rest_ = vehicle_at(model_, motion);
        yaw_rad_ = place.position[space::yaw];
        lean(0, 0);
    }
    SpaceHoverTrim settle() override {
        using Vector = dynamics::LaneVector<double>;
        const SpaceModel<n>& plant = model_.nominal.plant;
        // What balances the level vehicle in free air, to begin with.
        const double still[dynamics::space_speeds<n>]{};
        const auto e = dynamics::equations_of_motion(plant, dynamics::places_at(plant, at_rest_.plant.q), still);
        const Vector up{0, 0, standard_gravity_m_s2};
        const Vector torque = cross(e.first_moment_kg_m, up);
        std::vector<double> x{0, 0, plant.total_mass_kg * standard_gravity_m_s2, torque.x, torque.y, torque.z};
        for (int i = 0; i < n; ++i) {
            x.push_back(dot(e.joint_push_kg_m[i], up));
        }
        bool is_found = true;
        constexpr int most_rounds = 20;  // K may have a kink beside the vehicle
        for (int round = 0; round < most_rounds && is_found; ++round) {
            // K is linear about a pose; a vehicle that leans has its rotors elsewhere.
            const double leaned[2] = {x[0], x[1]};
            lean(x[0], x[1]);
            take_tangents();
            is_found = find_root([&](const auto& tried, auto& rates) { accelerations_at(tried, rates); }, x);
            if (std::hypot(x[0] - leaned[0], x[1] - leaned[1]) < 1e-6) {
                break;
            }
        }
        if (!is_found) {
            x[0] = x[1] = 0;
        }
        lean(x[0], x[1]);
        command_at(x);
        SpaceHoverTrim trim;
        trim.motion = motion_of(at_rest_.plant);
        trim.tilt_rad = std::hypot(x[0], x[1]);
        std::copy_n(command_.thrust_n, plant.rotor_count, trim.rotor_command_n.begin());
        std::copy_n(command_.joint_torque_nm, n, trim.joint_torque_nm.begin());
        std::copy_n(command_.thrust_n, max_rotors, at_rest_.plant.thrust_n);
        rest(trim);
        HoverTick once;
        tick({}, once);
        trim.saturation = once.saturation;
        if (const HoldLimit limit = limit_of_plant(is_found); limit != HoldLimit::none) {
            trim.limit = limit;
        }
        return trim;
    }

    [[nodiscard]] std::vector<Vector3> hubs_m() const override {
        std::vector<Vector3> hubs;
        for (int i = 0; i < model_.nominal.plant.rotor_count; ++i) {
            const dynamics::LaneVector<double> at = hub(i);
            hubs.push_back({at.x, at.y, at.z});
        }
        return hubs;
    }
    [[nodiscard]] std::vector<bool> feeds_back() const override {
        std::vector<bool> flags(numbers);
        for (int i = 0; i < numbers; ++i) {
            flags[static_cast<std::size_t>(i)] = number_at<bool>(feeds_back_, i);
        }
        return flags;
    }
    [[nodiscard]] int motion_numbers() const override {
        return dynamics::space_coordinates<n> + dynamics::space_speeds<n>;
    }
    [[nodiscard]] double delay_ticks() const override { return world_.numbers.delay_ticks; }
    [[nodiscard]] double tick_s() const override { return model_.tick_s; }

    void tick(const HoverChange& change, HoverTick& result) override {
        SpaceFlightState<double, n> state{};
        SpaceVehicle<double, n>& vehicle = state;
        vehicle = at_rest_;
        state.world = memory_at_start(world_, at_rest_.plant);
        state.world.older.resize(older_ticks(world_.numbers.delay_ticks), state.world.past[recent_ticks - 1]);
        BasicSpacePoint<double, n> reference = reference_;
        steps_.added = {};
        if (change.of == HoverChange::Of::state) {
            set_number_at(vehicle, change.index, number_at<double>(vehicle, change.index) + change.by);
        } else if (change.of == HoverChange::Of::past_motion) {
            PastSpaceMotion<double, n>& then =
                change.age <= recent_ticks ? state.world.past[change.age - 1]
                                           : state.world.older[static_cast<std::size_t>(change.age - recent_ticks - 1)];
            set_number_at(then, change.index, number_at<double>(then, change.index) + change.by);
        } else if (change.of == HoverChange::Of::loop) {
            add(change.index, change.by, reference);
        }
        const double noise[space_noise_count] = {};
        SpaceActuation<double, n> given{};
        SpaceFlightState<double, n> next{};
        result.asked.assign(static_cast<std::size_t>(space_loops::first_joint + n), 0);
        std::visit(
            [&](const auto& law) {
                tick_in_world(model_, law, world_.numbers, plant_, noise, state, reference, *effect_, given, next,
                              steps_);
                // What the law asks for but for what is added.
                double error[3], wanted[3];
                controllers::ask_accelerations(law, seen_state(world_.numbers, state.plant, state.world, noise),
                                               recalled<std::decay_t<decltype(law)>>(state.memory), reference_,
                                               model_.tick_s, error, wanted);
                result.asked[space_loops::x] = wanted[0];
                result.asked[space_loops::y] = wanted[1];
            },
            model_.law);
        const double* no_ratio = nullptr;
        const auto wrench = controllers::wrench_of(model_.nominal.plant, no_ratio, given.command.thrust_n);
        result.asked[space_loops::height] = wrench.force_n.z;
        result.asked[space_loops::roll] = wrench.torque_nm.x;
        result.asked[space_loops::pitch] = wrench.torque_nm.y;
        result.asked[space_loops::yaw] = wrench.torque_nm.z;
        std::copy_n(given.command.joint_torque_nm, n, result.asked.begin() + space_loops::first_joint);
        result.saturation = given.saturation;
        result.next.resize(numbers);
        const SpaceVehicle<double, n>& moved = next;
        for (int i = 0; i < numbers; ++i) {
            result.next[static_cast<std::size_t>(i)] = number_at<double>(moved, i);
        }
    }

    [[nodiscard]] HoverSlopes slopes() override {
        constexpr double step = 1e-4;
        const auto wrench = [&](double roll_rad, double pitch_rad, double up_m, const double* thrust_n) {
            const SpaceVehicle<double, n> kept = at_rest_;
            lean(lean_rad_[0] + roll_rad, lean_rad_[1] + pitch_rad);
            const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(at_rest_.plant.q + 3);
            const dynamics::LaneVector<double> at{kept.plant.q[0], kept.plant.q[1], kept.plant.q[2] + up_m};
            lean_rad_[0] -= roll_rad;
            lean_rad_[1] -= pitch_rad;
            at_rest_ = kept;
            return dynamics::rotor_wrench(model_.nominal.plant, attitude, at, thrust_n, around());
        };
        const double* at_trim = command_.thrust_n;
        double more_n[max_rotors];  // with a newton more of lift
        for (int i = 0; i < model_.nominal.plant.rotor_count; ++i) {
            more_n[i] = at_trim[i] + model_.nominal.allocation.share[i][0] / ratio_[i];
        }
        HoverSlopes slopes;
        slopes.force_n_m =
            (wrench(0, 0, step, at_trim).force_n.z - wrench(0, 0, -step, at_trim).force_n.z) / (2 * step);
        slopes.roll_nm_rad =
            (wrench(step, 0, 0, at_trim).torque_nm.x - wrench(-step, 0, 0, at_trim).torque_nm.x) / (2 * step);
        slopes.pitch_nm_rad =
            (wrench(0, step, 0, at_trim).torque_nm.y - wrench(0, -step, 0, at_trim).torque_nm.y) / (2 * step);
        slopes.force_gain_n_m = model_.nominal.plant.total_mass_kg * height_gain_1_s2_ *
                                (wrench(0, 0, 0, more_n).force_n.z - wrench(0, 0, 0, at_trim).force_n.z);
        return slopes;
    }

 private:
    static constexpr int numbers = number_count<double, SpaceVehicle<double, n>>;

    [[nodiscard]] NominalSpace<double, SpaceEffect> around() {
        return NominalSpace<double, SpaceEffect>(*effect_, model_.tilt_loss, model_.slipstreams);
    }
    [[nodiscard]] dynamics::LaneVector<double> place() const {
        return {at_rest_.plant.q[0], at_rest_.plant.q[1], at_rest_.plant.q[2]};
    }
    [[nodiscard]] dynamics::LaneVector<double> hub(int rotor) const {
        return place() + dynamics::rotation_of(at_rest_.plant.q + 3) * model_.nominal.plant.rotor[rotor].position_m;
    }

    /// Turns the vehicle to its yaw, then by so much about its own x and y together.
    void lean(double about_x_rad, double about_y_rad) {
        lean_rad_[0] = about_x_rad;
        lean_rad_[1] = about_y_rad;
        const lane::SinCos yaw = lane::sin_cos(0.5 * yaw_rad_);
        const double angle_rad = std::hypot(about_x_rad, about_y_rad);
        const lane::SinCos half = lane::sin_cos(0.5 * angle_rad);
        const double share = angle_rad > 0 ? half.sine / angle_rad : 0.5;
        const double x = share * about_x_rad, y = share * about_y_rad;
        double* q = at_rest_.plant.q + 3;
        q[0] = yaw.cosine * half.cosine;
        q[1] = yaw.cosine * x - yaw.sine * y;
        q[2] = yaw.cosine * y + yaw.sine * x;
        q[3] = yaw.sine * half.cosine;
    }

    /// K and what the law reads, about where the vehicle is.
    void take_tangents() {
        const SpaceModel<n>& plant = model_.nominal.plant;
        AskedPlaces places;
        places.has_fountain = plant.has_fountain;
        places.has_walls = plant.has_walls;
        places.attitude = dynamics::rotation_of(at_rest_.plant.q + 3);
        places.center_m = place() + places.attitude * plant.center_m;
        const auto* law = std::get_if<SpaceInversion>(&model_.law);
        for (int i = 0; i < plant.rotor_count; ++i) {
            places.hub_m.push_back(hub(i));
            if (law != nullptr && law->feed_forward) {
                const Vector3& offset = law->feed_forward_offset_m;
                places.read_hub_m.push_back(hub(i) - dynamics::LaneVector<double>{offset[0], offset[1], offset[2]});
            }
        }
        effect_ = std::make_unique<LinearSpaceEffect>(surfaces_, places);
    }

    /// The commands of the law for lift and torques that it asks for, and its belief in what they do.
    /// @param x lean about x and y, lift, three torques, joint torques
    void command_at(const std::vector<double>& x) {
        const auto* law = std::get_if<SpaceInversion>(&model_.law);
        const bool reads = law != nullptr && law->feed_forward;
        std::fill(std::begin(ratio_), std::end(ratio_), 1.0);
        if (reads) {
            const NominalSpace<double, SpaceEffect> surroundings = around();
            controllers::read_ratios(model_.nominal, at_rest_.plant, dynamics::rotation_of(at_rest_.plant.q + 3),
                                     law->feed_forward_offset_m,
                                     SeenRatios<double, n, NominalSpace<double, SpaceEffect>>(
                                         model_.nominal.plant, at_rest_.plant, surroundings),
                                     ratio_);
        }
        double tilt_n[max_rotors], yaw_n[max_rotors];
        const double* known = reads ? ratio_ : nullptr;
        controllers::acting_thrusts(model_.nominal, known, {x[2], {x[3], x[4], x[5]}}, tilt_n, yaw_n);
        command_ = {};
        for (int i = 0; i < model_.nominal.plant.rotor_count; ++i) {
            command_.thrust_n[i] = (tilt_n[i] + yaw_n[i]) / ratio_[i];
        }
        for (int i = 0; i < n; ++i) {
            command_.joint_torque_nm[i] = x[static_cast<std::size_t>(6 + i)];
        }
        believed_ = controllers::wrench_of(model_.nominal.plant, known, command_.thrust_n);
    }

    /// How a vehicle at rest would accelerate.
    void accelerations_at(const std::vector<double>& x, std::vector<double>& rates) {
        lean(x[0], x[1]);
        command_at(x);
        const double still[dynamics::space_speeds<n>]{};
        rates.resize(static_cast<std::size_t>(dynamics::space_speeds<n>));
        dynamics::accelerations(model_.nominal.plant, at_rest_.plant.q, still, command_.thrust_n,
                                dynamics::rotor_spin_of(model_.nominal.plant, command_.thrust_n),
                                command_.joint_torque_nm, around(), rates.data());
    }

    /// The controller's side of the equilibrium.
    void rest(SpaceHoverTrim& trim) {
        controllers::SpaceRestingCommand<n> command;
        std::copy_n(at_rest_.plant.q, dynamics::space_coordinates<n>, command.q);
        command.wrench = believed_;
        std::copy_n(command_.joint_torque_nm, n, command.joint_torque_nm);
        feeds_back_ = {};
        std::fill_n(feeds_back_.plant.q, dynamics::space_coordinates<n>, true);
        std::fill_n(feeds_back_.plant.u, dynamics::space_speeds<n>, true);
        std::fill_n(feeds_back_.plant.thrust_n, model_.nominal.plant.rotor_count, model_.nominal.plant.has_rotor_lag);
        const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(at_rest_.plant.q + 3);
        for (int axis = 0; axis < 4 + n; ++axis) {
            reference_.position[axis] = axis < 3             ? at_rest_.plant.q[axis]
                                        : axis == space::yaw ? lane::atan2(attitude.first.y, attitude.first.x)
                                                             : at_rest_.plant.q[3 + axis];
        }
        std::visit(
            [&](const auto& law) {
                const auto rest = controllers::space_rest(law, model_.nominal, command);
                remember(rest.memory, at_rest_.memory);
                remember(rest.feeds_back, feeds_back_.memory);
                for (int axis = 0; axis < 4 + n; ++axis) {
                    reference_.position[axis] += rest.error[axis];
                }
                trim.height_gain_1_s2 = height_gain_1_s2_ = rest.height_gain_1_s2;
                trim.tilt_gain_1_s2 = rest.tilt_gain_1_s2;
                trim.limit = rest.limit;
            },
            model_.law);
        std::copy_n(reference_.position, 4 + n, trim.reference.position);
    }

    /// What of the vehicle stands in the way.
    [[nodiscard]] HoldLimit limit_of_plant(bool is_found) const {
        for (int i = 0; i < n; ++i) {
            const SpaceLinkLimits& link = robot_.links[static_cast<std::size_t>(i)];
            const double angle_rad = at_rest_.plant.q[7 + i];
            if (link.is_limited && (angle_rad < link.lower_limit_rad || angle_rad > link.upper_limit_rad)) {
                return HoldLimit::arm_angle;
            }
        }
        if (!is_found || !(controllers::rotor_saturation(model_.nominal, command_.thrust_n) < 1)) {
            return HoldLimit::rotor_thrust;
        }
        for (int i = 0; i < n; ++i) {
            if (!(std::abs(command_.joint_torque_nm[i]) < model_.nominal.max_joint_torque_nm[i])) {
                return HoldLimit::joint_torque;
            }
        }
        return HoldLimit::none;
    }

    /// Adds something to what the law asks for. @param loop of space_loops
    void add(int loop, double by, BasicSpacePoint<double, n>& reference) {
        if (loop <= space_loops::y) {
            reference.acceleration[loop] += by;
        } else if (loop < space_loops::first_joint) {
            for (int i = 0; i < model_.nominal.plant.rotor_count; ++i) {
                steps_.added.thrust_n[i] = model_.nominal.allocation.share[i][loop - space_loops::height] * by;
            }
        } else {
            steps_.added.joint_torque_nm[loop - space_loops::first_joint] = by;
        }
    }

    const SpaceRobot& robot_;
    SpaceTickModel<n> model_;
    FlownSpaceWorld<n> world_;
    BasicSpaceModel<double, n> plant_;
    SpaceEffect& surfaces_;
    std::unique_ptr<SpaceEffect> effect_;  ///< tangents where the vehicle rests
    SpaceVehicle<double, n> at_rest_{};
    SpaceVehicle<bool, n> feeds_back_{};
    BasicSpacePoint<double, n> reference_{};
    dynamics::SpaceCommand<double, n> command_{};
    dynamics::SpaceWrench<double> believed_{};  ///< what the law believes that the rotors do
    double ratio_[max_rotors] = {};             ///< K that the law reads
    double yaw_rad_ = 0, lean_rad_[2] = {};
    double height_gain_1_s2_ = 0;
    DisturbedSpaceSteps<n> steps_;
};

/// The SpaceHoverLoop of a robot with n joints; space_hover_<n>.cpp defines it.
template <int n>
[[nodiscard]] std::unique_ptr<SpaceHoverLoop> make_space_hover_loop_of(const SpaceRobot& robot, const SpaceAero& aero,
                                                                       SpaceEffect& surfaces);

}  // namespace downwash::simulation
