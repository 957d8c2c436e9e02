// Our own checker and FCL's at the same poses among the obstacles of the shipped problems. Where they differ, the plain
// reference of this folder, which shares nothing with either, says who is wrong.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string_view>
#include <thread>
#include <vector>

#include "../judge/shipped.hpp"
#include "../support/meshes.hpp"
#include "../support/random.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/scene/fcl_distances.hpp"
#include "downwash/scene/obstacle_placement.hpp"
#include "downwash/scene/space_checker.hpp"
#include "reference.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr int poses_each = 4000;
constexpr double allowed_m = 1e-3;
/// How exactly FCL knows contact.
constexpr double resolved_m = 2e-6;

PlanarPose random_pose(const Bounds& b, bool is_level, Random& random) {
    return {random.uniform(b.x_low_m, b.x_high_m), random.uniform(b.z_low_m, b.z_high_m),
            is_level ? 0 : random.uniform(-0.6, 0.6), random.uniform(-3, 3)};
}

/// Calls use(pose) for random poses all over a problem, half of them level.
template <class Use>
void each_pose(const Problem& problem, const Use& use) {
    Random random(31);
    for (int n = 0; n < poses_each; ++n) {
        const PlanarPose pose = random_pose(problem.bounds, n % 2 == 0, random);
        CAPTURE(problem.name, n, pose.x_m, pose.z_m, pose.pitch_rad, pose.arm_rad);
        use(pose);
    }
}

/// The obstacles for the reference: meshes as triangles, octrees as their cubes.
std::vector<reference::Solid> solids_of(const Problem& problem) {
    std::vector<reference::Solid> solids;
    for (const Obstacle& obstacle : problem.obstacles) {
        const Matrix3 rotation = rotation_of(obstacle.rpy_rad);
        const auto in_world = [&](const Vector3& p_m) { return obstacle.center_world_m + rotation * p_m; };
        if (const auto* mesh = std::get_if<Mesh>(&obstacle.shape)) {
            for (const auto& triangle : mesh->surface->triangles) {
                const auto corner = [&](std::size_t i) {
                    return in_world(mesh->scale * mesh->surface->vertices_m[triangle[i]]);
                };
                solids.push_back(reference::triangle({corner(0), corner(1), corner(2)}));
            }
        } else if (const auto* octomap = std::get_if<Octomap>(&obstacle.shape)) {
            for (const OccupiedCube& cube : octomap->tree->cubes) {
                const double side = cube.side_m;
                solids.push_back(reference::solid_of(
                    {"", Box{{side, side, side}}, in_world(cube.center_local_m), obstacle.rpy_rad}));
            }
        } else {
            solids.push_back(reference::solid_of(obstacle));
        }
    }
    return solids;
}

/// The least distance of the robot to obstacles that are nearer to its centre of mass than `within_m`.
reference::Enclosure true_clearance(const std::vector<reference::Solid>& solids, const Problem& problem,
                                    const PlanarPose& pose, double within_m) {
    const Vector3 center_m = problem.plane.to_world(pose.x_m, 0, pose.z_m);
    std::vector<reference::Solid> near;
    std::copy_if(solids.begin(), solids.end(), std::back_inserter(near), [&](const reference::Solid& solid) {
        return reference::distance_to_point(solid, center_m) <= within_m;
    });
    return reference::clearance(reference::robot_at(pose, problem.plane, problem.robot.shape()), near);
}

/// At how many of the poses a solver of FCL 0.7 on Debian 12 is off by more than a millimetre, and by how much at most.
/// Each is a fault of FCL, always between two boxes: the robot's body, which is flat, and a long slab. The solver stops
/// before it has come to the nearest points, and reports too much. Not one is a fault of ours.
struct KnownFaults {
    FclSolver solver;
    std::string_view problem;
    int poses;
    double worst_m;
};
constexpr KnownFaults known_faults[] = {
    {FclSolver::libccd, "bridge_inspection", 63, 0.494},
    {FclSolver::libccd, "culvert", 30, 0.341},
    {FclSolver::indep, "box_girder_bay", 1, 0.002},
    {FclSolver::indep, "open_air", 1, 0.013},
};

KnownFaults known(FclSolver solver, std::string_view problem) {
    const auto* const found =
        std::find_if(std::begin(known_faults), std::end(known_faults),
                     [&](const KnownFaults& faults) { return faults.solver == solver && faults.problem == problem; });
    return found != std::end(known_faults) ? *found : KnownFaults{solver, problem, 0, 0};
}

}  // namespace

TEST_CASE("FCL's checker and our own agree at random poses among the obstacles of the shipped problems") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        const auto scene = std::make_shared<const Scene>(problem.obstacles);
        const CollisionChecker own(scene, problem.plane, problem.robot.shape());
        const CollisionChecker fcl(scene, problem.plane, problem.robot.shape(), CollisionCheckerKind::fcl);
        int free = 0, contacts = 0;
        each_pose(problem, [&](const PlanarPose& pose) {
            const double expected_m = own.clearance_m(pose), found_m = fcl.clearance_m(pose);
            CAPTURE(expected_m, found_m);
            if (std::isinf(expected_m)) {
                CHECK(found_m == expected_m);
            } else {
                CHECK(std::abs(std::max(0.0, found_m) - std::max(0.0, expected_m)) < allowed_m);
            }
            (expected_m <= 0 ? contacts : free) += 1;
            CHECK(fcl.is_nearer_than(pose, 0) == (found_m <= 0));
            for (const double margin_m : {0.0, 0.05}) {
                CAPTURE(margin_m);
                if (expected_m <= 0 || std::abs(expected_m - margin_m) > resolved_m) {
                    CHECK(fcl.is_nearer_than(pose, margin_m) == own.is_nearer_than(pose, margin_m));
                }
            }
        });
        CHECK(free > poses_each / 4);
        CHECK((contacts > 0 || scene->obstacles().empty()));
    }
}

TEST_CASE("where one of FCL's solvers is off by more than a millimetre the reference finds our distance") {
    for (const char* name : shipped_names) {
        const Problem problem = shipped(name);
        const auto scene = std::make_shared<const Scene>(problem.obstacles);
        const CollisionChecker own(scene, problem.plane, problem.robot.shape());
        const std::vector<reference::Solid> solids = solids_of(problem);
        for (const FclSolver solver : {FclSolver::libccd, FclSolver::indep}) {
            const RobotShape shape = problem.robot.shape();
            const FclDistances fcl(scene, solids_of(shape), own.robot_reach_m(), solver);
            int faults = 0;
            double worst_m = 0;
            each_pose(problem, [&](const PlanarPose& pose) {
                const double expected_m = std::max(0.0, own.clearance_m(pose));
                const double found_m = fcl.clearance_m(
                    planar_frames(problem.plane, {shape.joint_x_m, 0, shape.joint_z_m}, pose), INFINITY);
                if (std::isinf(expected_m) ? found_m == expected_m : std::abs(found_m - expected_m) < allowed_m) {
                    return;
                }
                const reference::Enclosure truth = true_clearance(
                    solids, problem, pose, own.body_reach_m() + problem.robot.shape().arm_length_m + 1 + expected_m);
                CAPTURE(expected_m, found_m, truth.low, truth.high);
                CHECK(truth.high - truth.low < 0.1 * allowed_m);
                CHECK(truth.holds(expected_m, 1e-6));
                CHECK(found_m > expected_m);
                ++faults;
                worst_m = std::max(worst_m, std::abs(found_m - expected_m));
            });
            CAPTURE(name, faults, worst_m);
            CHECK(faults <= known(solver, name).poses);
            CHECK(worst_m <= known(solver, name).worst_m);
        }
    }
}

TEST_CASE("FCL's checker and our own agree in random scenes of turned solids, whatever the plane") {
    reference::Dice dice(60);
    int contacts = 0, free = 0;
    for (int round = 0; round < 150; ++round) {
        const auto scene = std::make_shared<const Scene>(dice.obstacles(3));
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const CollisionChecker own(scene, plane, robot);
        const CollisionChecker fcl(scene, plane, robot, CollisionCheckerKind::fcl);
        for (int i = 0; i < 60; ++i) {
            const PlanarPose pose = dice.pose();
            const double expected_m = own.clearance_m(pose), found_m = fcl.clearance_m(pose);
            CAPTURE(round, i, expected_m, found_m);
            CHECK(std::abs(std::max(0.0, found_m) - std::max(0.0, expected_m)) < allowed_m);
            const double margin_m = dice.between(0, 0.3);
            if (std::abs(expected_m - margin_m) > allowed_m) {
                CHECK(fcl.is_nearer_than(pose, margin_m) == (expected_m < margin_m));
            }
            (expected_m <= 0 ? contacts : free) += 1;
        }
    }
    CHECK(contacts > 300);
    CHECK(free > 300);
}

namespace {

/// A sheet of metal that is bent, boxes, a pipe and a scan.
std::vector<Obstacle> mixed_obstacles(reference::Dice& dice) {
    std::vector<Obstacle> obstacles = dice.obstacles(4);
    obstacles.push_back({"pipe", test::pipe_mesh(0.3, 2, 40, 20), {1, 0.5, 0}, {0.4, 1.3, 0.2}});
    obstacles.push_back({"box", test::box_mesh({0.5, 0.8, 0.3}), {-1, -1, 0.5}, {0.1, 0.2, 0.3}});
    const auto is_in_ball = [](const Vector3& p) { return dot(p, p) < 0.2; };
    obstacles.push_back({"scan",
                         test::octree_of(is_in_ball, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0.125),
                         {-1, 1, -1},
                         {0.3, 0.2, 0.1}});
    return obstacles;
}

/// A body, rotor discs around it and an arm under it, whose joints turn about y, x and y.
SpaceRobotShape multirotor(int rotors, int links) {
    SpaceRobotShape robot;
    robot.bodies = {{Box{{0.25, 0.2, 0.12}}, {}}};
    for (int i = 0; i < rotors; ++i) {
        const double angle = 2 * 3.14159265358979323846 * (i + 0.5) / rotors;
        robot.bodies.push_back(
            {Cylinder{0.09, 0.02, {0, 0, 1}}, {0.25 * std::cos(angle), 0.25 * std::sin(angle), 0.05}});
    }
    for (int i = 0; i < links; ++i) {
        SpaceLinkShape link;
        link.joint_m = {0, 0, i == 0 ? -0.08 : -0.22};
        link.axis = i == 1 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
        link.bodies = {{Capsule{0.02, {0, 0, 0}, {0, 0, -0.22}}, {}}};
        robot.links.push_back(link);
    }
    return robot;
}

}  // namespace

TEST_CASE("FCL's checker and our own agree about robots in space at any attitude") {
    reference::Dice dice(62);
    const auto scene = std::make_shared<const Scene>(mixed_obstacles(dice));
    for (const SpaceRobotShape& robot : {multirotor(4, 0), multirotor(6, 3), dice.space_robot(3)}) {
        const std::size_t links = robot.links.size();
        const SpaceChecker own(scene, robot);
        const SpaceChecker fcl(scene, robot, CollisionCheckerKind::fcl);
        CHECK(fcl.kind() == CollisionCheckerKind::fcl);
        int contacts = 0, free = 0, folded = 0;
        for (int i = 0; i < 10000; ++i) {
            SpacePose pose = dice.space_pose();
            pose.position_m = 0.6 * pose.position_m;
            const double expected_m = own.clearance_m(pose), found_m = fcl.clearance_m(pose);
            const double itself_m = own.self_clearance_m(pose, 1), its_m = fcl.self_clearance_m(pose, 1);
            CAPTURE(links, i, expected_m, found_m, itself_m, its_m);
            const bool is_certain = itself_m <= 0 || itself_m > resolved_m;
            CHECK(std::abs(std::max(0.0, its_m) - std::max(0.0, itself_m)) < allowed_m);
            if (is_certain) {
                CHECK(std::abs(std::max(0.0, found_m) - std::max(0.0, expected_m)) < allowed_m);
                CHECK(fcl.touching_bodies(pose).has_value() == own.touching_bodies(pose).has_value());
            }
            for (const double margin_m : {0.0, 0.05}) {
                if (is_certain && (expected_m <= 0 || std::abs(expected_m - margin_m) > resolved_m)) {
                    CAPTURE(margin_m);
                    CHECK(fcl.is_nearer_than(pose, margin_m) == own.is_nearer_than(pose, margin_m));
                }
            }
            (expected_m <= 0 ? contacts : free) += 1;
            folded += itself_m <= 0;
        }
        CHECK(contacts > 1000);
        CHECK(free > 1000);
        CHECK((folded > 500) == (links > 0));
    }
}

TEST_CASE("FCL's checker keeps the contract: closed meshes have an inside, and a pose that is not finite touches") {
    const RobotShape robot{{{Sphere{0.1}, {}}}, 0, 0, 0.1, 0.05};
    const auto checker = [&](Obstacle obstacle) {
        return CollisionChecker(std::make_shared<const Scene>(std::vector<Obstacle>{std::move(obstacle)}), {}, robot,
                                CollisionCheckerKind::fcl);
    };
    const CollisionChecker pipe = checker({"", test::pipe_mesh(1, 4, 24, 10), {}, {}});
    CHECK(pipe.kind() == CollisionCheckerKind::fcl);
    CHECK(pipe.is_nearer_than({0, 0, 0, 0}, 0));
    CHECK(pipe.clearance_m({0, 0, 0, 0}) <= 0);
    CHECK_FALSE(pipe.is_nearer_than({0, 5, 0, 0}, 1));

    const CollisionChecker floor = checker({"", Box{{10, 10, 2}}, {0, 0, -1}, {}});
    for (const double z : {std::nan(""), double{INFINITY}}) {
        CHECK(floor.is_nearer_than({0, z, 0, 0}, 0));
        CHECK(floor.clearance_m({0, z, 0, 0}) <= 0);
    }
    CHECK(floor.clearance_m({0, 0.6, 0, 0}) == Approx(0.5).margin(1e-6));
    CHECK(floor.is_nearer_than({0, 0.6, 0, 0}, 0.5 + 1e-5));
    CHECK_FALSE(floor.is_nearer_than({0, 0.6, 0, 0}, 0.5 - 1e-5));
    CHECK(std::isinf(
        CollisionChecker(std::make_shared<const Scene>(std::vector<Obstacle>{}), {}, robot, CollisionCheckerKind::fcl)
            .clearance_m({0, 0, 0, 0})));
}

TEST_CASE("threads that share FCL's checker get the answers that one gets") {
    reference::Dice dice(61);
    std::vector<Obstacle> obstacles = dice.obstacles(4);
    obstacles.push_back({"", test::pipe_mesh(0.3, 1, 40, 10), {1, 0, 1}, {0.1, 0.2, 0.3}});
    const auto scene = std::make_shared<const Scene>(std::move(obstacles));
    const RobotShape robot = dice.robot();
    std::vector<PlanarPose> poses(400);
    std::generate(poses.begin(), poses.end(), [&] { return dice.pose(); });
    const auto clearances = [&](const CollisionChecker& checker) {
        std::vector<double> all(poses.size());
        std::transform(poses.begin(), poses.end(), all.begin(),
                       [&](const PlanarPose& pose) { return checker.clearance_m(pose); });
        return all;
    };
    const std::vector<double> expected = clearances({scene, {}, robot, CollisionCheckerKind::fcl});
    const CollisionChecker shared(scene, {}, robot, CollisionCheckerKind::fcl);  // made by whoever comes first
    std::vector<std::vector<double>> found(4);
    std::vector<std::thread> threads;
    for (std::vector<double>& each : found) {
        threads.emplace_back([&] { each = clearances(shared); });
    }
    std::for_each(threads.begin(), threads.end(), [](std::thread& thread) { thread.join(); });
    for (const std::vector<double>& each : found) {
        CHECK(each == expected);
    }
}
