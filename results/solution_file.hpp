#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/solution.hpp"
#include "downwash/problems/input_facts.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash {

/// The `schema` of the files that this version writes and reads.
inline constexpr char solution_schema[] = "downwash/solution/v1";

/// Larger solution files are not read [bytes]: their JSON takes up to thirty times the memory. A run never writes one:
/// a step of a plan takes half a second or more.
inline constexpr std::size_t max_solution_bytes = std::size_t{16} << 20U;

/// How a solution names the problem that it solves.
struct ProblemReference {
    std::string name;
    std::string file;                          ///< as the user gave it
    std::string sha256;                        ///< checksum of the effective problem and every file that it refers to
    std::vector<LocatedError> warnings = {};   ///< what was found when it was read, with its places
    std::span<const Axis> axes = planar_axes;  ///< what the numbers of configurations are; static
    std::optional<InputFacts> inputs = {};     ///< what its robot and its files became
};

/// SHA-256 digests of files of a run by their names: they belong to this solution and to no other.
using FileDigests = std::map<std::string, std::string>;

/// The text of solution.json: everything but the rows of the flight. Numbers read back as the very same; what is not
/// finite becomes null.
[[nodiscard]] DOWNWASH_EXPORT std::string solution_json(const Solution& solution, const ProblemReference& problem,
                                                        const FileDigests& files = {});

/// Reads a solution back, its plan above all, to fly it for `problem`. The execution stays empty; what a plan written
/// by hand leaves out (all but `schema` and `plan`) is taken from the problem's settings. Its warnings are not read:
/// they are about the problem.
/// @throws ProblemFileError with every error: no solution file, no plan in it, a reference off the grid of control
/// ticks or starting elsewhere than the problem does, waypoints that disagree with the reference
[[nodiscard]] DOWNWASH_EXPORT Solution read_solution(const std::string& path, const Problem& problem);

}  // namespace downwash
