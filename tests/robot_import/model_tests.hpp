#pragma once

#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/scratch_folder.hpp"
#include "downwash/robot_import/robot_import.hpp"
#include "downwash/simulation/space_robot_facts.hpp"
#include "downwash/simulation/space_statics.hpp"
#include "hand_calculation.hpp"
#include "text_edits.hpp"

// What tests of models share.

namespace downwash::test {

/// What an import says against a model that was edited, under the name "robot"; empty if it says nothing.
inline std::string errors_of(const std::filesystem::path& model, const TextEdits& edits,
                             const ImportSettings& settings = {}) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / ("robot" + model.extension().string());
    write_text(file, edited(text_of(model), edits));
    try {
        static_cast<void>(import_robot(file, settings));
    } catch (const ProblemFileError& error) {
        return error.what();
    }
    return {};
}

/// Checks the thrusts of a hover with all joints at zero, to 1e-9 N.
/// @param hubs_m from the origin that `whole` counts from, too   @param spin_torque_m of each rotor
inline void check_hover(const SpaceRobot& robot, const std::vector<Eigen::Vector3d>& hubs_m,
                        const std::vector<double>& spin_torque_m, const HandBody& whole) {
    const Eigen::VectorXd expected_n = hover_thrusts_n(hubs_m, spin_torque_m, whole.mass_kg * 9.80665, whole.center_m);
    const std::vector<double> zero(robot.links.size(), 0);
    const std::vector<double> shares = thrust_shares(robot.plant, center_of_mass_m(robot, arm_pose(robot, zero)));
    REQUIRE(shares.size() == hubs_m.size());
    for (std::size_t k = 0; k < shares.size(); ++k) {
        CHECK(shares[k] * robot.mass_kg() * 9.80665 == Approx(expected_n[static_cast<Eigen::Index>(k)]).margin(1e-9));
    }
}

}  // namespace downwash::test
