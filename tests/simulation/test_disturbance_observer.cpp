#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "downwash/controllers/control.hpp"
#include "hover_scenes.hpp"

// Laws that observe what pushes the vehicle, on a plant that is pushed by forces of the test's own.

using namespace downwash;
using namespace downwash::test;

namespace {

using Four = std::array<double, 4>;
using Given = controllers::Actuation<double>;

constexpr double tick_s = 0.01;
constexpr double gravity = 9.80665;
constexpr double mass_kg = 4.95;

/// A vehicle in closed loop on which forces and torques act besides its own [N, N, N m, N m].
class Pushed {
 public:
    Pushed(const FlownLaw& law, double lag_s, double arm_rad) {
        Robot robot = test_robot();
        robot.rotors.time_constant_s = lag_s;
        plant_ = plant_of(robot);
        law_ = law;
        std::copy_n(std::array<double, 4>{0, 2, 0, arm_rad}.begin(), 4, state.q);
        std::fill(state.thrust_n, state.thrust_n + 4, mass_kg * gravity / 4);
        fly_aided([&](const auto& own) { memory_ = controllers::remembered(own.rested(plant_, state, tick_s)); });
    }

    /// One tick, as ten steps of Runge and Kutta's method.
    void fly(const ReferencePoint& reference, const Four& push) {
        const auto motion = dynamics::motion_at(plant_, state.q, state.u);
        fly_aided([&]<class Flown>(const Flown& own) {
            memory_ = controllers::remembered(own.control(plant_, state, motion, controllers::recalled<Flown>(memory_),
                                                          reference, tick_s, given, FreeAir{}));
        });
        for (int i = 0; i < 10; ++i) {
            step(push, tick_s / 10);
        }
    }

    /// What the law estimates now: the difference that its observer makes to the equations.
    [[nodiscard]] Four estimate() const {
        const auto motion = dynamics::motion_at(plant_, state.q, state.u);
        Four force{};
        fly_aided([&]<class Flown>(const Flown&) {
            if (const auto observer = controllers::aids_of(law_).observer) {
                const controllers::Observation<double> observation(*observer, tick_s, plant_, state, motion,
                                                                   controllers::recalled<Flown>(memory_).observed);
                std::copy_n(observation.force(), 4, force.begin());
            }
        });
        return force;
    }

    dynamics::PlantState<double> state{};
    Given given{};

 private:
    /// Also a law that observes nothing flies as one with aids.
    template <class Use>
    void fly_aided(const Use& use) const {
        std::visit(
            [&]<class Law>(const Law& own) {
                if constexpr (controllers::CanBeAided<Law>) {
                    use(controllers::Aided<Law>{own});
                }
            },
            law_);
    }

    using Rates = std::array<double, 12>;  // of q, u and thrusts

    [[nodiscard]] Rates rates(const dynamics::PlantState<double>& at, const Four& push) const {
        const auto motion = dynamics::motion_at(plant_, at.q, at.u);
        Rates rate{};
        double thrust_n = 0;
        double torque_nm = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const double now_n = plant_.has_rotor_lag ? at.thrust_n[i] : given.command.thrust_n[i];
            thrust_n += now_n;
            torque_nm -= plant_.rotor_x_m[i] * now_n;
            rate[i] = at.u[i];
            if (plant_.has_rotor_lag) {
                rate[8 + i] = (given.command.thrust_n[i] - at.thrust_n[i]) / plant_.rotor_time_constant_s;
            }
        }
        const double force[4] = {thrust_n * std::sin(at.q[2]) + push[0], thrust_n * std::cos(at.q[2]) + push[1],
                                 torque_nm + push[2], given.command.joint_torque_nm + push[3]};
        dynamics::forward_dynamics(plant_, motion.equations, force, rate.data() + 4);
        return rate;
    }

    [[nodiscard]] dynamics::PlantState<double> moved(const Rates& rate, double dt_s) const {
        dynamics::PlantState<double> to = state;
        for (std::size_t i = 0; i < 4; ++i) {
            to.q[i] += dt_s * rate[i];
            to.u[i] += dt_s * rate[4 + i];
            to.thrust_n[i] += dt_s * rate[8 + i];
        }
        return to;
    }

    void step(const Four& push, double dt_s) {
        const Rates a = rates(state, push);
        const Rates b = rates(moved(a, dt_s / 2), push);
        const Rates c = rates(moved(b, dt_s / 2), push);
        const Rates d = rates(moved(c, dt_s), push);
        Rates mean{};
        for (std::size_t i = 0; i < mean.size(); ++i) {
            mean[i] = (a[i] + 2 * b[i] + 2 * c[i] + d[i]) / 6;
        }
        state = moved(mean, dt_s);
    }

    PlantModel plant_;
    FlownLaw law_;
    controllers::LawMemory<double> memory_{};
};

/// Loops without integrators.
ModelInversion without_integrals() {
    ModelInversion law = gains_of(test_robot());
    law.position_ki = 0;
    return law;
}

ModelInversion observing(double gain_1_s) {
    ModelInversion law = without_integrals();
    law.aids.observer = controllers::DisturbanceObserver{gain_1_s};
    return law;
}

CascadedPid cascade_observing(double gain_1_s) {
    CascadedPid law;
    law.aids.observer = controllers::DisturbanceObserver{gain_1_s};
    return law;
}

}  // namespace

TEST_CASE("an estimate of a steady push up grows as 1 - exp(-L t), tick by tick") {
    for (const double gain_1_s : {2.0, 10.0, 30.0}) {
        Pushed vehicle(observing(gain_1_s), 0, quarter_turn);
        for (int tick = 1; tick <= 100; ++tick) {
            vehicle.fly(at_rest({0, 2, quarter_turn}), {0, 3, 0, 0});
            const double by_hand_n = 3 * (1 - std::exp(-gain_1_s * tick * tick_s));
            // e^0.3 is summed up to its fifth term: each tick's share is 2e-5 short.
            REQUIRE(vehicle.estimate()[1] == Approx(by_hand_n).margin(1e-4));
            REQUIRE(std::abs(vehicle.estimate()[0]) < 1e-9);
        }
    }
}

TEST_CASE("pushes and torques on every coordinate are found at once with the time constant of the gain") {
    const Four push{1.5, -3, 0.4, 0.3};
    for (const FlownLaw& law : {FlownLaw(observing(10)), FlownLaw(cascade_observing(10))}) {
        for (const double lag_s : {0.0, 0.05}) {
            Pushed vehicle(law, lag_s, 0.6);
            for (int tick = 0; tick < 10; ++tick) {
                vehicle.fly(at_rest({0, 2, 0.6}), push);
            }
            const Four after_time_constant = vehicle.estimate();
            for (int tick = 0; tick < 60; ++tick) {
                vehicle.fly(at_rest({0, 2, 0.6}), push);
            }
            for (std::size_t i = 0; i < 4; ++i) {
                INFO("coordinate " << i << ", lag " << lag_s);
                CHECK(after_time_constant[i] == Approx((1 - std::exp(-1.0)) * push[i]).margin(0.05));
                CHECK(vehicle.estimate()[i] == Approx(push[i]).margin(0.05));
            }
        }
    }
}

TEST_CASE("a steady push leaves no error once it is observed, although no loop has an integral") {
    const Four push{2, -3, 0.5, 0.3};
    for (const double lag_s : {0.0, 0.02}) {
        Pushed plain(without_integrals(), lag_s, quarter_turn);
        Pushed observed(observing(10), lag_s, quarter_turn);
        for (int tick = 0; tick < 3000; ++tick) {
            plain.fly(at_rest({0, 2, quarter_turn}), push);
            observed.fly(at_rest({0, 2, quarter_turn}), push);
        }
        CHECK(2 - plain.state.q[1] == Approx(3 / (mass_kg * 2.0)).epsilon(0.1));  // F / (m kp)
        CHECK(plain.state.q[0] > 0.1);
        CHECK(std::abs(observed.state.q[0]) < 1e-6);
        CHECK(observed.state.q[1] == Approx(2).margin(1e-6));
        CHECK(observed.state.q[3] == Approx(quarter_turn).margin(1e-6));
        // It leans against the push from the side.
        CHECK(observed.state.q[2] == Approx(std::atan2(-2, mass_kg * gravity + 3)).margin(1e-6));
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(observed.estimate()[i] == Approx(push[i]).margin(1e-6));
        }
    }
}

TEST_CASE("nothing is observed of a lively flight that nothing pushes, with rotors that lag or do not") {
    for (const FlownLaw& law : {FlownLaw(observing(10)), FlownLaw(cascade_observing(10))}) {
        for (const double lag_s : {0.0, 0.03}) {
            Pushed vehicle(law, lag_s, 0.2);
            Four most{};
            double fastest_rad_s = 0;
            for (int tick = 0; tick < 300; ++tick) {
                vehicle.fly(at_rest({0.5, 2.4, 0.9}), {});
                fastest_rad_s = std::max(fastest_rad_s, std::abs(vehicle.state.u[3]));
                const Four estimate = vehicle.estimate();
                for (std::size_t i = 0; i < 4; ++i) {
                    most[i] = std::max(most[i], std::abs(estimate[i]));
                }
            }
            CHECK(fastest_rad_s > 0.5);
            // The thrust changes by up to 20 N and the joint's torque by 4 N m within 0.1 s.
            CHECK(most[0] < 0.5);
            CHECK(most[1] < 0.5);
            CHECK(most[2] < 0.06);
            CHECK(most[3] < 0.06);
        }
    }
}

TEST_CASE("a push that rotors cannot counter winds no observer up") {
    Pushed vehicle(observing(10), 0, quarter_turn);
    for (int tick = 0; tick < 100; ++tick) {
        vehicle.fly(at_rest({0, 2, quarter_turn}), {0, -100, 0, 0});  // four rotors have 112 N, the weight takes 49 N
    }
    REQUIRE(vehicle.given.saturation > 1);
    CHECK(vehicle.estimate()[1] == Approx(-100).epsilon(0.001));
    for (int tick = 0; tick < 30; ++tick) {
        vehicle.fly(at_rest({0, 2, quarter_turn}), {});
    }
    CHECK(vehicle.estimate()[1] == Approx(-100 * std::exp(-3)).epsilon(0.01));
}

TEST_CASE("a vehicle that starts in motion observes nothing at its start") {
    for (const ControlLaw& law : {ControlLaw(observing(10)), ControlLaw(cascade_observing(10))}) {
        Problem problem = ceiling_alone();
        problem.robot.controller.law = law;
        const auto model = make_flight_model(problem);
        const FlightState state = model->state_at({0, 2, 0.1, 0.3}, {0.8, -0.3, 0.2, 1});
        controllers::visit_flown(model->tick().law, [&]<class Flown>(const Flown&) {
            if constexpr (controllers::is_aided<Flown>) {
                const auto motion = dynamics::motion_at(model->tick().plant, state.plant.q, state.plant.u);
                const controllers::Observation<double> observation(*controllers::aids_of(law).observer, tick_s,
                                                                   model->tick().plant, state.plant, motion,
                                                                   controllers::recalled<Flown>(state.memory).observed);
                for (int i = 0; i < 4; ++i) {
                    CHECK(std::abs(observation.force()[i]) < 1e-12);
                }
            }
        });
    }
}

namespace {

using Matrix4 = std::array<Four, 4>;

/// Gelfand's formula, by squaring: |M^n|^(1/n) with n = 2^40.
double spectral_radius(Matrix4 m) {
    double log_norm = 0;
    double power = 1;
    for (int squaring = 0; squaring < 40; ++squaring) {
        double norm = 0;
        for (const Four& row : m) {
            for (const double entry : row) {
                norm = std::max(norm, std::abs(entry));
            }
        }
        log_norm += std::log(norm) / power;
        Matrix4 squared{};
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                for (std::size_t k = 0; k < 4; ++k) {
                    squared[i][j] += m[i][k] / norm * (m[k][j] / norm);
                }
            }
        }
        m = squared;
        power *= 2;
    }
    return std::exp(log_norm);
}

/// Height, its rate, its integral and the observer's memory o over one tick, by hand: between ticks the ceiling pushes
/// like a negative spring, d'' = (g K'/K) d + K f / m, with the thrust f = m (-kp d - kd d' + ki i) - D held and D =
/// share m d'/h + o. The observer takes f for what acts: o becomes D - share m d'/h - share (f + D).
Matrix4 sampled_height(double gap_m, double share) {
    const double h = tick_s;
    const double r = radius_m / (gap_m + 0.3168 * radius_m);
    const double factor = 1 / (1 - r * r / 6.924);
    const double slope_1_m = 2 * factor * factor * r * r / 6.924 / (gap_m + 0.3168 * radius_m);
    const double w = std::sqrt(gravity * slope_1_m / factor);
    const double c = std::cosh(w * h);
    const double s = std::sinh(w * h);
    const Four estimate{0, share * mass_kg / h, 0, 1};
    Matrix4 m{{{c, s / w, 0, 0}, {w * s, c, 0, 0}, {-h, 0, 1, 0}, {0, -share * mass_kg / h, 0, 0}}};
    for (std::size_t j = 0; j < 4; ++j) {
        const Four loop{-2.0, -2.6, 0.4, 0};
        const double thrust_n = mass_kg * loop[j] - estimate[j];
        m[0][j] += factor * (c - 1) / (w * w) * thrust_n / mass_kg;
        m[1][j] += factor * s / w * thrust_n / mass_kg;
        m[3][j] += estimate[j] - share * (thrust_n + estimate[j]);
    }
    return m;
}

}  // namespace

TEST_CASE("an observer lets a vehicle hover nearer to a ceiling, as near as the sampled height loop by hand says") {
    const auto boundary_m = [](const auto& is_stable) {
        double low = 0.06;
        double high = 1;
        while (high - low > 1e-5) {
            const double middle = 0.5 * (low + high);
            (is_stable(middle) ? high : low) = middle;
        }
        return high;
    };
    double before_m = boundary_m([model = make_flight_model(ceiling_alone())](double gap_m) {
        return below_ceiling(*model, gap_m).verdict == HoldVerdict::stable;
    });
    CHECK(before_m == Approx(0.322).margin(0.002));
    for (const double gain_1_s : {1.0, 3.0, 10.0}) {
        Problem problem = ceiling_alone();
        gains_of(problem.robot).aids.observer = controllers::DisturbanceObserver{gain_1_s};
        const auto model = make_flight_model(problem);
        const double found_m =
            boundary_m([&](double gap_m) { return below_ceiling(*model, gap_m).verdict == HoldVerdict::stable; });
        const double share = 1 - std::exp(-gain_1_s * tick_s);
        const double by_hand_m =
            boundary_m([&](double gap_m) { return spectral_radius(sampled_height(gap_m, share)) < 1; });
        CHECK(found_m == Approx(by_hand_m).margin(5e-4));
        CHECK(found_m < before_m - 0.02);
        for (const double gap_m : {found_m + 0.02, found_m + 0.1}) {
            CHECK(below_ceiling(*model, gap_m).stability.spectral_radius ==
                  Approx(spectral_radius(sampled_height(gap_m, share))).margin(5e-6));
        }
        before_m = found_m;
    }
}
