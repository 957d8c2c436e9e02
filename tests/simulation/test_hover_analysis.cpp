#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/repetitions.hpp"
#include "../support/single_tick.hpp"
#include "hover_scenes.hpp"

using namespace downwash;
using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

namespace {

constexpr double gravity = 9.80665;

/// The fit of the ceiling effect a distance below, and its slope.
struct Ceiling {
    explicit Ceiling(double gap_m) {
        const double r = radius_m / (gap_m + 0.3168 * radius_m);
        factor = 1 / (1 - r * r / 6.924);
        slope_1_m = 2 * factor * factor * r * r / 6.924 / (gap_m + 0.3168 * radius_m);
    }
    double factor;
    double slope_1_m;
};

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    return c;
}

/// Gelfand's formula, by squaring: |M^n|^(1/n) with n = 2^40.
double spectral_radius(Matrix3 m) {
    double log_norm = 0;
    double power = 1;
    for (int i = 0; i < 40; ++i) {
        double norm = 0;
        for (const auto& row : m) {
            for (const double entry : row) {
                norm = std::max(norm, std::abs(entry));
            }
        }
        for (auto& row : m) {
            for (double& entry : row) {
                entry /= norm;
            }
        }
        log_norm += std::log(norm) / power;
        m = product(m, m);
        power *= 2;
    }
    return std::exp(log_norm);
}

/// Height, its rate and the integral over one tick, by hand: between ticks the surface pushes like a negative spring,
/// d'' = (g K'/K) d + K v, with v = -kp d - kd d' + ki i held.
Matrix3 sampled_height(const ModelInversion& gains, const Ceiling& k) {
    const double h = 0.01;
    const double w = std::sqrt(gravity * k.slope_1_m / k.factor);
    const double c = std::cosh(w * h);
    const double s = std::sinh(w * h);
    const double per_v[2] = {k.factor * (c - 1) / (w * w), k.factor * s / w};
    const double v[3] = {-gains.position_kp, -gains.position_kd, gains.position_ki};
    Matrix3 m = {{{c, s / w, 0}, {w * s, c, 0}, {-h, 0, 1}}};
    for (std::size_t j = 0; j < 3; ++j) {
        m[0][j] += per_v[0] * v[j];
        m[1][j] += per_v[1] * v[j];
    }
    return m;
}

/// Greatest difference of two vehicles in any coordinate [m, rad].
double distance(const FlightState& a, const FlightState& b) {
    double greatest = 0;
    for (int i = 0; i < 4; ++i) {
        greatest = std::max(greatest, std::abs(a.plant.q[i] - b.plant.q[i]));
    }
    return greatest;
}

FlightState flown(const FlightModel& model, const HoverTrim& trim, const FlightState& from) {
    controllers::Actuation<double> given{};
    return single_quiet_tick(model, from, trim.reference, given);
}

/// Whether a disturbance of a millimetre leaves five centimetres, or is still growing in the end.
bool grows(const FlightModel& model, const HoverTrim& trim, int ticks, Random& random) {
    FlightState state = trim.state;
    for (int i = 0; i < 4; ++i) {
        state.plant.q[i] += random.uniform(-1e-3, 1e-3);
        state.plant.u[i] += random.uniform(-1e-3, 1e-3);
    }
    double before = 0;  // greatest distance in the third quarter of the flight
    double in_the_end = 0;
    for (int i = 0; i < ticks; ++i) {
        state = flown(model, trim, state);
        const double d = distance(state, trim.state);
        if (!(d < 0.05)) {
            return true;
        }
        if (4 * i >= 3 * ticks) {
            in_the_end = std::max(in_the_end, d);
        } else if (4 * i >= 2 * ticks) {
            before = std::max(before, d);
        }
    }
    return in_the_end > before && in_the_end > 1e-9;
}

/// The cluttered problem with a cascaded PID.
Problem cascaded_problem(bool has_memory) {
    Problem problem = cluttered_problem();
    CascadedPid law;
    if (has_memory) {
        problem.robot.rotors.time_constant_s = 0.02;
        law.vertical_velocity_kd = 0.1;
        law.pitch_rate_kd = 0.05;
        law.horizontal_velocity_ki = 0;
        law.joint_integral_limit_nm = 1;
    }
    problem.robot.controller.law = law;
    return problem;
}

/// A problem whose law observes, reads a map that is somewhat wrong, or both.
Problem equipped(Problem problem, bool observes, bool reads) {
    controllers::Aids aids;
    if (observes) {
        aids.observer.emplace();
    }
    if (reads) {
        aids.feed_forward = controllers::FeedForward{0.02, -0.01};
    }
    give_aids(problem.robot.controller.law, aids);
    return problem;
}

/// The cluttered problem with a fountain and every kind of memory that a controller may have.
Problem problem_with_memory() {
    Problem problem = cluttered_problem();
    problem.aero.ground = EffectModel::multirotor_body;
    Robot& robot = problem.robot;
    robot.rotors.time_constant_s = 0.02;
    gains_of(robot).attitude_rate_ki = 3;
    gains_of(robot).arm_ki = 15;
    gains_of(robot).rate_feed_forward = true;
    robot.arm.joint_x_m = 0.05;
    robot.arm.joint_z_m = -0.08;
    return problem;
}

}  // namespace

TEST_CASE("in free air a vehicle hovers where its reference is and carries its own weight") {
    Problem problem = ceiling_problem();
    problem.obstacles.clear();
    const auto model = make_flight_model(problem);
    for (const double arm : {0.0, 1.0, quarter_turn, -2.0}) {
        const HoverAnalysis a = analyse_hover(*model, 1, 2, arm);
        REQUIRE(a.verdict == HoldVerdict::stable);
        CHECK(a.trim.reference.position[0] == Approx(1).epsilon(1e-12));
        CHECK(a.trim.reference.position[1] == Approx(2).epsilon(1e-12));
        CHECK(a.trim.reference.position[2] == Approx(arm).margin(1e-12));
        CHECK(std::abs(a.trim.pitch_reference_rad) < 1e-12);
        // The arm's weight acts 0.72 cos(arm) ahead of the joint; front and rear rotors share it over 0.32 m.
        const double torque_nm = 0.45 * gravity * 0.72 * std::cos(arm);
        CHECK(a.trim.rotor_command_n[0] == Approx(4.95 * gravity / 4 + torque_nm / (4 * 0.32)).epsilon(1e-12));
        CHECK(a.trim.rotor_command_n[3] == Approx(4.95 * gravity / 4 - torque_nm / (4 * 0.32)).epsilon(1e-12));
        CHECK(std::abs(a.trim.joint_torque_nm) == Approx(std::abs(torque_nm)).margin(1e-12));
        CHECK(std::abs(a.stability.force_slope_n_m) < 1e-9);
        CHECK(std::abs(a.stability.torque_slope_nm_rad) < 1e-9);
        CHECK(a.stability.growing_modes == 0);
    }
}

TEST_CASE("the trim is a fixed point of the tick, whatever the controller remembers") {
    Random random(11);
    int found = 0;
    for (int kind = 0; kind < 9; ++kind) {
        Problem problem = kind >= 5
                              ? equipped(kind < 7 ? problem_with_memory() : cascaded_problem(true), true, kind % 2 == 0)
                          : kind >= 3 ? cascaded_problem(kind == 4)
                          : kind > 0  ? problem_with_memory()
                                      : cluttered_problem();
        if (kind == 2) {  // without integrators, and with limits that are soon reached
            gains_of(problem.robot).position_ki = 0;
            gains_of(problem.robot).arm_integral_limit_rad_s2 = 0.1;
            gains_of(problem.robot).attitude_integral_limit_rad_s2 = 0.1;
        }
        const auto model = make_flight_model(problem);
        for (int i = 0; i < 300; ++i) {
            const HoverAnalysis a = random_hover(*model, random);
            if (a.verdict != HoldVerdict::stable && a.verdict != HoldVerdict::unstable) {
                continue;
            }
            ++found;
            controllers::Actuation<double> given{};
            const FlightState next =
                single_tick(model->tick(), a.trim.state, a.trim.reference, given, simulation::DirectField(*model));
            CHECK(distance(next, a.trim.state) < 1e-12);
            for (int j = 0; j < 4; ++j) {
                CHECK(std::abs(next.plant.u[j]) < 1e-12);
                CHECK(given.command.thrust_n[j] == Approx(a.trim.rotor_command_n[j]).epsilon(1e-9));
                CHECK(next.plant.thrust_n[j] == Approx(a.trim.state.plant.thrust_n[j]).epsilon(1e-9));
            }
            CHECK(given.command.joint_torque_nm == Approx(a.trim.joint_torque_nm).margin(1e-9));
            CHECK(given.saturation == Approx(a.trim.saturation).epsilon(1e-9));
            for (int j = 0; j < number_count<double, controllers::LawMemory<double>>; ++j) {
                CHECK(next.memory.number[j] == Approx(a.trim.state.memory.number[j]).margin(1e-9));
            }
        }
    }
    CHECK(found > 900);
}

TEST_CASE("under a wide ceiling the slowest mode is that of the sampled height loop written by hand") {
    const auto model = make_flight_model(ceiling_alone());
    const ModelInversion gains = gains_of(test_robot());
    for (const double gap_m : {0.16, 0.20, 0.25, 0.29, 0.31, 0.33}) {
        const HoverAnalysis a = below_ceiling(*model, gap_m);
        const Ceiling k(gap_m);
        REQUIRE(k.factor < 1.25);  // the integral carries g (1 - 1/K) < 2 m/s2
        const double by_hand = spectral_radius(sampled_height(gains, k));
        CHECK(a.stability.spectral_radius == Approx(by_hand).margin(2e-6));
        CHECK((a.verdict == HoldVerdict::unstable) == (by_hand > 1));
        // Slopes over a millimetre are off by K''' h^2 / 6.
        CHECK(a.stability.growth_rate_1_s == Approx(std::log(by_hand) * 100.0).margin(2e-4));
        const double slope_n_m = 4.95 * gravity * k.slope_1_m / k.factor;
        CHECK(a.stability.force_slope_n_m == Approx(slope_n_m).epsilon(1e-3));
        CHECK(a.stability.force_gain_n_m == Approx(4.95 * 2.0 * k.factor).epsilon(1e-9));
        // Pitch: the rotors' lever of 0.32 m twice; inertia about the joint's axis with k5 ku5 = 8 * 20.
        CHECK(a.stability.torque_slope_nm_rad == Approx(0.32 * 0.32 * slope_n_m).epsilon(1e-3));
        const double inertia_kg_m2 = 0.20 + 0.06 + 4.5 * 0.45 / 4.95 * 0.72 * 0.72;
        CHECK(a.stability.torque_gain_nm_rad == Approx(inertia_kg_m2 * 160 * k.factor).epsilon(1e-9));
    }
}

TEST_CASE("hover ends below a wide ceiling where Routh and Hurwitz say, near 0.32 m") {
    const auto model = make_flight_model(ceiling_alone());
    // s^3 + K kd s^2 + (K kp - g K'/K) s + K ki is stable while K kp - g K'/K > ki / kd.
    const auto is_stable_by_hand = [](double gap_m) {
        const Ceiling k(gap_m);
        return k.factor * 2.0 - gravity * k.slope_1_m / k.factor > 0.4 / 2.6;
    };
    const auto boundary = [](const auto& is_stable) {
        double low = 0.1;
        double high = 1;
        while (high - low > 1e-6) {
            const double middle = 0.5 * (low + high);
            (is_stable(middle) ? high : low) = middle;
        }
        return high;
    };
    const double by_hand_m = boundary(is_stable_by_hand);
    const double found_m =
        boundary([&](double gap_m) { return below_ceiling(*model, gap_m).verdict == HoldVerdict::stable; });
    CHECK(by_hand_m == Approx(0.324).margin(0.01));
    CHECK(found_m == Approx(by_hand_m).margin(0.003));  // sampling costs a little
    CHECK(found_m > by_hand_m);
    // Across the boundary a pair of modes starts to swing.
    CHECK(below_ceiling(*model, found_m - 1e-3).stability.growing_modes == 2);
    CHECK(below_ceiling(*model, found_m - 1e-3).stability.frequency_rad_s > 0.1);
}

TEST_CASE("a disturbance grows at the predicted rate") {
    const auto model = make_flight_model(ceiling_alone());
    const HoverAnalysis a = below_ceiling(*model, 0.2);
    REQUIRE(a.verdict == HoldVerdict::unstable);
    REQUIRE(a.stability.frequency_rad_s == 0);
    FlightState state = a.trim.state;
    state.plant.q[1] -= 1e-7;
    for (int i = 0; i < 400; ++i) {  // until nothing but the growing mode is left
        state = flown(*model, a.trim, state);
    }
    const double before_m = distance(state, a.trim.state);
    for (int i = 0; i < 100; ++i) {
        state = flown(*model, a.trim, state);
    }
    const double rate_1_s = std::log(distance(state, a.trim.state) / before_m);
    CHECK(rate_1_s == Approx(a.stability.growth_rate_1_s).epsilon(0.01));
}

TEST_CASE("flights grow where hover is called unstable and decay where it is called stable") {
    Random random(5);
    int flights = 0;
    int unstable = 0;
    for (const Problem& problem :
         {cluttered_problem(), problem_with_memory(), cascaded_problem(false),
          equipped(cluttered_problem(), true, false), equipped(problem_with_memory(), false, true),
          equipped(problem_with_memory(), true, true), equipped(cascaded_problem(false), true, true)}) {
        const auto model = make_flight_model(problem);
        for (int tried = 0; tried < repetitions(150, 400); ++tried) {
            const HoverAnalysis a = random_hover(*model, random);
            const bool is_unstable = a.verdict == HoldVerdict::unstable;
            // Within 0.02 1/s of neither, thirty seconds do not tell.
            if ((!is_unstable && (a.verdict != HoldVerdict::stable || tried % 8 != 0)) ||
                std::abs(a.stability.growth_rate_1_s) < 0.02) {
                continue;
            }
            INFO("rate " << a.stability.growth_rate_1_s << " at " << a.trim.state.plant.q[0] << ", "
                         << a.trim.state.plant.q[1] << ", arm " << a.trim.state.plant.q[3]);
            CHECK(grows(*model, a.trim, 3000, random) == is_unstable);
            ++flights;
            unstable += is_unstable ? 1 : 0;
        }
    }
    CHECK(unstable >= 10);
    CHECK(flights - unstable >= 20);
}

TEST_CASE("where the integral is at its limit the reference has to stay below the vehicle") {
    const auto model = make_flight_model(ceiling_alone());
    const double gap_m = 0.07;  // K = 1.47: the controller has to fall at g (1 - 1/K) = 3.1 m/s2 to stand still
    const Ceiling k(gap_m);
    const double action_m_s2 = gravity * (1 - 1 / k.factor);
    REQUIRE(action_m_s2 > 2.5);
    const HoverTrim trim = below_ceiling(*model, gap_m).trim;
    const auto memory = controllers::recalled<ModelInversion>(trim.state.memory);
    const auto feeds_back = controllers::recalled<ModelInversion>(trim.feeds_back.memory);
    CHECK_FALSE(feeds_back.position_integral[1]);
    CHECK(feeds_back.position_integral[0]);
    const double offset_m = (action_m_s2 - 2.0) / 2.0;  // integral_limit_m_s2 and kp
    CHECK(trim.reference.position[1] == Approx(ceiling_m - gap_m - hub_height_m - offset_m).epsilon(1e-9));
    CHECK(memory.position_integral[1] == Approx(-2.0 / 0.4).epsilon(1e-12));
}

TEST_CASE("where a vehicle cannot hover the analysis says why") {
    const auto verdict_of = [](const Problem& problem, double x_m, double z_m, double arm_rad) {
        return analyse_hover(*make_flight_model(problem), x_m, z_m, arm_rad);
    };
    const Problem plain = ceiling_problem();
    CHECK(verdict_of(plain, 0, 4.95, 0).verdict == HoldVerdict::not_flyable);
    CHECK(verdict_of(plain, 0, 1, quarter_turn).verdict == HoldVerdict::in_collision);  // the arm in the ground
    CHECK(verdict_of(plain, 0, 2.5, quarter_turn).verdict == HoldVerdict::stable);

    Problem sucked = plain;  // idling rotors that a near ceiling makes too strong: 12.1 N a rotor over K = 1.24
    sucked.robot.rotors.min_thrust_n = 11;
    const HoverAnalysis too_strong = verdict_of(sucked, 0, ceiling_m - 0.14 - hub_height_m, quarter_turn);
    CHECK(too_strong.verdict == HoldVerdict::no_equilibrium);
    CHECK(too_strong.trim.limit == HoldLimit::rotor_thrust);
    CHECK(too_strong.trim.saturation > 1);
    CHECK(verdict_of(sucked, 0, 2.5, quarter_turn).verdict == HoldVerdict::stable);

    Problem weak = plain;  // the arm weighs 3.18 Nm
    weak.robot.arm.max_torque_nm = 3.1;
    CHECK(verdict_of(weak, 0, 2.5, 0).trim.limit == HoldLimit::joint_torque);
    CHECK(verdict_of(weak, 0, 2.5, quarter_turn).verdict == HoldVerdict::stable);

    Problem limited = plain;
    limit_arm(limited.robot, 0, 1);
    CHECK(verdict_of(limited, 0, 2.5, 1.1).trim.limit == HoldLimit::arm_angle);
    CHECK(verdict_of(limited, 0, 2.5, 0.9).verdict == HoldVerdict::stable);

    Problem soft = plain;  // half a ceiling turns the vehicle, and the attitude loop hardly answers
    soft.obstacles = {box("slab", {4, 4, 1}, {2, 0, 3.5})};
    gains_of(soft.robot).attitude_kp = 1;
    gains_of(soft.robot).attitude_rate_kp = 2;
    CHECK(verdict_of(soft, 0, 3 - 0.15 - hub_height_m, quarter_turn).trim.limit == HoldLimit::tilt);

    Problem loose = soft;  // nothing leans the vehicle against that turn
    loose.robot.controller = plain.robot.controller;
    gains_of(loose.robot).position_kp = 0;
    gains_of(loose.robot).position_ki = 0;
    const HoldLimit limit = verdict_of(loose, 0, 3 - 0.15 - hub_height_m, quarter_turn).trim.limit;
    CHECK(limit == HoldLimit::gain);
    CHECK(name_of(limit) == "gain");

    loose.obstacles.clear();  // a loop that neither grows nor decays does not hold
    const HoverAnalysis a = verdict_of(loose, 0, 2, quarter_turn);
    CHECK(a.verdict == HoldVerdict::unstable);
    CHECK(a.stability.spectral_radius == Approx(1).epsilon(1e-7));
}

TEST_CASE("gains beyond all measure end in a verdict") {
    for (const double gain : {1e8, 1e100, 1e154, 1e200, 1e300, 1e308}) {
        for (int which = 0; which < 4; ++which) {
            Problem problem = ceiling_problem();
            ModelInversion& gains = gains_of(problem.robot);
            (which == 0   ? gains.position_kp
             : which == 1 ? gains.position_kd
             : which == 2 ? gains.attitude_rate_kp
                          : gains.arm_kp) = gain;
            const HoverAnalysis a = analyse_hover(*make_flight_model(problem), 0, 2.5, 1.2);
            INFO(gain << " as gain " << which);
            CHECK(a.verdict == HoldVerdict::unstable);
            CHECK(a.stability.spectral_radius > 100);
            CHECK(a.stability.growth_rate_1_s > 100);
            CHECK(a.stability.growing_modes > 0);
        }
    }
}

TEST_CASE("mirroring scene and arm changes nothing about holding") {
    Random random(8);
    const Problem problem = cluttered_problem();
    Problem mirrored = problem;
    for (Obstacle& obstacle : mirrored.obstacles) {
        obstacle.center_world_m[0] = -obstacle.center_world_m[0];
    }
    const auto here = make_flight_model(problem);
    const auto there = make_flight_model(mirrored);
    for (int i = 0; i < 200; ++i) {
        const double x_m = random.uniform(-2, 4);
        const double z_m = random.uniform(0.2, 4.9);
        const double arm = random.uniform(-2, 2);
        const HoverAnalysis a = analyse_hover(*here, x_m, z_m, arm);
        const HoverAnalysis b = analyse_hover(*there, -x_m, z_m, 2 * quarter_turn - arm);
        REQUIRE(a.verdict == b.verdict);
        CHECK(a.stability.spectral_radius == Approx(b.stability.spectral_radius).epsilon(1e-6));
        CHECK(a.trim.pitch_reference_rad == Approx(-b.trim.pitch_reference_rad).margin(1e-6));
    }
}
