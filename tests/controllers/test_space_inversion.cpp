#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/base/lane_pack.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/quintic.hpp"
#include "space_loop.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double degree = 0.017453292519943295;

template <int n>
BasicSpacePoint<double, n> somewhere() {
    BasicSpacePoint<double, n> point;
    const double at[] = {0.8, -0.6, 0.5, 1.2, 0.6, -0.5, 0.4};
    std::copy(at, at + 4 + n, point.position);
    return point;
}

/// From rest at the origin to rest at `end`, on quintics.
template <int n>
BasicSpacePoint<double, n> on_the_way(const BasicSpacePoint<double, n>& end, double duration_s, double t_s) {
    BasicSpacePoint<double, n> point;
    const double s = std::min(t_s / duration_s, 1.0);
    for (int i = 0; i < 4 + n; ++i) {
        const double l = end.position[i];
        const double c[6] = {0, 0, 0, 10 * l, -15 * l, 6 * l};
        const auto at = controllers::quintic_at(c, s, 1 / duration_s);
        point.position[i] = at.position;
        point.velocity[i] = at.velocity;
        point.acceleration[i] = at.acceleration;
    }
    return point;
}

template <int n>
double worst_off(const dynamics::SpaceState<double, n>& state, const BasicSpacePoint<double, n>& point) {
    double worst =
        std::max(off_m<n>(state, point), std::abs(std::remainder(yaw_of<n>(state) - point.position[3], 360 * degree)));
    for (int i = 0; i < n; ++i) {
        worst = std::max(worst, std::abs(state.q[7 + i] - point.position[4 + i]));
    }
    return worst;
}

/// Air in which a constant force acts on the end effector, or on a point of the multirotor.
struct PushedSomewhere : FreeSpace {
    explicit PushedSomewhere(const controllers::ToldPush& by) : push(by) {}
    controllers::ToldPush push;
    template <int n>
    void add_load(const double* /*q*/, const double* /*u*/, const dynamics::SpacePlaces<double, n>& places,
                  dynamics::SpaceLoad<double, n>& load) const {
        const auto force = turned_back(places.attitude, push.force_n);
        dynamics::add_force_at(places, push.is_on_end_effector ? n - 1 : -1,
                               push.is_on_end_effector ? places.end_effector_m : push.at_m, force, load);
    }
};

template <int n>
void check_loop() {
    const SpacePlant plant = hexarotor(n);
    const SpaceLawModel<n> nominal = law_model_of<n>(plant);
    const SpaceInversion law = gains_for(nominal.plant);
    const auto start = hovering<n>(nominal.plant);
    CAPTURE(n);

    // Hover: nothing moves but by what the first ticks put right.
    const auto hover = fly(
        law, nominal, nominal.plant, start, [](int) { return BasicSpacePoint<double, n>{}; }, 500);
    CHECK(worst_off<n>(hover.state, {}) < 2e-3);
    CHECK(hover.max_saturation < 0.6);

    // A step of all axes at once, and a smooth way there.
    const auto end = somewhere<n>();
    const auto step = fly(
        law, nominal, nominal.plant, start, [&](int) { return end; }, 1500);
    CHECK(worst_off<n>(step.state, end) < 5e-3);
    double worst = 0;
    auto flown = fly(
        law, nominal, nominal.plant, start, [&](int tick) { return on_the_way<n>(end, 4, tick * space_tick_s); }, 0);
    for (int tick = 0; tick < 400; ++tick) {
        typename SpaceInversion::Memory<double, n> next;
        const auto point = on_the_way<n>(end, 4, tick * space_tick_s);
        worst = std::max(worst, worst_off<n>(flown.state, point));
        law.control(nominal, flown.state, flown.memory, point, space_tick_s, controllers::NoRatios{}, flown.given,
                    next);
        flown.memory = next;
        flown.state = dynamics::space_step(nominal.plant, flown.state, flown.given, space_tick_s, FreeSpace{});
    }
    CAPTURE(worst);
    CHECK(worst < 0.06);
}

/// How many of some vehicles, thrown at any attitude with rates up to 3 rad/s per axis, come to rest at their place
/// within 15 s.
template <int n>
int recovered(int vehicles) {
    const SpaceLawModel<n> nominal = law_model_of<n>(hexarotor(n));
    const SpaceInversion law = gains_for(nominal.plant);
    const BasicSpacePoint<double, n> home{};
    Random random(7);
    int good = 0;
    for (int trial = 0; trial < vehicles; ++trial) {
        auto state = hovering<n>(nominal.plant);
        double size = 0;
        do {  // uniform over all attitudes: four numbers in the ball
            size = 0;
            for (int i = 3; i < 7; ++i) {
                state.q[i] = random.uniform(-1, 1);
                size += state.q[i] * state.q[i];
            }
        } while (size > 1 || size < 1e-4);
        dynamics::normalise_attitude(state.q);
        for (int i = 0; i < 3; ++i) {
            state.u[i] = random.uniform(-1, 1);
            state.u[3 + i] = random.uniform(-3, 3);
        }
        auto memory = law.rested(nominal, state, space_tick_s);
        for (int tick = 0; tick < 1500; ++tick) {
            SpaceInversion::Memory<double, n> next;
            dynamics::SpaceCommand<double, n> given;
            law.control(nominal, state, memory, home, space_tick_s, controllers::NoRatios{}, given, next);
            memory = next;
            state = dynamics::space_step(nominal.plant, state, given, space_tick_s, FreeSpace{});
            const double speed_m_s = std::hypot(state.u[0], state.u[1], state.u[2]);
            if (off_m<n>(state, home) < 0.1 && speed_m_s < 0.1 &&
                dynamics::rotation_of(state.q + 3).third.z > std::cos(2 * degree)) {
                ++good;
                break;
            }
        }
    }
    return good;
}

/// Rotors push more the higher they are.
struct UpwardMap {
    template <class T>
    T ratio(int /*rotor*/, const dynamics::LaneVector<T>& at) const {
        return T(1.1) + T(0.01) * at.z;
    }
};

/// The vehicle as lanes of a pack and one by one: the same bits.
template <int n>
int differing_numbers() {
    using lane::Pack;
    using Memory = SpaceInversion::Memory<double, n>;
    using State = dynamics::SpaceState<double, n>;
    constexpr int width = lane::pack_width;
    const SpaceLawModel<n> nominal = law_model_of<n>(hexarotor(n));
    SpaceInversion law = gains_for(nominal.plant);
    law.rate_feed_forward = law.feed_forward = true;
    Random random(11);
    State states[width];
    Memory memories[width];
    dynamics::SpaceState<Pack, n> pack{};
    SpaceInversion::Memory<Pack, n> pack_memory{};
    const auto load = [](auto& all, int lane, const auto& one) {
        for (int i = 0; i < number_count<double, std::remove_cvref_t<decltype(one)>>; ++i) {
            Pack numbers = number_at<Pack>(all, i);
            lane::set_number(numbers, lane, number_at<double>(one, i));
            set_number_at(all, i, numbers);
        }
    };
    for (int lane = 0; lane < width; ++lane) {
        states[lane] = hovering<n>(nominal.plant);
        for (int i = 0; i < 3; ++i) {  // some of them saturated
            states[lane].q[4 + i] = random.uniform(-1, 1) * lane;
            states[lane].u[3 + i] = random.uniform(-3, 3);
        }
        dynamics::normalise_attitude(states[lane].q);
        memories[lane] = law.rested(nominal, states[lane], space_tick_s);
        load(pack, lane, states[lane]);
        load(pack_memory, lane, memories[lane]);
    }
    BasicSpacePoint<Pack, n> pack_point{};
    const BasicSpacePoint<double, n> point = somewhere<n>();
    for (int i = 0; i < 4 + n; ++i) {
        pack_point.position[i] = Pack(point.position[i]);
        pack_point.velocity[i] = pack_point.acceleration[i] = Pack(0);
    }
    int saturated = 0;
    for (int tick = 0; tick < 100; ++tick) {
        dynamics::SpaceCommand<Pack, n> pack_given;
        SpaceInversion::Memory<Pack, n> pack_next;
        law.control(nominal, pack, pack_memory, pack_point, space_tick_s, UpwardMap{}, pack_given, pack_next);
        pack_memory = pack_next;
        pack = dynamics::space_step(nominal.plant, pack, pack_given, Pack(space_tick_s), FreeSpace{});
        for (int lane = 0; lane < width; ++lane) {
            dynamics::SpaceCommand<double, n> given;
            Memory next;
            saturated +=
                law.control(nominal, states[lane], memories[lane], point, space_tick_s, UpwardMap{}, given, next) > 1;
            memories[lane] = next;
            states[lane] = dynamics::space_step(nominal.plant, states[lane], given, space_tick_s, FreeSpace{});
        }
    }
    CHECK(saturated > 0);
    int differing = 0;
    for (int lane = 0; lane < width; ++lane) {
        for (int i = 0; i < number_count<double, State>; ++i) {
            differing += lane::number_in(number_at<Pack>(pack, i), lane) != number_at<double>(states[lane], i) ? 1 : 0;
        }
        for (int i = 0; i < number_count<double, Memory>; ++i) {
            differing +=
                lane::number_in(number_at<Pack>(pack_memory, i), lane) != number_at<double>(memories[lane], i) ? 1 : 0;
        }
    }
    return differing;
}

}  // namespace

TEST_CASE("In space a hexarotor with an arm of 0 to 3 joints hovers, takes a step and follows a smooth way") {
    check_loop<0>();
    check_loop<1>();
    check_loop<2>();
    check_loop<3>();
}

TEST_CASE("From any attitude all of 1,000 vehicles recover") {
    CHECK(recovered<0>(1000) == 1000);
    CHECK(recovered<1>(100) == 100);
    CHECK(recovered<2>(100) == 100);
    CHECK(recovered<3>(1000) == 1000);
}

TEST_CASE("A vehicle that asks for more lift than its rotors have stays upright beside an arm that is off its centre") {
    const SpacePlant plant = hexarotor(2);
    double mass_kg = plant.multirotor.mass_kg;
    for (const SpaceLink& link : plant.links) {
        mass_kg += link.body.mass_kg;
    }
    const double most_n = 1.3 * mass_kg * standard_gravity_m_s2 / 6;
    const SpaceLawModel<2> nominal = law_model_of<2>(plant, 0, most_n);
    const SpaceInversion law = gains_for(nominal.plant);
    BasicSpacePoint<double, 2> above{};
    above.position[space::z] = 300;
    above.position[space::first_joint] = 90 * degree;
    auto start = hovering<2>(nominal.plant);
    start.q[7] = 90 * degree;
    double most_tilt_cosine = 1;
    SpaceFlight<SpaceInversion, 2> flight{start, law.rested(nominal, start, space_tick_s), {}, 0};
    for (int tick = 0; tick < 500; ++tick) {
        SpaceInversion::Memory<double, 2> next;
        const double saturation = law.control(nominal, flight.state, flight.memory, above, space_tick_s,
                                              controllers::NoRatios{}, flight.given, next);
        flight.max_saturation = std::max(flight.max_saturation, saturation);
        flight.memory = next;
        flight.state = dynamics::space_step(nominal.plant, flight.state, flight.given, space_tick_s, FreeSpace{});
        most_tilt_cosine = std::min(most_tilt_cosine, dynamics::rotation_of(flight.state.q + 3).third.z);
    }
    CAPTURE(flight.state.q[2], most_tilt_cosine);
    CHECK(flight.max_saturation > 50);
    CHECK(most_tilt_cosine > std::cos(10 * degree));
    CHECK(flight.state.q[2] > 10);
}

TEST_CASE("Lanes of a pack are commanded the same bits as plain doubles, saturated or not") {
    CHECK(differing_numbers<0>() == 0);
    CHECK(differing_numbers<2>() == 0);
}

TEST_CASE("The demanded body rate is limited, and yaw is what waits") {
    const SpaceLawModel<0> nominal = law_model_of<0>(hexarotor(0));
    SpaceInversion law = gains_for(nominal.plant);
    law.direction_rate_filter_s = 1e9;  // no rate of the direction itself
    auto state = hovering<0>(nominal.plant);
    BasicSpacePoint<double, 0> turned{};
    turned.position[space::yaw] = 3;
    SpaceInversion::Memory<double, 0> next;
    dynamics::SpaceCommand<double, 0> given;
    const auto demanded = [&] {
        law.control(nominal, state, law.rested(nominal, state, space_tick_s), turned, space_tick_s,
                    controllers::NoRatios{}, given, next);
        return dynamics::LaneVector<double>{next.rate_reference[0], next.rate_reference[1], next.rate_reference[2]};
    };
    CHECK(demanded().z == law.max_yaw_rate_rad_s);
    CHECK(demanded().x == Approx(0).margin(1e-12));
    // On its side and more: the tilt comes at the greatest rate; yaw by the share of (1 + cos) / 2.
    state.q[3] = std::cos(1.4);
    state.q[4] = std::sin(1.4);
    const auto tilted = demanded();
    CHECK(tilted.x == Approx(-law.max_rate_rad_s));
    CHECK(tilted.z == Approx(law.yaw_kp_1_s * 3 * 0.5 * (1 + std::cos(2.8))).epsilon(1e-3));
    // Upside down every way up is as short as any: about the second axis.
    state.q[3] = 0;
    state.q[4] = 1;
    CHECK(std::abs(demanded().y) == Approx(law.max_rate_rad_s));
}

TEST_CASE("A law that is told of a push on the arm stands up to it in the places that its reference names") {
    // Compressed along the arm, which hangs, and pushed aside: three hinges in line that the force alone would fold.
    const SpaceLawModel<3> nominal = law_model_of<3>(hexarotor(3));
    SpaceInversion law = gains_for(nominal.plant);
    law.observer_gain_1_s = 0;
    for (SpaceLoopGains* gains : {&law.horizontal, &law.height, &law.joint}) {
        gains->ki_1_s3 = 0;
    }
    law.rate_ki_1_s2 = law.yaw_rate_ki_1_s2 = 0;
    struct Told : controllers::NoRatios, controllers::ToldPush {};
    Told told;
    told.is_on_end_effector = true;
    told.force_n = {0.6, -0.4, 2};
    const PushedSomewhere around(told);
    BasicSpacePoint<double, 3> here{};
    here.position[space::first_joint + 1] = 0.1;
    here.position[space::first_joint + 2] = -0.2;
    auto start = hovering<3>(nominal.plant);
    start.q[8] = 0.1;
    start.q[9] = -0.2;
    const auto reference = [&](int) { return here; };
    const auto flown = fly(law, nominal, nominal.plant, start, reference, 2000, around, told);
    CHECK(worst_off<3>(flown.state, here) < 1e-6);
    CHECK(flown.max_saturation < 1);
    // The thrust carries the weight and stands up to the push.
    const double weight_n = nominal.plant.total_mass_kg * standard_gravity_m_s2;
    const auto axis = dynamics::rotation_of(flown.state.q + 3).third;
    CHECK(axis.x / axis.z == Approx(-0.6 / (weight_n - 2)).epsilon(1e-6));
    CHECK(axis.y / axis.z == Approx(0.4 / (weight_n - 2)).epsilon(1e-6));
    // A law that is not told of it gives way.
    CHECK(worst_off<3>(fly(law, nominal, nominal.plant, start, reference, 200, around).state, here) > 0.1);
    // A push on the multirotor needs a torque against its lever.
    told.is_on_end_effector = false;
    told.at_m = {0.1, -0.05, 0.08};
    const PushedSomewhere on_body(told);
    CHECK(worst_off<3>(fly(law, nominal, nominal.plant, start, reference, 2000, on_body, told).state, here) < 1e-6);
}

TEST_CASE("With a map the feed-forward hovers under a surface as in free air") {
    const SpaceLawModel<2> nominal = law_model_of<2>(hexarotor(2));
    SpaceInversion law = gains_for(nominal.plant);
    law.observer_gain_1_s = 0;
    const auto ratio = [](double x_m, double z_m) { return 1.2 + 0.3 * x_m + 0.1 * z_m; };
    const RatiosInSpace around([&](int /*rotor*/, double x_m, double /*y_m*/, double z_m) { return ratio(x_m, z_m); });
    struct Map {
        [[nodiscard]] double ratio(int /*rotor*/, const dynamics::LaneVector<double>& at) const {
            return 1.2 + 0.3 * at.x + 0.1 * at.z;
        }
    };
    auto start = hovering<2>(nominal.plant);
    for (double& thrust : start.thrust_n) {
        thrust /= 1.205;
    }
    const auto home = [](int) { return BasicSpacePoint<double, 2>{}; };
    const auto off = [&](bool reads) {
        law.feed_forward = reads;
        return fly(law, nominal, nominal.plant, start, home, 100, around, Map{}).state;
    };
    CHECK(off_m<2>(off(true), {}) < 5e-3);
    CHECK(off_m<2>(off(false), {}) > 0.05);
}
