#include "downwash/problems/problem_writer.hpp"

#include <algorithm>
#include <string_view>
#include <variant>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/text_checks.hpp"
#include "downwash/problems/tree_writer.hpp"

namespace downwash {

using problems::seen_from;

std::string effective_yaml(const Problem& problem, const std::filesystem::path& folder) {
    const auto path = [&](const Parameter<Problem>& row, std::size_t index) {
        return seen_from(folder, std::get<std::string>(row.get(problem, index)));
    };
    return problems::TreeWriter<Problem>(problem_parameters(), problem, path).written();
}

void require_readable_again(const Problem& problem, const std::filesystem::path& folder) {
    std::vector<KeyError> errors;
    for_each_value(problem_parameters(), problem,
                   [&](const Parameter<Problem>& row, const std::string& key, std::size_t index) {
                       const Value value = row.get(problem, index);
                       const auto* file = std::get_if<std::string>(&value);
                       if (row.kind != ParameterKind::file || file == nullptr) {
                           return;
                       }
                       if (!is_utf8(seen_from(folder, *file))) {
                           errors.push_back({key,
                                             "has a path that is not UTF-8, and effective.yaml has to refer to "
                                             "it: rename that file or folder"});
                       }
                   });
    const std::string text = effective_yaml(problem, folder);
    const auto refuse = [&](std::size_t found, std::size_t most, const std::string& what) {
        if (found > most) {
            errors.push_back({"environment.obstacles",
                              "has " + std::to_string(found) + what + " with every default filled in: expected " +
                                  std::to_string(most) + what + " or less; obstacles may stand in a mesh"});
        }
    };
    refuse((text.size() + 1023) / 1024, problems::largest_document / 1024, " KiB");
    refuse(problems::separators_in(text), problems::most_separators, " line breaks, commas, colons and brackets");
    throw_if_any(std::move(errors));
}

std::string problem_sha256(const Problem& problem) {
    const auto digest = [&](const Parameter<Problem>& row, std::size_t index) { return row.digest(problem, index); };
    // A default, which the problem has taken over where it has an uncertainty: no flight depends on it.
    std::vector<std::string_view> left_out{"robot.uncertainty"};
    // What files had no keys for means the same without them: plans from before are still of their problem.
    if (problem.robot.controller.law.index() == 0) {
        left_out.emplace_back("robot.controller.type");
    }
    if (!problem.aero.wall.is_any()) {
        left_out.emplace_back("aero.wall");
    }
    if (!problem.robot.arm.wash) {
        left_out.emplace_back("robot.arm.wash");
    }
    const auto is_filled = [](const Obstacle& obstacle) {
        const auto* octomap = std::get_if<Octomap>(&obstacle.shape);
        return octomap != nullptr && octomap->unknown == UnknownSpace::occupied;
    };
    if (std::none_of(problem.obstacles.begin(), problem.obstacles.end(), is_filled)) {
        left_out.emplace_back("environment.obstacles[].octomap.unknown");
    }
    return sha256_hex(problems::TreeWriter<Problem>(problem_parameters(), problem, digest, left_out).written());
}

}  // namespace downwash
