#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/problems/data_facts.hpp"
#include "downwash/problems/geometry_facts.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/simulation/robot_facts.hpp"
#include "downwash/simulation/space_robot_facts.hpp"

namespace downwash {

/// A mesh or an octree of a problem, and what its file became.
struct GeometryInput {
    std::string key;   ///< "environment.obstacles[2]"
    std::string name;  ///< of the obstacle; empty without one
    std::string file;  ///< as the program finds it
    bool is_mesh = false;
    GeometryFacts facts;
    // Of an octree.
    UnknownSpace unknown = UnknownSpace::free;
    std::optional<double> unseen_share;  ///< of its box; empty if its file has no free leaves and cannot tell
};

/// A robot by its name, and what it amounts to.
struct RobotInput {
    std::string name;
    RobotFacts facts;
};

/// What was read for a problem, so that a user sees whether it is what was meant.
struct InputFacts {
    std::vector<GeometryInput> geometry;  ///< every mesh and octree, in the order of the obstacles
    RobotInput robot;
    std::vector<DataFacts> data;  ///< every file of numbers
};

/// A robot in space by its name, and what it amounts to.
struct SpaceRobotInput {
    std::string name;
    SpaceRobotFacts facts;
};

/// What was read for a problem in space.
struct SpaceInputFacts {
    std::vector<GeometryInput> geometry;
    SpaceRobotInput robot;
    std::vector<DataFacts> data;
};

/// Every mesh and octree of a scene.
[[nodiscard]] DOWNWASH_EXPORT std::vector<GeometryInput> geometry_inputs(const Scene& scene);

/// @param scene of the problem   @pre problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT InputFacts input_facts(const Problem& problem, const Scene& scene);
/// @param scene of the problem   @pre space_problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT SpaceInputFacts input_facts(const SpaceProblem& problem, const Scene& scene);

/// "solid", "sheet" or, with pieces of both kinds, "mixed".
[[nodiscard]] DOWNWASH_EXPORT const char* surface_name(const SurfaceFacts& surface);

}  // namespace downwash
