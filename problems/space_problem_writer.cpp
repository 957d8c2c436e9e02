#include "downwash/problems/space_problem_writer.hpp"

#include "downwash/base/sha256.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/tree_writer.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"

namespace downwash {

std::string effective_yaml(const SpaceProblem& problem, const std::filesystem::path& folder) {
    const auto path = [&](const Parameter<SpaceProblem>& row, std::size_t index) {
        return problems::seen_from(folder, std::get<std::string>(row.get(problem, index)));
    };
    return problems::TreeWriter<SpaceProblem>(space_problem_parameters(), problem, path).written();
}

std::string problem_sha256(const SpaceProblem& problem) {
    const auto digest = [&](const Parameter<SpaceProblem>& row, std::size_t index) {
        return row.digest(problem, index);
    };
    // A default, which the problem has taken over where it has an uncertainty: no flight depends on it.
    return sha256_hex(
        problems::TreeWriter<SpaceProblem>(space_problem_parameters(), problem, digest, {"robot.uncertainty"})
            .written());
}

std::string robot_yaml(const SpaceRobot& robot) {
    const auto no_file = [](const Parameter<SpaceRobot>&, std::size_t) { return std::string(); };
    return problems::TreeWriter<SpaceRobot>(space_robot_parameters(), robot, no_file).written();
}

}  // namespace downwash
