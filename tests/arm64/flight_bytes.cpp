#include <cstdint>
#include <cstdio>
#include <memory>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_batch.hpp"
#include "downwash/simulation/flight_model.hpp"

// Flies the same flights on any processor and prints what came of them to the last bit: two of these lists are equal,
// or some processor flies otherwise.

using namespace downwash;

namespace {

/// FNV-1a over bytes.
class Digest {
 public:
    void add(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) {
            digest_ = (digest_ ^ bytes[i]) * 0x100000001B3U;
        }
    }
    [[nodiscard]] unsigned long long value() const { return digest_; }

 private:
    std::uint64_t digest_ = 0xCBF29CE484222325U;
};

ReferencePoint random_rest(const Bounds& bounds, test::Random& random) {
    return at_rest({random.uniform(bounds.x_low_m, bounds.x_high_m), random.uniform(bounds.z_low_m, bounds.z_high_m),
                    random.uniform(-3, 3)});
}

void print(const char* kind, int number, Rejection rejection, std::int64_t ticks, const Digest& digest) {
    std::printf("%-10s %3d  ended by %d after %6lld ticks  %016llx\n", kind, number, static_cast<int>(rejection),
                static_cast<long long>(ticks), digest.value());
}

}  // namespace

int main() {
    constexpr int flights = 60;
    for (const double lag_s : {0.0, 0.02}) {
        Problem problem = test::cluttered_problem();
        problem.robot.rotors.time_constant_s = lag_s;
        const FlightModel model(problem.robot, problem.plane, std::make_shared<const Scene>(problem.obstacles),
                                problem.aero);
        const auto map = model.make_map(problem.bounds);
        FlightRules rules;
        rules.margin_m = 0.02;
        rules.bounds = problem.bounds;
        test::Random random(1);

        // Planned flights, side by side and one by one.
        std::vector<FlightJob> jobs;
        for (int i = 0; i < flights; ++i) {
            const ReferencePoint from = random_rest(problem.bounds, random);
            const ReferencePoint to = random_rest(problem.bounds, random);
            jobs.push_back({model.state_at(level_at(configuration_of(from))),
                            {{{from, to, random.integer(300, 1500), model.tick().tick_s}}},
                            0});
        }
        const std::vector<FlightJob> before = jobs;
        FlightPool(model, map.get(), rules, nullptr).fly(jobs);
        for (int i = 0; i < flights; ++i) {
            const auto& job = jobs[static_cast<std::size_t>(i)];
            Digest digest;
            digest.add(&job.legs[0].end, simulation::state_numbers * sizeof(double));
            print("together", i, job.rejection(), job.legs[0].flight.ticks, digest);
            FlightState state = before[static_cast<std::size_t>(i)].start;
            const SegmentFlight alone = fly(model, map.get(), rules, job.legs[0].segment, state);
            Digest again;
            again.add(&state, simulation::state_numbers * sizeof(double));
            print("alone", i, alone.rejection, alone.ticks, again);
        }

        // Reported flights, with aerodynamics evaluated directly.
        for (int i = 0; i < 4; ++i) {
            const FlightJob& job = before[static_cast<std::size_t>(i)];
            const ReferenceSegment& segment = job.legs[0].segment;
            const Execution execution =
                execute(model, job.start, {{0, segment.from()}, {segment.ticks(), segment.to()}}, problem.goal, true);
            Digest digest;
            for (const FlightRow& row : execution.rows) {
                digest.add(row.q, sizeof(row.q));
                digest.add(row.u, sizeof(row.u));
                digest.add(row.rotor_command_n, sizeof(row.rotor_command_n));
                digest.add(row.rotor_factor, sizeof(row.rotor_factor));
                digest.add(&row.clearance_m, sizeof(row.clearance_m));
                digest.add(&row.energy_j, sizeof(row.energy_j));
            }
            print("executed", i, Rejection::none, static_cast<std::int64_t>(execution.rows.size()), digest);
        }
    }
    return 0;
}
