#include "downwash/scene/space_checker.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "../support/error_of.hpp"
#include "../support/meshes.hpp"
#include "reference.hpp"

using namespace downwash;
using reference::about;

namespace {

constexpr double pi = 3.14159265358979323846;
const double infinity = std::numeric_limits<double>::infinity();

SpaceChecker checker_of(std::vector<Obstacle> obstacles, const SpaceRobotShape& robot,
                        CollisionCheckerKind kind = CollisionCheckerKind::own) {
    return {std::make_shared<const Scene>(std::move(obstacles)), robot, kind};
}

std::array<double, 4> turned_about(const Vector3& axis, double angle_rad) {
    const double s = std::sin(angle_rad / 2) / std::sqrt(dot(axis, axis));
    return {std::cos(angle_rad / 2), s * axis[0], s * axis[1], s * axis[2]};
}

SpacePose at(const Vector3& position_m, const std::array<double, 4>& attitude = {1, 0, 0, 0},
             const std::array<double, max_links>& joints_rad = {}) {
    return {position_m, attitude, joints_rad};
}

/// A pose on the way from one to another, by library functions and without halving.
SpacePose on_the_way(const SpacePose& a, const SpacePose& b, double share) {
    SpacePose pose;
    pose.position_m = a.position_m + share * (b.position_m - a.position_m);
    for (std::size_t i = 0; i < max_links; ++i) {
        pose.joints_rad[i] = a.joints_rad[i] + share * (b.joints_rad[i] - a.joints_rad[i]);
    }
    double together = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        together += a.attitude[i] * b.attitude[i];
    }
    const double angle = std::acos(std::min(1.0, std::abs(together)));
    for (std::size_t i = 0; i < 4; ++i) {
        const double end = together < 0 ? -b.attitude[i] : b.attitude[i];
        pose.attitude[i] =
            angle < 1e-9
                ? a.attitude[i]
                : (std::sin((1 - share) * angle) * a.attitude[i] + std::sin(share * angle) * end) / std::sin(angle);
    }
    return pose;
}

/// A pose some decimetres and half radians from another.
SpacePose near_to(const SpacePose& pose, double size, reference::Dice& dice) {
    SpacePose next = pose;
    next.position_m = next.position_m + dice.vector(-0.3 * size, 0.3 * size);
    double squared = 0;
    for (double& number : next.attitude) {
        number += dice.between(-0.5 * size, 0.5 * size);
        squared += number * number;
    }
    for (double& number : next.attitude) {
        number /= std::sqrt(squared);
    }
    for (double& angle : next.joints_rad) {
        angle += dice.between(-size, size);
    }
    return next;
}

SpaceRobotShape in_space(const RobotShape& robot) {
    SpaceRobotShape shape;
    for (const BodyShape& body : robot.bodies) {
        shape.bodies.push_back(
            {std::visit([](const auto& solid) { return SpaceShape(solid); }, body.shape), body.center_body_m});
    }
    SpaceLinkShape arm;
    arm.joint_m = {robot.joint_x_m, 0, robot.joint_z_m};
    arm.axis = {0, 1, 0};
    arm.bodies = {{Capsule{robot.arm_radius_m, {0, 0, 0}, {robot.arm_length_m, 0, 0}}, {}}};
    shape.links = {arm};
    return shape;
}

/// A ball of 0.1 m with two links of 0.5 m that hang on a joint 0.2 m under it and turn about y. At zero both point
/// along x.
SpaceRobotShape folding_arm() {
    SpaceRobotShape robot;
    robot.bodies = {{Sphere{0.1}, {}}};
    const Capsule bone{0.02, {0, 0, 0}, {0.5, 0, 0}};
    robot.links = {{{0, 0, -0.2}, {0, 1, 0}, -infinity, infinity, {{bone, {}}}},
                   {{0.5, 0, 0}, {0, 3, 0}, -infinity, infinity, {{bone, {}}}}};
    return robot;
}

}  // namespace

TEST_CASE("A robot in space without obstacles has infinite clearance, one with unusable numbers leads to every error") {
    const SpaceChecker checker = checker_of({}, {{{Sphere{0.1}, {}}}, {}});
    CHECK(checker.clearance_m({}) == infinity);
    CHECK(checker.clearance_m({}, 3) == 3);
    CHECK(checker.free_motion({}, 0.1, 3).to_obstacles_m == 3);
    CHECK(checker.free_motion({}, 0.1, 3).to_itself_m == 3);
    CHECK_FALSE(checker.is_nearer_than({}, 1e9));
    CHECK_FALSE(checker.nearest_obstacle({}, infinity));
    CHECK_FALSE(checker.comes_nearer_between({}, at({1e3, 0, 0}), 1));

    const Capsule thin{0, {0, 0, std::nan("")}, {}};
    SpaceRobotShape robot{{{Box{{1, 1, -1}}, {}}, {thin, {0, infinity, 0}}}, std::vector<SpaceLinkShape>(7)};
    robot.links[0].axis = {0, 0, 0};
    robot.links[1].joint_m = {infinity, 0, 0};
    robot.links[1].bodies = {{Sphere{std::nan("")}, {}}};
    robot.links[2].lower_limit_rad = 1;
    robot.links[2].upper_limit_rad = 0.5;
    CHECK(test::wrong_keys([&] { return checker_of({}, robot); }) ==
          std::vector<std::string>{"bodies[0].box.size_m", "bodies[1].capsule.radius_m", "bodies[1].capsule",
                                   "bodies[1].center_m", "links", "links[0].axis", "links[1].joint_m",
                                   "links[1].bodies[0].sphere.radius_m", "links[2].lower_limit_rad"});
}

TEST_CASE("Clearances of a robot in space computed by hand are found at any attitude") {
    const Obstacle floor{"", Box{{9, 9, 1}}, {0, 0, -0.5}, {}};
    const SpaceRobotShape plate{{{Box{{0.4, 0.3, 0.1}}, {}}}, {}};
    const SpaceChecker checker = checker_of({floor}, plate);
    const double q = 0.3;
    CHECK(checker.clearance_m(at({0, 0, 1})) == about(0.95));
    CHECK(checker.clearance_m(at({0, 0, 1}, turned_about({1, 0, 0}, q))) ==
          about(1 - 0.15 * std::sin(q) - 0.05 * std::cos(q)));
    CHECK(checker.clearance_m(at({0, 0, 1}, turned_about({0, 1, 0}, q))) ==
          about(1 - 0.2 * std::sin(q) - 0.05 * std::cos(q)));
    CHECK(checker.clearance_m(at({0, 0, 1}, turned_about({0, 0, 1}, q))) == about(0.95));
    CHECK(checker.clearance_m(at({0, 0, 1}, turned_about({0, 1, 0}, pi / 2))) == about(0.8));
    CHECK(checker.clearance_m(at({0, 0, 1}, {0, 2, 0, 0})) == about(0.95));  // upside down, of length 2
    CHECK(checker.nearest_obstacle(at({0, 0, 1}), 1) == std::size_t{0});
    CHECK_FALSE(checker.nearest_obstacle(at({0, 0, 1}), 0.9));

    // A link forward and one that turns about it: an elbow of 0.2 m to the left goes up and down with the second joint.
    SpaceRobotShape robot = plate;
    robot.links = {{{0.1, 0, -0.1}, {0, 1, 0}, -infinity, infinity, {}},
                   {{0.3, 0, 0}, {2, 0, 0}, -infinity, infinity, {{Capsule{0.01, {0, 0, 0}, {0, 0.2, 0}}, {}}}}};
    const SpaceChecker arm = checker_of({floor}, robot);
    for (const double p : {-0.4, 0.0, 0.9}) {
        for (const double r : {-1.2, -0.3}) {
            const double joint_z = 1 - 0.1 - 0.3 * std::sin(p);
            const double tip_z = joint_z + 0.2 * std::sin(r) * std::cos(p);
            CAPTURE(p, r);
            CHECK(arm.clearance_m(at({0, 0, 1}, {1, 0, 0, 0}, {p, r})) ==
                  about(std::min({0.95, joint_z - 0.01, tip_z - 0.01})));
        }
    }
}

TEST_CASE("A planar robot in space is as near to obstacles as the planar checker says") {
    reference::Dice dice(70);
    int contacts = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<Obstacle> obstacles = dice.obstacles(3);
        if (round % 4 == 0) {
            obstacles.push_back({"", test::pipe_mesh(0.3, 1, 20, 5), dice.vector(-1, 1), dice.vector(-3, 3)});
        }
        const auto scene = std::make_shared<const Scene>(std::move(obstacles));
        const RobotShape robot = dice.robot();
        const PlaneOfMotion plane = dice.plane();
        const CollisionChecker planar(scene, plane, robot);
        const SpaceChecker checker(scene, in_space(robot));
        for (int i = 0; i < 20; ++i) {
            const PlanarPose pose = dice.pose();
            const std::array<double, 4> yaw = turned_about({0, 0, 1}, plane.heading_rad());
            const double c = std::cos(pose.pitch_rad / 2), s = std::sin(pose.pitch_rad / 2);
            const SpacePose same = at(plane.to_world(pose.x_m, 0, pose.z_m),
                                      {yaw[0] * c, -yaw[3] * s, yaw[0] * s, yaw[3] * c}, {pose.arm_rad});
            const double expected_m = planar.clearance_m(pose);
            CAPTURE(round, i, expected_m);
            CHECK(std::max(0.0, checker.clearance_m(same)) == about(std::max(0.0, expected_m)));
            CHECK((checker.clearance_m(same) <= 0) == (expected_m <= 0));
            CHECK(checker.is_nearer_than(same, 0) == (expected_m <= 0));
            CHECK(checker.is_nearer_than(same, 0.3) == planar.is_nearer_than(pose, 0.3));
            CHECK(checker.nearest_obstacle(same, 0.5) == planar.nearest_obstacle(pose, 0.5));
            contacts += expected_m <= 0;
        }
    }
    CHECK(contacts > 200);
}

TEST_CASE("The clearance of a robot in space agrees with alternating projections") {
    reference::Dice dice(71);
    int undecided = 0, contacts = 0;
    for (int round = 0; round < 300; ++round) {
        const std::vector<Obstacle> obstacles = dice.obstacles(2);
        const SpaceRobotShape robot = dice.space_robot(round % 4);
        SpacePose pose = dice.space_pose();
        pose.position_m = 0.5 * pose.position_m;
        const SpaceChecker checker = checker_of(obstacles, robot);
        const reference::Enclosure truth = reference::clearance(reference::robot_at(pose, robot), obstacles);
        undecided += truth.high - truth.low > 1e-6;
        CAPTURE(round, truth.low, truth.high, checker.clearance_m(pose));
        if (checker.self_clearance_m(pose) > 0) {
            REQUIRE(truth.holds(checker.clearance_m(pose)));
        }
        contacts += checker.clearance_m(pose) <= 0;
    }
    CHECK(undecided < 15);
    CHECK(contacts > 30);
}

TEST_CASE("The distance between bodies of a robot agrees with alternating projections") {
    reference::Dice dice(72);
    int touching = 0, apart = 0;
    for (int round = 0; round < 400; ++round) {
        const SpaceRobotShape robot = dice.space_robot(2 + round % 3);
        const SpacePose pose = dice.space_pose();
        const SpaceChecker checker = checker_of({}, robot);
        const auto truth_at = [&robot](const SpacePose& somewhere) {
            const auto bodies = reference::bodies_at(somewhere, robot);
            reference::Enclosure least{infinity, infinity};
            for (std::size_t i = 0; i < bodies.size(); ++i) {
                for (std::size_t j = i + 2; j < bodies.size(); ++j) {
                    const reference::Enclosure pair = reference::clearance(bodies[i], bodies[j]);
                    least = {std::min(least.low, pair.low), std::min(least.high, pair.high)};
                }
            }
            return least;
        };
        const reference::Enclosure truth = truth_at(pose);
        const double found_m = checker.self_clearance_m(pose);
        CAPTURE(round, truth.low, truth.high, found_m);
        // Solids that always touch are not compared.
        CHECK(std::max(0.0, found_m) >= truth.low - 1e-9);
        if (truth.high <= 1e-12 && found_m > 0) {
            for (int i = 0; i < 20; ++i) {
                CHECK(truth_at(dice.space_pose()).high <= 1e-9);
            }
            continue;
        }
        if (truth.high <= 1e-12) {
            CHECK(checker.touching_bodies(pose));
            CHECK(checker.is_nearer_than(pose, 0));
            CHECK(checker.clearance_m(pose) <= 0);
            ++touching;
        } else if (truth.low > 1e-6) {
            CHECK_FALSE(checker.touching_bodies(pose));
            CHECK_FALSE(checker.is_nearer_than(pose, 0));
            ++apart;
        }
    }
    CHECK(touching > 50);
    CHECK(apart > 100);
}

TEST_CASE("A two-link arm that folds touches the multirotor and never its neighbour") {
    for (const CollisionCheckerKind kind : {CollisionCheckerKind::own, CollisionCheckerKind::fcl}) {
        const SpaceChecker checker = checker_of({}, folding_arm(), kind);
        // Opened by an angle a from folded flat, with the first link along x: the end of the second link, as seen from
        // the ball, and how near its round end is.
        const auto gap_m = [](double a) {
            return std::hypot(0.5 - 0.5 * std::cos(a), -0.2 + 0.5 * std::sin(a)) - 0.12;
        };
        const auto folded_by = [](double a) { return at({1, 2, 3}, turned_about({1, 2, 3}, 1), {0, pi + a}); };
        for (const double a : {0.0, 0.1}) {
            CHECK(checker.self_clearance_m(folded_by(a)) ==
                  Approx(gap_m(a)).margin(kind == CollisionCheckerKind::own ? 1e-9 : 1e-3));
        }
        CHECK_FALSE(checker.touching_bodies(folded_by(0)));
        CHECK_FALSE(checker.is_nearer_than(folded_by(0), 0.05));  // margins are for obstacles
        double low = 0, high = 0.3;                               // where the end of the second link touches the ball
        for (int i = 0; i < 60; ++i) {
            const double a = (low + high) / 2;
            (gap_m(a) > 0 ? low : high) = a;
        }
        CHECK_FALSE(checker.touching_bodies(folded_by(low - 1e-4)));
        CHECK(checker.touching_bodies(folded_by(low + 1e-4)) == SpaceChecker::Bodies{0, 2});
        CHECK(checker.clearance_m(folded_by(low + 1e-4)) <= 0);
        CHECK(checker.is_nearer_than(folded_by(low + 1e-4), 0));
        // It folds through the ball and comes out on the other side: both ends are free.
        CHECK_FALSE(checker.touching_bodies(folded_by(1.2)));
        CHECK(checker.comes_nearer_between(folded_by(0), folded_by(1.2), 0));
        CHECK_FALSE(checker.comes_nearer_between(folded_by(0), folded_by(low - 2e-3), 0));
        CHECK(checker.free_motion(folded_by(0), 0, 1).to_itself_m == Approx(checker.self_clearance_m(folded_by(0))));
        CHECK(checker.free_motion(folded_by(0), 0, 1).to_obstacles_m == 1);
    }
}

TEST_CASE("Solids that cannot touch within the limits of the joints are compared beyond them") {
    SpaceRobotShape robot = folding_arm();
    robot.links[1].lower_limit_rad = -2;
    robot.links[1].upper_limit_rad = 2;  // the end of the second link stays 0.3 m away from the ball
    const SpaceChecker checker = checker_of({}, robot);
    CHECK(checker.self_clearance_m(at({}, {1, 0, 0, 0}, {0, 2})) == infinity);
    CHECK_FALSE(checker.comes_nearer_between(at({}, {1, 0, 0, 0}, {0, -2}), at({}, {1, 0, 0, 0}, {0, 2}), 0));
    CHECK(checker.touching_bodies(at({}, {1, 0, 0, 0}, {0, pi + 0.25})) == SpaceChecker::Bodies{0, 2});
    CHECK(checker.comes_nearer_between(at({}, {1, 0, 0, 0}, {0, 2}), at({}, {1, 0, 0, 0}, {0, 4.5}), 0));
}

TEST_CASE("Links without a solid join neighbours, and what overlaps by design is not compared") {
    SpaceRobotShape robot = folding_arm();
    robot.links[0].bodies.clear();
    CHECK_FALSE(checker_of({}, robot).touching_bodies(at({}, {1, 0, 0, 0}, {0, pi + 0.25})));

    robot = folding_arm();
    robot.links[1].bodies.push_back({Sphere{0.8}, {}});  // around the elbow: it holds the multirotor at any angle
    CHECK_FALSE(checker_of({}, robot).touching_bodies(at({}, {1, 0, 0, 0}, {0.2, 1})));
    CHECK(checker_of({}, robot).touching_bodies(at({}, {1, 0, 0, 0}, {0, pi + 0.25})) == SpaceChecker::Bodies{0, 2});
}

TEST_CASE("No point of a robot moves farther between two poses than the bound says") {
    reference::Dice dice(73);
    double most_of_bound = 0;
    for (int round = 0; round < 300; ++round) {
        const SpaceRobotShape robot = dice.space_robot(round % 5);
        const SpaceChecker checker = checker_of({}, robot);
        const SpacePose from = dice.space_pose(), to = near_to(from, dice.between(0.1, 3), dice);
        const SpaceChange<double> change = change_between(from, to);
        // Points on the surface of each solid: what is farthest along random directions, in the frame of its body.
        const auto own = reference::bodies_at({}, robot);
        const auto own_frames = reference::frames_at({}, robot);
        const auto start = reference::frames_at(from, robot);
        for (std::size_t body = 0; body < own.size(); ++body) {
            const double bound_m = motion_m(checker.reach(), body, change);
            CHECK(bound_m <= motion_m(checker.reach(), change));
            for (const reference::Solid& solid : own[body]) {
                for (int i = 0; i < 20; ++i) {
                    const Vector3 far = reference::project(solid, solid.center_m + 100.0 * dice.vector(-1, 1));
                    const Vector3 p_m = far - own_frames[body].origin_m;  // axes are parallel at zero
                    for (const double share : {0.25, 0.5, 1.0}) {
                        const auto frames = reference::frames_at(on_the_way(from, to, share), robot);
                        const Vector3 way_m = frames[body].placed(p_m) - start[body].placed(p_m);
                        const double moved_m = std::sqrt(dot(way_m, way_m));
                        CAPTURE(round, body, share, moved_m, bound_m);
                        REQUIRE(moved_m <= share * bound_m + 1e-9);
                        most_of_bound = std::max(most_of_bound, moved_m / (share * bound_m));
                    }
                }
            }
        }
        // The half of the way that halving sees.
        const SpacePose middle = halfway(from, to);
        CHECK(motion_m(checker.reach(), change_between(from, middle)) ==
              about(0.5 * motion_m(checker.reach(), change)));
        CHECK(change_between(middle, to).turn_rad == about(0.5 * change.turn_rad));
    }
    CHECK(most_of_bound > 0.8);

    // Attained to first order: a tip that turns about one axis.
    const SpaceChecker arm = checker_of({}, folding_arm());
    CHECK(arm.reach().bodies[2].center_m == about(0.2 + 0.5 + 0.52));
    CHECK(arm.reach().bodies[2].joint_m[0] == about(0.5 + 0.52));
    CHECK(arm.reach().bodies[2].joint_m[1] == about(0.52));
    CHECK(arm.robot_reach_m() == about(1.22));
    CHECK(turn_between_rad(turned_about({1, 2, 3}, 0.3).data(), turned_about({1, 2, 3}, 1e-7 + 0.3).data()) ==
          Approx(1e-7).epsilon(1e-6));
    CHECK(turn_between_rad(turned_about({1, 2, 3}, 0).data(), turned_about({1, 2, 3}, 4).data()) == about(2 * pi - 4));
}

TEST_CASE("A link that turns about its own axis moves by its radius alone") {
    SpaceRobotShape robot;
    robot.links = {{{0, 0, -0.1}, {0, 0, 1}, -infinity, infinity, {{Capsule{0.02, {0, 0, 0}, {0, 0, -1}}, {}}}}};
    const SpaceChecker checker = checker_of({}, robot);
    CHECK(checker.reach().bodies[1].joint_m[0] == about(0.02));
    CHECK(checker.reach().bodies[1].center_m == about(1.12));
}

TEST_CASE("Between two poses a fast turn through a thin plate is found") {
    // A rod of one metre on each side, which turns by 170 degrees past a plate of a millimetre that both poses miss.
    const SpaceRobotShape rod{{{Capsule{0.01, {-1, 0, 0}, {1, 0, 0}}, {}}}, {}};
    const Obstacle plate{"", Box{{0.4, 0.001, 0.4}}, {0, 0.9, 0}, {}};
    SpaceRobotShape arm;
    arm.bodies = {{Sphere{0.05}, {}}};
    arm.links = {{{0, 0, 0}, {0, 0, 1}, -infinity, infinity, {{Capsule{0.01, {0.1, 0, 0}, {1, 0, 0}}, {}}}}};
    for (const CollisionCheckerKind kind : {CollisionCheckerKind::own, CollisionCheckerKind::fcl}) {
        const SpaceChecker checker = checker_of({plate}, rod, kind);
        const auto turned = [](double degrees) { return at({}, turned_about({0, 0, 1}, degrees * pi / 180)); };
        CHECK_FALSE(checker.is_nearer_than(turned(5), 0.05));
        CHECK_FALSE(checker.is_nearer_than(turned(175), 0.05));
        CHECK(checker.comes_nearer_between(turned(5), turned(175), 0));
        CHECK(checker.comes_nearer_between(turned(5), turned(175), 0.05));
        CHECK(checker.comes_nearer_between(turned(175), turned(365), 0.05));
        // From 110 to -110 degrees the shorter way is past 180, not past 90.
        CHECK_FALSE(checker.comes_nearer_between(turned(110), turned(-110), 0.05));
        // Above the plate by a millimetre, and by less than its margin.
        const auto lifted = [&](double degrees, double z) {
            SpacePose pose = turned(degrees);
            pose.position_m[2] = z;
            return pose;
        };
        CHECK_FALSE(checker.comes_nearer_between(lifted(5, 0.212), lifted(175, 0.212), 0));
        CHECK(checker.comes_nearer_between(lifted(5, 0.212), lifted(175, 0.212), 0.01));
        CHECK_FALSE(checker.comes_nearer_between(lifted(5, 0.212), lifted(45, 0.212), 0.01));

        // The same by a joint while the vehicle stands, and with a shift that takes the rod past in time.
        const SpaceChecker swinging = checker_of({plate}, arm, kind);
        const auto swung = [](double degrees) { return at({}, {1, 0, 0, 0}, {degrees * pi / 180}); };
        CHECK(swinging.comes_nearer_between(swung(5), swung(175), 0));
        CHECK_FALSE(swinging.comes_nearer_between(swung(5), swung(-175), 0.05));
        CHECK(swinging.comes_nearer_between(swung(5), swung(360), 0));
        const auto far_away = at({0, -100, 0}, {1, 0, 0, 0}, {pi});
        CHECK_FALSE(swinging.comes_nearer_between(at({0, -0.3, 0}), far_away, 0.05));
    }
}

TEST_CASE("Between two poses nothing is missed, and nothing found that is not there") {
    reference::Dice dice(74);
    int found = 0, free = 0;
    for (int round = 0; round < 300; ++round) {
        const auto scene = std::make_shared<const Scene>(dice.obstacles(3));
        const SpaceRobotShape robot = dice.space_robot(round % 4);
        const SpaceChecker checker(scene, robot);
        const SpacePose from = dice.space_pose(), to = near_to(from, dice.between(0.05, 2), dice);
        const double margin_m = dice.coin() ? 0 : dice.between(0, 0.1);
        const bool comes_nearer = checker.comes_nearer_between(from, to, margin_m);
        // How near it comes at poses that are at most a millimetre apart.
        constexpr double step_m = 0.001;
        const int steps = 1 + static_cast<int>(motion_m(checker.reach(), change_between(from, to)) / step_m);
        double least_m = infinity, least_to_itself_m = infinity;
        for (int i = 0; i <= steps; ++i) {
            const SpacePose pose = on_the_way(from, to, static_cast<double>(i) / steps);
            least_m = std::min(least_m, checker.clearance_m(pose, 1) - margin_m);
            least_to_itself_m = std::min(least_to_itself_m, checker.self_clearance_m(pose, 1));
        }
        const double nearest_m = std::min(least_m, least_to_itself_m);
        CAPTURE(round, margin_m, least_m, least_to_itself_m);
        if (comes_nearer) {
            CHECK(nearest_m < 0.5 * step_m + 1e-7);
        } else {
            CHECK(nearest_m > -0.5 * step_m);
        }
        (comes_nearer ? found : free) += 1;
    }
    CHECK(found > 60);
    CHECK(free > 60);
}

TEST_CASE("Until it has moved by its free motion a robot keeps the margin") {
    reference::Dice dice(75);
    int looked = 0;
    for (int round = 0; round < 600; ++round) {
        const SpaceRobotShape robot = dice.space_robot(round % 4);
        const SpaceChecker checker(std::make_shared<const Scene>(dice.obstacles(2)), robot);
        const SpacePose from = dice.space_pose();
        const double margin_m = dice.between(0, 0.1);
        const SpaceChecker::FreeMotion free = checker.free_motion(from, margin_m, 0.4);
        const double free_m = std::min(free.to_obstacles_m, free.to_itself_m);
        CHECK(free_m >= 0);
        CHECK(std::max(free.to_obstacles_m, free.to_itself_m) <= 0.4);
        CHECK((free_m > 0 || checker.is_nearer_than(from, margin_m + 1e-7)));
        const SpacePose to = near_to(from, 1, dice);
        const SpaceChange<double> change = change_between(from, to);
        if (free_m > 1e-3) {
            const double share = std::min((free.to_obstacles_m - 1e-6) / motion_m(checker.reach(), change),
                                          (free.to_itself_m - 1e-6) / joint_motion_m(checker.reach(), change));
            const SpacePose then = on_the_way(from, to, std::min(1.0, share));
            CHECK_FALSE(checker.is_nearer_than(then, margin_m));
            ++looked;
        }
    }
    CHECK(looked > 100);
}

TEST_CASE("A pose in space that is not finite, or without an attitude, is in contact") {
    const SpaceRobotShape robot = folding_arm();
    for (const CollisionCheckerKind kind : {CollisionCheckerKind::own, CollisionCheckerKind::fcl}) {
        const SpaceChecker checker = checker_of({{"", Sphere{1}, {1e3, 0, 0}, {}}}, robot, kind);
        std::vector<SpacePose> poses{at({0, 0, 0}, {0, 0, 0, 0})};
        for (const double bad : {std::nan(""), infinity}) {
            poses.push_back(at({0, bad, 0}));
            poses.push_back(at({}, {1, 0, bad, 0}));
            poses.push_back(at({}, {1, 0, 0, 0}, {0, bad}));
        }
        for (const SpacePose& pose : poses) {
            CHECK(checker.is_nearer_than(pose, 0));
            CHECK(checker.clearance_m(pose) == -infinity);
            CHECK(checker.free_motion(pose, 0, 1).is_none());
            CHECK(checker.comes_nearer_between({}, pose, 0));
            CHECK_FALSE(checker.nearest_obstacle(pose, infinity));
        }
        // A joint that the robot has not got says nothing.
        CHECK_FALSE(checker.is_nearer_than(at({}, {1, 0, 0, 0}, {0, 0, std::nan("")}), 0));
        CHECK(checker.comes_nearer_between(at({-1e308, 0, 0}), at({1e308, 0, 0}), 0));
    }
}
