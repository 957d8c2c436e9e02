#include "downwash/report/page_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>
#include <vector>

#include "downwash/report/obstacle_frame.hpp"
#include "downwash/report/obstacle_outline.hpp"
#include "downwash/report/packed_numbers.hpp"
#include "downwash/report/robot_outline.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

Json point_json(const Vector3& point) {
    return {point[0], point[1], point[2]};
}

Json ring_json(const std::vector<PlanePoint>& ring) {
    Json points = Json::array();
    for (const PlanePoint& point : ring) {
        points.push_back({point.x_m, point.z_m});
    }
    return points;
}

Json rings_json(const std::vector<std::vector<PlanePoint>>& rings) {
    Json all = Json::array();
    for (const auto& ring : rings) {
        all.push_back(ring_json(ring));
    }
    return all;
}

Vector3 direction(const ObstacleFrame& frame, const Vector3& own) {
    const Vector3 tip = frame(own), origin = frame({0, 0, 0});
    return {tip[0] - origin[0], tip[1] - origin[1], tip[2] - origin[2]};
}

/// Triangles of a solid that has no closed form.
class Triangles {
 public:
    std::int32_t add_vertex(const Vector3& point_m) {
        for (const double coordinate : point_m) {
            vertices_.push_back(static_cast<float>(coordinate));
        }
        return static_cast<std::int32_t>(vertices_.size() / 3) - 1;
    }
    void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c) { indices_.insert(indices_.end(), {a, b, c}); }

    void add_cube(const OccupiedCube& cube, const ObstacleFrame& frame) {
        std::int32_t corner[8];
        for (std::size_t i = 0; i < 8; ++i) {
            Vector3 own_m = cube.center_m;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                own_m[axis] += ((i >> axis) & 1U) != 0 ? cube.side_m / 2 : -cube.side_m / 2;
            }
            corner[i] = add_vertex(frame(own_m));
        }
        constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        for (const auto& face : faces) {
            add_triangle(corner[face[0]], corner[face[1]], corner[face[2]]);
            add_triangle(corner[face[0]], corner[face[2]], corner[face[3]]);
        }
    }

    [[nodiscard]] Json json() const {
        PackedNumbers vertices, indices;
        vertices.add(vertices_);
        indices.add(indices_);
        return {{"triangles", {{"vertices", vertices.text()}, {"indices", indices.text()}}}};
    }

 private:
    std::vector<float> vertices_;
    std::vector<std::int32_t> indices_;
};

/// Meshes and octrees with more pieces are shown by their outlines alone, so that a page stays small.
constexpr std::size_t most_shown_triangles = 20000;

/// The kind of a shape and its solid.
class SolidOf {
 public:
    explicit SolidOf(const ObstacleFrame& frame) : frame_(frame) {}

    Json operator()(const Box& box) const {
        return {{"box",
                 {{"size_m", point_json(box.size_m)},
                  {"center_m", point_json(frame_({0, 0, 0}))},
                  {"axes",
                   {point_json(direction(frame_, {1, 0, 0})), point_json(direction(frame_, {0, 1, 0})),
                    point_json(direction(frame_, {0, 0, 1}))}}}}};
    }
    Json operator()(const Cylinder& cylinder) const {
        const double length = std::hypot(cylinder.axis[0], cylinder.axis[1], cylinder.axis[2]);
        const Vector3 unit{cylinder.axis[0] / length, cylinder.axis[1] / length, cylinder.axis[2] / length};
        return {{"cylinder",
                 {{"radius_m", cylinder.radius_m},
                  {"length_m", cylinder.length_m},
                  {"center_m", point_json(frame_({0, 0, 0}))},
                  {"axis", point_json(direction(frame_, unit))}}}};
    }
    Json operator()(const Sphere& sphere) const {
        return {{"sphere", {{"radius_m", sphere.radius_m}, {"center_m", point_json(frame_({0, 0, 0}))}}}};
    }
    Json operator()(const Mesh& mesh) const {
        if (mesh.surface->triangles.size() > most_shown_triangles) {
            return {};
        }
        Triangles triangles;
        for (const Vector3& own : mesh.surface->vertices_m) {
            triangles.add_vertex(frame_({mesh.scale * own[0], mesh.scale * own[1], mesh.scale * own[2]}));
        }
        for (const auto& corners : mesh.surface->triangles) {
            triangles.add_triangle(static_cast<std::int32_t>(corners[0]), static_cast<std::int32_t>(corners[1]),
                                   static_cast<std::int32_t>(corners[2]));
        }
        return triangles.json();
    }
    Json operator()(const Octomap& octomap) const {
        constexpr std::size_t triangles_of_cube = 12;
        if (octomap.tree->cubes.size() * triangles_of_cube > most_shown_triangles) {
            return {};
        }
        Triangles triangles;
        for (const OccupiedCube& cube : octomap.tree->cubes) {
            triangles.add_cube(cube, frame_);
        }
        return triangles.json();
    }

 private:
    const ObstacleFrame& frame_;
};

constexpr const char* kinds[] = {"box", "cylinder", "sphere", "mesh", "octree"};
static_assert(std::size(kinds) == std::variant_size_v<Shape>);

Json optional_json(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json goal_json(const Goal& goal) {
    Json json;
    if (goal.end_effector) {
        const EndEffectorGoal& at = *goal.end_effector;
        json = {{"kind", "end_effector"},
                {"x_m", at.x_m},
                {"z_m", at.z_m},
                {"direction_rad", optional_json(at.direction_rad)}};
    } else {
        const ConfigurationGoal& at = *goal.configuration;
        json = {{"kind", "state"},
                {"x_m", optional_json(at.x_m)},
                {"z_m", optional_json(at.z_m)},
                {"arm_rad", optional_json(at.arm_rad)}};
    }
    const GoalTolerance tolerance = tolerance_of(goal);
    json["tolerance_x_m"] = tolerance.x_m;
    json["tolerance_z_m"] = tolerance.z_m;
    json["is_disc"] = tolerance.is_disc;
    json["hold_s"] = goal.hold_s;
    return json;
}

}  // namespace

Json scene_json(const Problem& problem, const Scene& scene) {
    const auto cuts = obstacle_outlines(scene, problem.plane, 0);
    const auto projections = projected_outlines(scene, problem.plane);
    Json obstacles = Json::array();
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const Obstacle& obstacle = scene.obstacles()[i];
        const ObstacleFrame frame(obstacle, problem.plane, 0);
        obstacles.push_back({{"name", obstacle.name},
                             {"kind", kinds[obstacle.shape.index()]},
                             {"section", cuts[i].is_cut ? rings_json(cuts[i].rings) : Json::array()},
                             {"section_lines", rings_json(cuts[i].lines)},
                             {"projection", rings_json(projections[i].rings)},
                             {"solid", std::visit(SolidOf(frame), obstacle.shape)}});
    }
    const Bounds& bounds = problem.bounds;
    return {
        {"bounds", {{"x_m", {bounds.x_low_m, bounds.x_high_m}}, {"z_m", {bounds.z_low_m, bounds.z_high_m}}}},
        {"plane", {{"origin_m", point_json(problem.plane.origin_m())}, {"heading_rad", problem.plane.heading_rad()}}},
        {"obstacles", std::move(obstacles)}};
}

Json robot_json(const Robot& robot) {
    const PlaneOfMotion body_plane;
    const auto outlines = body_outlines(robot.body);
    Json shapes = Json::array();
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const Obstacle body = as_obstacle(robot.body[i]);
        const ObstacleFrame frame(body, body_plane, 0);
        shapes.push_back({{"outline", ring_json(outlines[i])}, {"solid", std::visit(SolidOf(frame), body.shape)}});
    }
    Json hubs = Json::array();
    for (const Vector3& hub_m : robot.rotors.positions_m) {
        hubs.push_back(point_json(hub_m));
    }
    const ArmParameters& arm = robot.arm;
    return {
        {"name", robot.name},
        {"bodies", std::move(shapes)},
        {"rotors",
         {{"radius_m", robot.rotors.radius_m},
          {"positions_m", std::move(hubs)},
          {"min_thrust_n", robot.rotors.min_thrust_n},
          {"max_thrust_n", robot.rotors.max_thrust_n}}},
        {"arm", {{"joint_m", {arm.joint_x_m, arm.joint_z_m}}, {"length_m", arm.length_m}, {"radius_m", arm.radius_m}}}};
}

Json goals_json(const Problem& problem) {
    Json goals = Json::array();
    for (const Goal& visited : goals_of(problem)) {
        for (const Goal& goal : alternatives(visited)) {
            goals.push_back(goal_json(goal));
        }
    }
    return goals;
}

std::string_view goal_order(const Problem& problem) {
    return !problem.stops.empty() ? "in_turn" : alternatives(problem.goal).size() > 1 ? "any_of" : "single";
}

Json map_json(const Problem& problem, const FlightModel& model, const AeroMap& map) {
    constexpr double most_points = 120'000;
    constexpr std::uint8_t not_flyable = 255;
    const Bounds& bounds = problem.bounds;
    const double width_m = bounds.x_high_m - bounds.x_low_m;
    const double height_m = bounds.z_high_m - bounds.z_low_m;
    const double cell_m = std::max(problem.aero.grid_m, std::sqrt(width_m * height_m / most_points));
    const auto columns = static_cast<std::size_t>(width_m / cell_m) + 1;
    const auto rows = static_cast<std::size_t>(height_m / cell_m) + 1;
    const std::size_t layer = model.rotor_layer(0);
    std::vector<double> factors(columns * rows, std::numeric_limits<double>::quiet_NaN());
    double low = 1, high = 1;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        const std::size_t row = i / columns;
        const double x_m = bounds.x_low_m + cell_m * static_cast<double>(i % columns);
        const double z_m = bounds.z_low_m + cell_m * static_cast<double>(row);
        if (map.is_flyable(layer, x_m, z_m)) {
            factors[i] = map.factor(layer, x_m, z_m);
            low = std::min(low, factors[i]);
            high = std::max(high, factors[i]);
        }
    }
    constexpr double steps = 254;
    std::vector<std::uint8_t> levels(factors.size(), not_flyable);
    for (std::size_t i = 0; i < factors.size(); ++i) {
        if (!std::isnan(factors[i])) {
            levels[i] =
                high > low ? static_cast<std::uint8_t>(std::lround(steps * (factors[i] - low) / (high - low))) : 0;
        }
    }
    PackedNumbers packed;
    packed.add(levels);
    return {{"rotor", 1},
            {"lateral_m", model.rotor_lateral_m(0)},
            {"x_low_m", bounds.x_low_m},
            {"z_low_m", bounds.z_low_m},
            {"cell_m", cell_m},
            {"columns", columns},
            {"rows", rows},
            {"factor_low", low},
            {"factor_high", high},
            {"levels", packed.text()}};
}

}  // namespace downwash
