#include "downwash/cli/vehicle_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/aeromap/grid_sampling.hpp"
#include "downwash/base/angles.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::cli {
namespace {

GridAxis axis_over(double low_m, double high_m, double step_m) {
    const double steps = std::max(1.0, std::ceil((high_m - low_m) / step_m - 1e-9));
    return {low_m, high_m, static_cast<std::size_t>(steps) + 1};
}

std::string head(const Problem& problem, const FlightModel& model) {
    const Vector3& origin_m = model.plane().origin_m();
    std::string text = fmt::format("# frame_origin_m: {} {} {}\n# frame_heading_rad: {}\n", to_text(origin_m[0]),
                                   to_text(origin_m[1]), to_text(origin_m[2]), to_text(model.plane().heading_rad()));
    text += fmt::format("# problem: {}\n# problem_sha256: {}\n", problem.name, problem_sha256(problem));
    for (const auto& [key, value] : provenance_of(model.effect(0))) {
        if (key != "quantity") {  // of a rotor
            text += fmt::format("# {}: {}\n", key, value);
        }
    }
    text += fmt::format(
        "# weight_times_rotor_radius_nm: {}\n"
        "# force_factor: thrust over weight at the commands that hover in free air\n"
        "# pitch_torque_nm: parasitic, at the same commands, positive nose down; pitch_torque_factor is that over "
        "weight_times_rotor_radius_nm\n",
        to_text(weight_times_radius_nm(model)));
    return text + "x_m,z_m,pitch_deg,force_factor,pitch_torque_nm,pitch_torque_factor,flyable\n";
}

void append_row(std::string& text, const FlightModel& model, double x_m, double z_m, double pitch_deg) {
    const PlanarPose pose{x_m, z_m, pitch_option(pitch_deg), 0};
    text += to_text(x_m) + "," + to_text(z_m) + "," + to_text(pitch_deg) + ",";
    if (is_flyable(model, pose)) {
        const VehicleEffect effect = vehicle_effect(model, pose);
        text += to_text(effect.force_factor) + "," + to_text(effect.pitch_torque_nm) + "," +
                to_text(effect.pitch_torque_factor) + ",1\n";
    } else {
        text += ",,,0\n";
    }
}

}  // namespace

double weight_times_radius_nm(const FlightModel& model) {
    return model.tick().plant.total_mass_kg * standard_gravity_m_s2 * model.robot().rotors.radius_m;
}

std::string vehicle_table(const Problem& problem, const FlightModel& model, const std::vector<double>& pitch_deg,
                          double step_m, int threads, const std::function<void(double)>& on_progress) {
    constexpr double max_rows = 1e7;
    const Bounds& bounds = problem.bounds;
    const double rows = static_cast<double>(pitch_deg.size()) * (1 + (bounds.x_high_m - bounds.x_low_m) / step_m) *
                        (1 + (bounds.z_high_m - bounds.z_low_m) / step_m);
    if (rows > max_rows) {
        throw UsageError("--step {}: about {:.3g} rows, expected at most {:.0e}; choose a larger step", step_m, rows,
                         max_rows);
    }
    const GridAxis x = axis_over(bounds.x_low_m, bounds.x_high_m, step_m);
    const GridAxis z = axis_over(bounds.z_low_m, bounds.z_high_m, step_m);
    std::vector<std::string> lines(pitch_deg.size() * z.count);
    run_parallel(
        lines.size(), threads,
        [&](std::size_t line) {
            for (std::size_t i = 0; i < x.count; ++i) {
                append_row(lines[line], model, x.at(i), z.at(line % z.count), pitch_deg[line / z.count]);
            }
        },
        on_progress);
    std::string text = head(problem, model);
    for (const std::string& line : lines) {
        text += line;
    }
    return text;
}

}  // namespace downwash::cli
