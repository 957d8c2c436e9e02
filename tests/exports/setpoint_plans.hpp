#pragma once

#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>

#include "../support/test_problem.hpp"
#include "downwash/exports/export_format.hpp"
#include "downwash/exports/setpoints.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/run_record.hpp"

// Runs with plans of every kind: they pass knots in motion, stop on their way and go on, and turn through half a turn.

namespace downwash::test {

/// Numbers that are the same everywhere.
class Numbers {
 public:
    explicit Numbers(unsigned seed) : generator_(seed) {}

    [[nodiscard]] double between(double low, double high) {
        constexpr double count = 4294967296.;
        return low + (high - low) * static_cast<double>(generator_()) / count;
    }

 private:
    std::mt19937 generator_;
};

/// Moves a point on by a second or two.
template <class Point>
void move(Point& point, int axes, Numbers& numbers) {
    for (int axis = 0; axis < axes; ++axis) {
        point.position[axis] += numbers.between(-0.5, 0.5);
        point.velocity[axis] = numbers.between(-0.3, 0.3);
        point.acceleration[axis] = numbers.between(-0.3, 0.3);
    }
}

/// A reference of knots in motion with a stop of half a second after each third.
/// @param rest makes a point at rest of one in motion
template <class Knot, class Rest>
std::vector<Knot> reference_with_stops(int axes, Numbers& numbers, const Rest& rest) {
    std::vector<Knot> reference(1);
    for (int i = 1; i <= 6; ++i) {
        Knot next = reference.back();
        next.tick += static_cast<std::int64_t>(numbers.between(100, 160));
        move(next.point, axes, numbers);
        const bool stops = i % 3 == 0;
        next.point = stops ? rest(next.point) : next.point;
        reference.push_back(next);
        if (stops && i < 6) {
            next.tick += 50;
            reference.push_back(next);
        }
    }
    return reference;
}

/// A run in a turned plane far from the world's origin.
inline RunRecord planar_run(unsigned seed) {
    Numbers numbers(seed);
    RunRecord run;
    run.problem = ceiling_problem();
    run.problem.plane = PlaneOfMotion({10, -20, 3}, 0.7);
    run.plan = Plan{reference_with_stops<ReferenceKnot>(
                        3, numbers, [](const ReferencePoint& point) { return at_rest(configuration_of(point)); }),
                    0.01};
    return run;
}

/// A run in space with a robot of so many joints, up to three. Its yaw goes through half a turn, and on.
inline SpaceRunRecord space_run(unsigned seed, int joints) {
    static const SpaceProblem girder = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    Numbers numbers(seed);
    SpaceRunRecord run;
    run.problem = girder;
    run.problem.robot.links.resize(static_cast<std::size_t>(joints));
    run.problem.robot.plant.links.resize(static_cast<std::size_t>(joints));
    run.plan = SpacePlan{reference_with_stops<SpaceKnot>(4 + joints, numbers, rest_at), 0.01, joints};
    for (std::size_t i = 0; i < run.plan->reference.size(); ++i) {
        double* position = run.plan->reference[i].point.position;
        position[space::x] += 2;
        position[space::y] -= 1;
        position[space::z] += 3;
        position[space::yaw] += 3 + 0.4 * static_cast<double>(i);
    }
    return run;
}

/// A run in one of the formats.
template <class Run>
std::string written(const Run& run, const std::string& format, double rate_hz, double bearing_deg = 0) {
    ExportSettings settings;
    settings.rate_hz = rate_hz;
    settings.bearing_deg = bearing_deg;
    settings.is_east_north_up = bearing_deg != 0;
    for (const ExportFormat& one : export_formats) {
        if (one.name == format) {
            return exported(run, one, settings);
        }
    }
    throw std::logic_error("there is no such format");
}

}  // namespace downwash::test
