#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "../dynamics/random_space_plant.hpp"
#include "space_loop.hpp"

using namespace downwash;
using namespace downwash::controllers;
using namespace downwash::test;
using dynamics::LaneVector;

namespace {

/// A hexarotor whose rotors tilt by 5 degrees about their arms, to either side in turn.
SpacePlant tilted_hexarotor() {
    SpacePlant plant = hexarotor(0);
    for (std::size_t i = 0; i < 6; ++i) {
        const Vector3 at = plant.rotors[i].position_m;
        const double lean = (i % 2 == 0 ? 0.0875 : -0.0875) / 0.185;
        plant.rotors[i].axis = {-lean * at[1], lean * at[0], 1};
    }
    return plant;
}

SpacePlant quadrotor() {
    SpacePlant plant = hexarotor(0);
    plant.rotors.clear();
    for (const double x_m : {0.2, -0.2}) {
        for (const double y_m : {0.2, -0.2}) {
            plant.rotors.push_back({{x_m, y_m, 0.03}, {0, 0, 1}, x_m * y_m > 0 ? 1 : -1, 0.017});
        }
    }
    return plant;
}

std::vector<SpacePlant> layouts(Random& random) {
    std::vector<SpacePlant> all = {hexarotor(0), tilted_hexarotor(), quadrotor()};
    for (int i = 0; i < 5; ++i) {
        all.push_back(random_space_plant(random, 0));
    }
    return all;
}

SpaceDemand<double> random_demand(Random& random, double scale) {
    return {random.uniform(5, 40),
            {scale * random.uniform(-1, 1), scale * random.uniform(-1, 1), scale * random.uniform(-0.3, 0.3)}};
}

/// Rows lift, roll, pitch, yaw; a column for each rotor.
Eigen::MatrixXd effectiveness(const SpaceModel<0>& model) {
    Eigen::MatrixXd rows(4, model.rotor_count);
    for (int i = 0; i < model.rotor_count; ++i) {
        const auto& rotor = model.rotor[i];
        const LaneVector<double> torque = cross(rotor.position_m, rotor.axis) + rotor.reaction_m * rotor.axis;
        rows.col(i) << rotor.axis.z, torque.x, torque.y, torque.z;
    }
    return rows;
}

/// What a hexarotor's rotors make of a demand, clipped.
struct Clipped {
    double thrust_n[max_rotors];
    Eigen::Vector4d wrench;
};

Clipped clipped(const SpaceLawModel<0>& model, const SpaceDemand<double>& demand) {
    double tilt_n[max_rotors], yaw_n[max_rotors];
    Clipped result{};
    acting_thrusts<0, double>(model, nullptr, demand, tilt_n, yaw_n);
    clip_by_priority(model, tilt_n, yaw_n, demand.lift_n, model.min_thrust_n, model.max_thrust_n, result.thrust_n);
    Eigen::VectorXd thrusts(model.plant.rotor_count);
    for (int i = 0; i < model.plant.rotor_count; ++i) {
        thrusts[i] = result.thrust_n[i];
    }
    result.wrench = effectiveness(model.plant) * thrusts;
    return result;
}

/// Whether rotors can give shares of the torques of a demand at a lift.
bool is_possible(const SpaceLawModel<0>& model, const SpaceDemand<double>& demand, double lift_n, double tilt_share,
                 double yaw_share) {
    const SpaceAllocation& a = model.allocation;
    for (int i = 0; i < a.rotor_count; ++i) {
        const double thrust_n = a.share[i][0] * lift_n +
                                tilt_share * (a.share[i][1] * demand.torque_nm.x + a.share[i][2] * demand.torque_nm.y) +
                                yaw_share * a.share[i][3] * demand.torque_nm.z;
        if (thrust_n < model.min_thrust_n[i] - 1e-9 || thrust_n > model.max_thrust_n[i] + 1e-9) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("In free air thrusts are the least squares of any layout, tilted or not") {
    Random random(1);
    for (const SpacePlant& plant : layouts(random)) {
        const SpaceLawModel<0> model = law_model_of<0>(plant);
        REQUIRE(model.allocation.has_full_rank);
        const Eigen::MatrixXd rows = effectiveness(model.plant);
        for (int trial = 0; trial < 100; ++trial) {
            const SpaceDemand<double> demand = random_demand(random, 1);
            double tilt_n[max_rotors], yaw_n[max_rotors];
            acting_thrusts<0, double>(model, nullptr, demand, tilt_n, yaw_n);
            const Eigen::Vector4d wanted(demand.lift_n, demand.torque_nm.x, demand.torque_nm.y, demand.torque_nm.z);
            const Eigen::VectorXd least = rows.completeOrthogonalDecomposition().solve(wanted);
            double worst = 0;
            for (int i = 0; i < model.plant.rotor_count; ++i) {
                worst = std::max(worst, std::abs(tilt_n[i] + yaw_n[i] - least[i]));
            }
            CHECK(worst < 1e-9 * std::max(1.0, least.norm()));
        }
    }
}

TEST_CASE("Against thrust ratios the commands give the demand, drag torques without K included") {
    Random random(2);
    for (const SpacePlant& plant : layouts(random)) {
        const SpaceLawModel<0> model = law_model_of<0>(plant, -1e3, 1e3);  // nothing is clipped
        const auto state = hovering<0>(model.plant);
        for (int trial = 0; trial < 100; ++trial) {
            double ratio[max_rotors];
            for (double& k : ratio) {
                k = random.uniform(0.8, 1.6);
            }
            const SpaceDemand<double> demand = random_demand(random, 1);
            dynamics::SpaceCommand<double, 0> given;
            command_rotors<double, 0>(model, state, ratio, demand, 0.01, 0, given);
            // What acts, by the plant's own rotors.
            const RatiosInSpace around([&](int rotor, double, double, double) { return ratio[rotor]; });
            const auto wrench = dynamics::rotor_wrench(model.plant, dynamics::rotation_of(state.q + 3), {0, 0, 0},
                                                       given.thrust_n, around);
            CHECK(wrench.force_n.z == Approx(demand.lift_n).epsilon(1e-9));
            CHECK(wrench.torque_nm.x == Approx(demand.torque_nm.x).margin(1e-9));
            CHECK(wrench.torque_nm.y == Approx(demand.torque_nm.y).margin(1e-9));
            CHECK(wrench.torque_nm.z == Approx(demand.torque_nm.z).margin(1e-9));
        }
    }
}

TEST_CASE("Clipping keeps roll and pitch torque, gives up yaw, then shifts the lift no further than it must") {
    Random random(3);
    int yaw_given_up = 0;
    int lift_shifted = 0;
    int tilt_shrunk = 0;
    for (const SpacePlant& plant : {hexarotor(0), tilted_hexarotor(), quadrotor()}) {
        const SpaceLawModel<0> model = law_model_of<0>(plant, 0.5, 9);
        for (int trial = 0; trial < 1000; ++trial) {
            SpaceDemand<double> demand = random_demand(random, random.uniform(0, 10));
            demand.lift_n = random.uniform(-20, 80);
            const Clipped got = clipped(model, demand);
            for (int i = 0; i < model.plant.rotor_count; ++i) {
                CHECK(got.thrust_n[i] >= 0.5);
                CHECK(got.thrust_n[i] <= 9);
            }
            // Both torques by the same factor.
            const double size = std::hypot(demand.torque_nm.x, demand.torque_nm.y);
            const double share =
                (got.wrench[1] * demand.torque_nm.x + got.wrench[2] * demand.torque_nm.y) / (size * size);
            CHECK(std::hypot(got.wrench[1] - share * demand.torque_nm.x, got.wrench[2] - share * demand.torque_nm.y) <
                  1e-9);
            CHECK(share <= 1 + 1e-9);
            if (share < 1 - 1e-6) {  // no lift leaves room for more
                ++tilt_shrunk;
                for (double lift_n = 0; lift_n < 60; lift_n += 0.01) {
                    CHECK_FALSE(is_possible(model, demand, lift_n, 1.001 * share, 0));
                }
                continue;
            }
            if (!is_possible(model, demand, demand.lift_n, 1, 0)) {  // no lift nearer to the demand does
                ++lift_shifted;
                const double off_n = std::abs(got.wrench[0] - demand.lift_n);
                CHECK(off_n > 0);
                for (double nearer = 0; nearer < off_n - 1e-6; nearer += off_n / 100) {
                    CHECK_FALSE(is_possible(model, demand, demand.lift_n + nearer, 1, 0));
                    CHECK_FALSE(is_possible(model, demand, demand.lift_n - nearer, 1, 0));
                }
            } else {
                CHECK(got.wrench[0] == Approx(demand.lift_n));
            }
            const double yaw_share = got.wrench[3] / demand.torque_nm.z;
            CHECK(yaw_share >= -1e-9);
            CHECK(yaw_share <= 1 + 1e-9);
            if (yaw_share < 1 - 1e-6) {
                ++yaw_given_up;
                CHECK_FALSE(is_possible(model, demand, got.wrench[0], 1, yaw_share + 1e-3));
            }
        }
    }
    CHECK(yaw_given_up > 100);
    CHECK(lift_shifted > 100);
    CHECK(tilt_shrunk > 100);
}

TEST_CASE("A demand within the limits is commanded as it is, with each rotor's own limits and lead") {
    std::vector<double> least(6, 0);
    std::vector<double> most(6, 12);
    most[2] = 3;
    const SpaceLawModel<0> model = make_space_law_model<0>(hexarotor(0), least, most, {});
    auto state = hovering<0>(model.plant);
    dynamics::SpaceCommand<double, 0> given;
    const double* no_ratio = nullptr;
    const double weight_n = model.plant.total_mass_kg * standard_gravity_m_s2;
    const auto free = command_rotors<double, 0>(model, state, no_ratio, {0.6 * weight_n, {0, 0, 0}}, 0.01, 0, given);
    CHECK(free.saturation == Approx(0.1 * weight_n / 3));
    CHECK(given.thrust_n[0] == Approx(0.1 * weight_n));
    CHECK(given.thrust_n[6] == 0);
    // With lead 1 a rotor is asked for twice what it lacks; the lead does not count as saturation.
    const auto lead = command_rotors<double, 0>(model, state, no_ratio, {0.6 * weight_n, {0, 0, 0}}, 0.01, 1, given);
    CHECK(given.thrust_n[0] == Approx(0.1 * weight_n - (state.thrust_n[0] - 0.1 * weight_n)));
    CHECK(lead.saturation == free.saturation);
    // The third rotor is the first at its limit: lift shrinks until it is within.
    const auto clipped = command_rotors<double, 0>(model, state, no_ratio, {weight_n, {0, 0, 0}}, 0.01, 0, given);
    CHECK(clipped.saturation == Approx(weight_n / 6 / 3));
    for (int i = 0; i < 6; ++i) {
        CHECK(given.thrust_n[i] == Approx(3));
    }
}

TEST_CASE("Lift points along b3 where tilts cancel, and elsewhere where the rotors push together") {
    const LaneVector<double> axis = law_model_of<0>(tilted_hexarotor()).allocation.lift_axis;
    CHECK(axis.x == 0);
    CHECK(axis.y == 0);
    CHECK(axis.z == 1);
    SpacePlant plant = hexarotor(0);
    for (SpaceRotor& rotor : plant.rotors) {
        rotor.axis = {0.1, 0, 1};
    }
    const SpaceLawModel<0> model = law_model_of<0>(plant);
    CHECK(model.allocation.lift_axis.x / model.allocation.lift_axis.z == Approx(0.1));
    // Such a vehicle hovers with its nose down, so that the thrust is vertical.
    const SpaceInversion law = gains_for(model.plant);
    const auto end = fly(
        law, model, model.plant, hovering<0>(model.plant), [](int) { return BasicSpacePoint<double, 0>{}; }, 1500);
    CHECK(off_m<0>(end.state, {}) < 5e-3);
    const auto up = dynamics::rotation_of(end.state.q + 3) * model.allocation.lift_axis;
    CHECK(up.z == Approx(1).epsilon(1e-6));
}

TEST_CASE("The torques of the joints are those under which the plant gives the demanded joint accelerations") {
    Random random(5);
    double worst = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const SpaceModel<3> model = make_space_model<3>(random_space_plant(random, 3));
        const auto state = random_space_state<3>(random, 2);
        const auto places = dynamics::places_at(model, state.q);
        const auto e = dynamics::equations_of_motion(model, places, state.u);
        const dynamics::SpaceWrench<double> wrench{
            {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 40)},
            {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)}};
        const double wanted[3] = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
        double torque_nm[3];
        joint_torques_for<double, 3>(model, e, wrench, wanted, torque_nm);
        double du[9];
        dynamics::forward_dynamics(model, places, e, wrench, torque_nm, du);
        for (int i = 0; i < 3; ++i) {
            worst = std::max(worst, std::abs(du[6 + i] - wanted[i]));
        }
    }
    CHECK(worst < 1e-9);
}
