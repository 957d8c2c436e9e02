#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/base/lane_pack.hpp"
#include "random_space_plant.hpp"

// The slipstreams of rotors anywhere on links anywhere.

using namespace downwash;
using namespace downwash::test;
using dynamics::LaneVector;

namespace {

constexpr double radius_m = 0.12;

/// A hexarotor whose rotors are tilted by some degrees, with links that turn about different axes.
SpacePlant washed_plant(Random& random, int joints, double tilt) {
    SpacePlant plant;
    plant.multirotor = {3, {{{0.05, 0, 0}, {0, 0.05, 0}, {0, 0, 0.08}}}};
    for (int i = 0; i < 6; ++i) {
        const double angle = M_PI / 6 + i * M_PI / 3;
        // Exact mirrors: the second three are the first three with the opposite y.
        const double x = i < 3 ? std::cos(angle) : plant.rotors[static_cast<std::size_t>(5 - i)].position_m[0] / 0.3;
        const double y = i < 3 ? std::sin(angle) : -plant.rotors[static_cast<std::size_t>(5 - i)].position_m[1] / 0.3;
        Vector3 axis{tilt * x, tilt * y, 1};
        Vector3 position{0.3 * x, 0.3 * y, 0.05};
        if (i >= 3) {
            const SpaceRotor& mirror = plant.rotors[static_cast<std::size_t>(5 - i)];
            axis = {mirror.axis[0], -mirror.axis[1], mirror.axis[2]};
            position = {mirror.position_m[0], -mirror.position_m[1], mirror.position_m[2]};
        }
        plant.rotors.push_back({position, axis, i % 2 == 0 ? 1 : -1, 0.01});
    }
    for (int i = 0; i < joints; ++i) {
        SpaceLink link;
        link.body = {0.1, {{{0.001, 0, 0}, {0, 0.001, 0}, {0, 0, 0.001}}}};
        link.joint_m = i == 0 ? Vector3{0.02, 0.03, -0.06} : random_vector(random, 0.25);
        link.axis = random_vector(random, 1);
        link.drag = {0.05, 0.2};
        plant.links.push_back(link);
    }
    plant.end_effector_m = random_vector(random, 0.3);
    plant.wash.emplace();
    return plant;
}

template <int n>
dynamics::SpaceLoad<double, n> wash_of(const SpaceModel<n>& model, const SpaceSlipstreams& slipstreams,
                                       const dynamics::SpaceState<double, n>& state, const LaneVector<double>& wind,
                                       double scale = 1) {
    const auto places = dynamics::places_at(model, state.q);
    const LaneVector<double> through_air = LaneVector<double>{state.u[0], state.u[1], state.u[2]} - wind;
    const auto streams =
        dynamics::link_streams(model, places, dynamics::turned_back(places.attitude, through_air), state.u);
    dynamics::SpaceLoad<double, n> load{};
    dynamics::add_link_forces(places, streams, dynamics::link_wash(model, slipstreams, streams, state.thrust_n, scale),
                              load);
    return load;
}

/// The same by a fine sum over all of every link, in body axes, with the velocity and the moments of each piece.
template <int n>
dynamics::SpaceLoad<double, n> fine_wash_of(const SpacePlant& plant, const SpaceModel<n>& model,
                                            const dynamics::SpaceState<double, n>& state,
                                            const LaneVector<double>& wind) {
    const auto places = dynamics::places_at(model, state.q);
    const LaneVector<double> air = dynamics::turned_back(places.attitude, wind);
    const double per_n = 1 / (2 * 1.225 * M_PI * radius_m * radius_m);
    dynamics::SpaceLoad<double, n> load{};
    for (int i = 0; i < n; ++i) {
        const LaneVector<double> end = i + 1 < n ? places.joint_m[(i + 1) % n] : places.end_effector_m;
        const LaneVector<double> way = end - places.joint_m[i];
        const LaneVector<double> along = 1 / std::sqrt(dot(way, way)) * way;
        const DragParameters& drag = plant.links[static_cast<std::size_t>(i)].drag;
        const auto across = [&](const LaneVector<double>& v) { return v - dot(v, along) * along; };
        const auto drag_of = [&](const LaneVector<double>& v) {
            return (drag.linear_n_s_m + drag.quadratic_n_s2_m2 * std::sqrt(dot(v, v))) * v;
        };
        constexpr int pieces = 4000;
        for (int piece = 0; piece < pieces; ++piece) {
            const LaneVector<double> at = places.joint_m[i] + (piece + 0.5) / pieces * way;
            const LaneVector<double> still = across(dynamics::velocity_at(places, i, at, state.u) - air);
            // Rotors 0 and 5, 1 and 4, 2 and 3 mirror each other: the momentum of both.
            for (int pair = 0; pair < 3; ++pair) {
                LaneVector<double> momentum{0, 0, 0};
                double squares = 0;
                for (const int rotor : {pair, 5 - pair}) {
                    const LaneVector<double>& axis = model.rotor[rotor].axis;
                    const LaneVector<double> from = at - model.rotor[rotor].position_m;
                    const double depth = -dot(from, axis) / radius_m;
                    const double away_squared = dot(from, from) / (radius_m * radius_m) - depth * depth;
                    const double square = per_n * state.thrust_n[rotor] *
                                          std::pow(dynamics::slipstream_speed(depth, std::max(away_squared, 0.0)), 2);
                    momentum = momentum - square * axis;
                    squares += square;
                }
                if (squares > 0) {
                    const LaneVector<double> wash = across(1 / std::sqrt(squares) * momentum);
                    dynamics::add_force_at(places, i, at, 1.0 / pieces * (drag_of(still) - drag_of(still - wash)),
                                           load);
                }
            }
        }
    }
    return load;
}

template <int n>
double greatest(const dynamics::SpaceLoad<double, n>& a, const dynamics::SpaceLoad<double, n>& b, double factor) {
    const LaneVector<double> force = a.wrench.force_n - factor * b.wrench.force_n;
    const LaneVector<double> torque = a.wrench.torque_nm - factor * b.wrench.torque_nm;
    double worst = std::max(std::sqrt(dot(force, force)), std::sqrt(dot(torque, torque)));
    for (int i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(a.joint_torque_nm[i] - factor * b.joint_torque_nm[i]));
    }
    return worst;
}

template <int n>
void check_against_fine_sum(std::uint64_t seed, double tilt) {
    Random random(seed);
    double largest = 0;
    double worst = 0;
    for (int trial = 0; trial < 100; ++trial) {
        const SpacePlant plant = washed_plant(random, n, tilt);
        const auto model = make_space_model<n>(plant);
        const SpaceSlipstreams slipstreams = space_slipstreams_of(plant, radius_m);
        CHECK(slipstreams.count == 3);
        auto state = random_space_state<n>(random, 1);
        for (double& thrust : state.thrust_n) {
            thrust = random.uniform(3, 9);
        }
        const LaneVector<double> wind{0.5, -0.3, 0.2};
        const auto expected = fine_wash_of(plant, model, state, wind);
        const auto found = wash_of(model, slipstreams, state, wind);
        largest = std::max(largest, greatest(expected, expected, 0));
        worst = std::max(worst, greatest(found, expected, 1));
    }
    CAPTURE(n, tilt, worst, largest);
    CHECK(largest > 0.3);
    CHECK(worst < 0.03 * largest);
}

struct Washed : dynamics::CalmSpace {
    explicit Washed(const SpaceSlipstreams& all) : washes(all) {}
    const SpaceSlipstreams& washes;
    static constexpr bool has_wind = true;
    static constexpr bool has_wash = true;
    [[nodiscard]] const SpaceSlipstreams& slipstreams() const { return washes; }
};

}  // namespace

TEST_CASE("The wash on links in space is a fine sum over them, for upright and for tilted rotors") {
    check_against_fine_sum<1>(1, 0);
    check_against_fine_sum<2>(2, 0);
    check_against_fine_sum<3>(3, 0.1);
}

TEST_CASE("Links that no slipstream meets feel nothing, and a link along one has no force") {
    Random random(5);
    SpacePlant plant = washed_plant(random, 1, 0);
    plant.links[0].axis = {0, 1, 0};
    plant.links[0].joint_m = {0, 0, -0.06};
    plant.end_effector_m = {0, 0, -0.3};  // hangs between the rotors, which are 0.3 m away
    const auto model = make_space_model<1>(plant);
    dynamics::SpaceState<double, 1> state{};
    state.q[3] = 1;
    std::fill(state.thrust_n, state.thrust_n + 6, 8.0);
    const auto hanging = wash_of(model, space_slipstreams_of(plant, radius_m), state, {0, 0, 0});
    CHECK(greatest(hanging, hanging, 0) == 0);
    // Below a rotor, hanging along its axis.
    plant.links[0].joint_m = {0.3 * std::cos(M_PI / 6), 0.15, -0.06};
    const auto below = make_space_model<1>(plant);
    const auto along = wash_of(below, space_slipstreams_of(plant, radius_m), state, {0, 0, 0});
    CHECK(greatest(along, along, 0) < 1e-12);
    // Across it: pushed down.
    state.q[7] = M_PI / 2;
    const auto across = wash_of(below, space_slipstreams_of(plant, radius_m), state, {0, 0, 0});
    CHECK(across.wrench.force_n.z < -0.05);
}

TEST_CASE("Slipstreams of a plant: none without a wash or links, and none of rotors that never meet a planar arm") {
    Random random(6);
    SpacePlant plant = washed_plant(random, 1, 0);
    plant.links[0].axis = {0, 1, 0};
    plant.links[0].joint_m = {0, 0, 0};
    plant.end_effector_m = {0.2, 0, 0};
    // Rotors 0.3 m and 0.15 m beside the plane; the slipstream's edge is at 1.285 R + 0.2135 (0.05 + 0.2) = 0.208 m.
    CHECK(space_slipstreams_of(plant, radius_m).count == 2);
    plant.end_effector_m = {0.2, 0.01, 0};  // no longer in a plane
    CHECK(space_slipstreams_of(plant, radius_m).count == 3);
    plant.wash->scale = 0;
    CHECK(space_slipstreams_of(plant, radius_m).count == 0);
    plant.wash.reset();
    CHECK(space_slipstreams_of(plant, radius_m).count == 0);
    plant.wash.emplace();
    plant.links.clear();
    CHECK(space_slipstreams_of(plant, radius_m).count == 0);
}

TEST_CASE("Every lane of a washed arm in space has the bits of a flight alone") {
    using lane::Pack;
    Random random(9);
    const SpacePlant plant = washed_plant(random, 2, 0.05);
    const auto model = make_space_model<2>(plant);
    const SpaceSlipstreams slipstreams = space_slipstreams_of(plant, radius_m);
    const Washed around(slipstreams);
    dynamics::SpaceState<Pack, 2> packs{};
    dynamics::SpaceCommand<Pack, 2> commands{};
    dynamics::SpaceState<double, 2> alone[lane::pack_width];
    dynamics::SpaceCommand<double, 2> command{};
    std::fill(command.thrust_n, command.thrust_n + 6, 6.0);
    for (int i = 0; i < max_rotors; ++i) {
        commands.thrust_n[i] = Pack(command.thrust_n[i]);
        packs.thrust_n[i] = Pack(0);
    }
    commands.joint_torque_nm[0] = commands.joint_torque_nm[1] = Pack(0);
    packs.energy_j = Pack(0);
    for (int lane = 0; lane < lane::pack_width; ++lane) {
        alone[lane] = random_space_state<2>(random, 1);
        for (int i = 0; i < 9; ++i) {
            lane::set_number(packs.q[i], lane, alone[lane].q[i]);
        }
        for (int i = 0; i < 8; ++i) {
            lane::set_number(packs.u[i], lane, alone[lane].u[i]);
        }
    }
    for (int tick = 0; tick < 20; ++tick) {
        packs = dynamics::space_step(model, packs, commands, Pack(0.01), around);
    }
    for (int lane = 0; lane < lane::pack_width; ++lane) {
        alone[lane] = flown(model, alone[lane], command, 0.01, 20, around);
        for (int i = 0; i < 9; ++i) {
            CHECK(lane::number_in(packs.q[i], lane) == alone[lane].q[i]);
        }
        for (int i = 0; i < 8; ++i) {
            CHECK(lane::number_in(packs.u[i], lane) == alone[lane].u[i]);
        }
    }
}
