#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/campaign_reader.hpp"
#include "downwash/problems/geometry_facts.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct CheckArguments {
    std::vector<std::string> problems;
    std::optional<std::string> schema;
    bool as_json = false;
};

/// The first words of a file's `schema:` line tell its kind; a problem unless they say otherwise.
std::string kind_of(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    for (int i = 0; i < 200 && std::getline(file, line); ++i) {
        for (const char* kind : {"robot", "campaign"}) {
            if (line.starts_with("schema:") && line.find(fmt::format("downwash/{}/", kind)) != std::string::npos) {
                return kind;
            }
        }
    }
    return "problem";
}

struct Findings {
    std::vector<LocatedError> errors, warnings;
    std::optional<PlannableProblem> problem;
};

Findings findings_in(const std::string& path) {
    Findings found;
    const auto on_warning = [&found](const LocatedError& warning) { found.warnings.push_back(warning); };
    try {
        const std::string kind = kind_of(path);
        if (kind == "robot") {
            static_cast<void>(read_robot(path, on_warning));
        } else if (kind == "campaign") {
            static_cast<void>(read_campaign(path, print_outdated, on_warning));
        } else {
            found.problem = read_plannable_problem(path, {}, print_outdated, on_warning);
        }
    } catch (const ProblemFileError& error) {
        found.errors = error.errors();
    }
    return found;
}

Json json_of(const LocatedError& found) {
    return {{"file", found.file}, {"line", found.line}, {"column", found.column}, {"message", found.message}};
}

/// A mesh or octree of a problem, with what it became.
struct PlacedGeometry {
    std::string key;
    const Obstacle& obstacle;
    GeometryFacts facts;

    [[nodiscard]] const Mesh* mesh() const { return std::get_if<Mesh>(&obstacle.shape); }
    [[nodiscard]] const Octomap* octomap() const { return std::get_if<Octomap>(&obstacle.shape); }
    [[nodiscard]] const char* surface() const {
        return facts.surface.solid_pieces == facts.surface.pieces ? "solid"
               : facts.surface.solid_pieces == 0                  ? "sheet"
                                                                  : "mixed";
    }
};

std::vector<PlacedGeometry> geometry_of(const PlannableProblem& problem) {
    std::vector<PlacedGeometry> all;
    const Scene& scene = problem.model->scene();
    for (const GeometryFacts& facts : geometry_facts(scene)) {
        all.push_back(
            {fmt::format("environment.obstacles[{}]", facts.obstacle), scene.obstacles()[facts.obstacle], facts});
    }
    return all;
}

/// What of an octree no sensor has seen; nothing of a mesh, and of an octree whose file cannot tell.
std::string unseen_text(const PlacedGeometry& geometry) {
    const Octomap* octomap = geometry.octomap();
    if (octomap == nullptr) {
        return "";
    }
    const std::string_view unknown = name_of(octomap->unknown);
    return octomap->tree->has_free_leaf
               ? fmt::format(", {:.1f} % of its box unseen ({})", 100 * octomap->tree->unseen_share, unknown)
               : fmt::format(", no free leaves (unknown: {})", unknown);
}

std::string text_of(const PlacedGeometry& geometry) {
    const GeometryFacts& facts = geometry.facts;
    const SurfaceFacts& surface = facts.surface;
    const BoundingBox& extent = facts.extent_world_m;
    const auto range = [&extent](std::size_t k) {
        return fmt::format("{} to {} m", to_text(extent.low_m[k], 6), to_text(extent.high_m[k], 6));
    };
    return fmt::format("  {}: {} of {} {}, {} piece{}, {}{}, x {}, y {}, z {} in the world\n",
                       geometry.obstacle.name.empty() ? geometry.key : excerpt(geometry.obstacle.name),
                       geometry.mesh() ? "mesh" : "octree", facts.element_count,
                       geometry.mesh() ? "triangles" : "cubes", surface.pieces, surface.pieces == 1 ? "" : "s",
                       geometry.surface(), unseen_text(geometry), range(0), range(1), range(2));
}

Json json_of(const PlacedGeometry& geometry, const std::string& path) {
    const GeometryFacts& facts = geometry.facts;
    const SurfaceFacts& surface = facts.surface;
    Json json{{"problem", path},
              {"key", geometry.key},
              {"obstacle", geometry.obstacle.name},
              {"kind", geometry.mesh() ? "mesh" : "octree"},
              {"file", geometry.mesh() ? geometry.mesh()->file : std::get<Octomap>(geometry.obstacle.shape).file},
              {geometry.mesh() ? "triangles" : "cubes", facts.element_count},
              {"low_m", facts.extent_world_m.low_m},
              {"high_m", facts.extent_world_m.high_m},
              {"surface", geometry.surface()},
              {"pieces", surface.pieces},
              {"solid_pieces", surface.solid_pieces},
              {"open_edges", surface.open_edges}};
    json["open_place"] = surface.open_edges > 0 ? Json(surface.open_place) : Json();
    if (const Octomap* octomap = geometry.octomap()) {
        json["unknown"] = name_of(octomap->unknown);
        json["unseen_share"] = octomap->tree->has_free_leaf ? Json(octomap->tree->unseen_share) : Json();
    }
    return json;
}

ExitCode run(const CheckArguments& given) {
    if (given.schema) {
        fmt::print("{}", json_schema(*file_kind_named(*given.schema)));
        return ExitCode::done;
    }
    if (given.problems.empty()) {
        throw UsageError("expected problem files, or --schema problem, robot or campaign");
    }
    auto faults = Json::array();
    auto warnings = Json::array();
    auto geometry = Json::array();
    std::set<std::string> told;  // two problems may have the same robot
    for (const std::string& path : given.problems) {
        const Findings found = findings_in(path);
        for (const LocatedError& error : found.errors) {
            if (told.insert(to_text(error)).second) {
                print_error(fmt::format("{}\n", to_text(error)));
                faults.push_back(json_of(error));
            }
        }
        for (const LocatedError& warning : found.warnings) {
            if (told.insert(to_text(warning)).second) {
                print_warning(warning);
                warnings.push_back(json_of(warning));
            }
        }
        if (found.errors.empty() && !given.as_json) {
            const std::size_t count = found.warnings.size();
            fmt::print("{}: ok{}\n", path,
                       count == 0 ? "" : fmt::format(", {} warning{}", count, count == 1 ? "" : "s"));
        }
        for (const PlacedGeometry& each : found.problem ? geometry_of(*found.problem) : std::vector<PlacedGeometry>{}) {
            if (!given.as_json) {
                fmt::print("{}", text_of(each));
            }
            geometry.push_back(json_of(each, path));
        }
    }
    const ExitCode code = faults.empty() ? ExitCode::done : ExitCode::bad_input;
    if (given.as_json) {
        print_json(
            {{"faults", std::move(faults)}, {"warnings", std::move(warnings)}, {"geometry", std::move(geometry)}});
    }
    return code;
}

}  // namespace

void add_check(Command program, Action& action) {
    auto [command, given] = add_command(
        program, action, "check",
        "Check problem, robot and campaign files and report every error and warning with its line and column, and what "
        "meshes and octrees became in the world",
        run);
    command.add_option("PROBLEM", given.problems, "problem, robot or campaign files");
    Option schema =
        command.add_option("--schema", given.schema,
                           "print the JSON Schema of a kind of file instead, for editors that complete and check YAML");
    schema.one_of({"problem", "robot", "campaign"});
    add_json(command, given.as_json, "the errors, warnings, meshes and octrees");
}

}  // namespace downwash::cli
