// Counts the operations of one tick of a problem's robot, as the batched kernels do it: reference, controller, plant,
// map, rules and sums. The average over a flight of ten seconds from the start. Prints a line for each kind of tick:
// its name, then sums, products, divisions with square roots, and comparisons with choices.

#include "counted.hpp"
//
#include <fmt/core.h>

#include <cstdlib>
#include <string_view>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/controllers/quintic.hpp"
#include "downwash/controllers/reference_segment.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/closed_loop.hpp"
#include "downwash/simulation/map_effect.hpp"
#include "downwash/simulation/motion_reach.hpp"
#include "downwash/simulation/rule_checks.hpp"
#include "downwash/simulation/world.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;
using namespace downwash::simulation;
using lane::Counted;

namespace {

constexpr int counted_ticks = 1000;

/// The same numbers as another lane type.
template <template <class> class Struct>
Struct<Counted> counted(const Struct<double>& from) {
    Struct<Counted> to;
    for (int i = 0; i < number_count<Counted, Struct<Counted>>; ++i) {
        set_number_at(to, i, Counted(number_at<double>(from, i)));
    }
    return to;
}

/// Where the vehicle is to be: it moves by 2 m along x and raises its arm.
BasicReferencePoint<Counted> reference_at(Counted tick, const Configuration& start) {
    const Counted inverse_duration(0.1);
    const Counted s = lane::min(tick * Counted(0.01) * inverse_duration, Counted(1));
    const auto along = [&](double from, double by) {
        const Counted c[6] = {Counted(from),    Counted(0),        Counted(0),
                              Counted(10 * by), Counted(-15 * by), Counted(6 * by)};
        return controllers::quintic_at(c, s, inverse_duration);
    };
    const auto x = along(start[plane::x], 2);
    const auto z = along(start[plane::z], 0);
    const auto arm = along(start[plane::arm], 0.3);
    return {{x.position, z.position, arm.position},
            {x.velocity, z.velocity, arm.velocity},
            {x.acceleration, z.acceleration, arm.acceleration}};
}

/// What every tick does after the vehicle has moved.
struct Rules {
    RuleLimits limits;
    MotionReach reach;
    BasicFlightSums<Counted> sums;
    bool ends = false;

    void check(const PlantModel& plant, const VehicleState<Counted>& before, const VehicleState<Counted>& next,
               const BasicReferencePoint<Counted>& reference, Counted saturation,
               const dynamics::Attitude<Counted>& attitude, MapEffect<Counted>& field) {
        add_tick(sums, plant, before, next);
        ends = ends || broken_rule(limits, saturation, next, reference) > Counted(0) ||
               motion_m(reach, before.plant.q, next.plant.q) > Counted(1);
        for (int rotor = 0; rotor < plant.rotor_count; ++rotor) {
            if (field.same_as(rotor) == rotor) {
                const auto hub = dynamics::rotor_position(plant, attitude, next.plant.q[0], next.plant.q[1], rotor);
                ends = ends || field.doubt(rotor, hub.x, hub.z) > Counted(1);
            }
        }
    }
};

void print(std::string_view kind) {
    const lane::Operations& of = lane::operations;
    const auto each = [](std::int64_t all) { return static_cast<double>(all) / counted_ticks; };
    fmt::print("{} {:.0f} {:.0f} {:.0f} {:.0f}\n", kind, each(of.sums), each(of.products), each(of.quotients),
               each(of.others));
}

template <class Law>
void count(const Problem& problem, const FlightModel& model, const AeroMap& map, const Law& law) {
    const TickModel& tick = model.tick();
    const RotorMaps maps = rotor_maps(model, map);
    const FlightState start = model.state_at(level_at(problem.start.at));
    FlightRules rules;
    rules.bounds = problem.bounds;

    const auto fly = [&](std::string_view kind, const auto& step) {
        MapEffect<Counted> field(maps);
        Rules checks{rule_limits(rules, model.robot().arm), {0.5, 0.2, 1}, {}, false};
        State<Counted> state = counted<State>(start);
        lane::operations = {};
        for (int n = 0; n < counted_ticks; ++n) {
            controllers::Actuation<Counted> given;
            const Counted number(n);
            const auto reference = reference_at(number, problem.start.at);
            State<Counted> next;
            const dynamics::Attitude<Counted> attitude = step(state, reference, field, given, next);
            checks.check(tick.plant, state, next, reference, given.saturation, attitude, field);
            state = next;
        }
        if (checks.ends) {
            fmt::print(stderr, "tick_operations: the flight broke a rule\n");
            std::exit(1);
        }
        print(kind);
    };

    const FlownWorld& nominal = model.nominal_world();
    const bool is_one_tick_late = nominal.numbers.delay_ticks == 1;
    const auto late = lateness(Counted(nominal.numbers.delay_ticks));
    dynamics::Motion<Counted> motion, earlier_motion;
    bool is_first = true;
    fly("nominal", [&](const State<Counted>& state, const auto& reference, auto& field, auto& given, auto& next) {
        if (is_first) {
            motion = earlier_motion = dynamics::motion_at(tick.plant, state.plant.q, state.plant.u);
            is_first = false;
        }
        dynamics::PlantState<Counted> seen;
        look_back(
            late, state.plant, [&](int age) -> const PastMotion<Counted>& { return state.world.past[age - 1]; }, seen);
        const auto seen_motion = is_one_tick_late ? earlier_motion : dynamics::motion_at(tick.plant, seen.q, seen.u);
        nominal_tick(tick, law, seen, seen_motion, state, motion, reference, field, given, next);
        next.world = state.world;
        next.world.past[2] = state.world.past[1];
        next.world.past[1] = state.world.past[0];
        for (int i = 0; i < 4; ++i) {
            next.world.past[0].q[i] = state.plant.q[i];
            next.world.past[0].u[i] = state.plant.u[i];
        }
        earlier_motion = motion;
        motion = dynamics::motion_at(tick.plant, next.plant.q, next.plant.u);
        return motion.attitude;
    });

    const FlownWorld other = make_world(problem.robot, draw_world(Uncertainty{}, problem.robot, 1, 1));
    const WorldNumbers<Counted> world = counted<WorldNumbers>(other.numbers);
    const BasicPlantModel<Counted> plant = plant_in(tick, world);
    const auto world_late = lateness(world.delay_ticks);
    const Counted noise[noise_count] = {};
    const auto in_world = [&]<bool may_have_wash>(std::bool_constant<may_have_wash> /*wash*/, const auto& state,
                                                  const auto& reference, auto& field, auto& given, auto& next) {
        dynamics::PlantState<Counted> seen;
        look_back(
            world_late, state.plant, [&](int age) -> const PastMotion<Counted>& { return state.world.past[age - 1]; },
            seen);
        add_errors(world, noise, seen);
        const lane::Operations before = lane::operations;
        dynamics::Attitude<Counted> attitude = dynamics::attitude(plant, state.plant.q[2], state.plant.q[3]);
        lane::operations = before;  // the kernel has it from the tick before
        move_in_world<may_have_wash>(tick, law, world, plant, seen, wind_in(world, state.world), state, attitude,
                                     reference, field, given, next);
        pass_tick(world, state.plant, state.world, noise, next.world);
        return attitude;
    };
    const auto kind = [&]<bool may_have_wash>(std::bool_constant<may_have_wash> wash) {
        fly(may_have_wash ? "in_wash" : "in_world",
            [&](const auto& state, const auto& reference, auto& field, auto& given, auto& next) {
                return in_world(wash, state, reference, field, given, next);
            });
    };
    kind(std::false_type());
    kind(std::true_type());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: bench_tick_operations PROBLEM\n");
        return 2;
    }
    const Problem problem = read_problem(argv[1]);
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    controllers::visit_flown(model->tick().law, [&](const auto& law) { count(problem, *model, *map, law); });
}
