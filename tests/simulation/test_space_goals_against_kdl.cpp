#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <memory>
#include <numbers>

#include "../support/random.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"

// Configurations at goals in space against the Kinematics and Dynamics Library of the Orocos project: its forward
// kinematics says where the end effector is, and its numeric inverse kinematics which goals can be met.

using namespace downwash;

namespace {

constexpr double pi = std::numbers::pi;

KDL::Vector kdl(const Vector3& v) {
    return {v[0], v[1], v[2]};
}

Vector3 direction(test::Random& random) {
    for (;;) {
        const Vector3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double square = dot(v, v);
        if (square > 0.01 && square < 1) {
            return (1 / std::sqrt(square)) * v;
        }
    }
}

Vector3 along_an_axis(test::Random& random) {
    Vector3 v{};
    v[static_cast<std::size_t>(random.integer(0, 2))] = random.integer(0, 1) == 0 ? 1 : -1;
    return v;
}

/// An arm of so many joints: about any axes or, as most arms, about those of the body.
SpaceRobot random_robot(int joints, test::Random& random) {
    SpaceRobot robot;
    const bool is_square = random.integer(0, 1) == 0;
    const auto some_direction = [&] { return is_square ? along_an_axis(random) : direction(random); };
    for (int i = 0; i < joints; ++i) {
        SpaceLink link;
        link.joint_m = random.uniform(0.05, 0.4) * some_direction();
        link.axis = random.uniform(0.5, 2) * some_direction();
        robot.plant.links.push_back(link);
        SpaceLinkLimits limits;
        limits.is_limited = random.integer(0, 4) > 0;
        limits.lower_limit_rad = random.uniform(-pi, 0);
        limits.upper_limit_rad = limits.lower_limit_rad + random.uniform(0.5, 5);
        robot.links.push_back(limits);
    }
    robot.plant.end_effector_m = random.uniform(0.05, 0.4) * some_direction();
    robot.tool_direction = some_direction();
    return robot;
}

double low(const SpaceLinkLimits& link) {
    return link.is_limited ? link.lower_limit_rad : -pi;
}
double high(const SpaceLinkLimits& link) {
    return link.is_limited ? link.upper_limit_rad : pi;
}

/// The level robot as a chain: three slides, a turn about the vertical, and the arm. With `is_roll_free` a joint more
/// turns the tool about where it points, so that a pose of the chain is a direction of the tool.
KDL::Chain chain_of(const SpaceRobot& robot, bool is_roll_free) {
    using KDL::Frame, KDL::Joint, KDL::Segment;
    KDL::Chain chain;
    chain.addSegment(Segment(Joint(Joint::TransX)));
    chain.addSegment(Segment(Joint(Joint::TransY)));
    chain.addSegment(Segment(Joint(Joint::TransZ)));
    const std::vector<SpaceLink>& links = robot.plant.links;
    const auto way = [&](std::size_t i) {
        return Frame(kdl(i < links.size() ? links[i].joint_m : robot.plant.end_effector_m));
    };
    chain.addSegment(Segment(Joint(Joint::RotZ), way(0)));
    for (std::size_t i = 0; i < links.size(); ++i) {
        chain.addSegment(Segment(Joint(KDL::Vector::Zero(), kdl(links[i].axis), Joint::RotAxis), way(i + 1)));
    }
    if (is_roll_free) {
        chain.addSegment(Segment(Joint(KDL::Vector::Zero(), kdl(robot.tool_direction), Joint::RotAxis)));
    }
    return chain;
}

KDL::Frame end_of(const KDL::Chain& chain, const SpaceConfiguration& at) {
    KDL::JntArray q(chain.getNrOfJoints());
    for (unsigned i = 0; i < q.rows(); ++i) {
        q(i) = i < at.size() ? at[i] : 0;
    }
    KDL::Frame frame;
    KDL::ChainFkSolverPos_recursive(chain).JntToCart(q, frame);
    return frame;
}

/// Whether KDL finds joints within the limits for a frame, from some starts.
bool is_met_by_kdl(const KDL::Chain& chain, const SpaceRobot& robot, const KDL::Frame& wanted, test::Random& random) {
    const unsigned count = chain.getNrOfJoints();
    KDL::JntArray least(count), most(count), start(count), found(count);
    for (unsigned i = 0; i < count; ++i) {
        const std::size_t link = i - 4;
        const bool is_link = i >= 4 && link < robot.links.size();
        least(i) = i < 3 ? -20 : is_link ? low(robot.links[link]) : -4 * pi;
        most(i) = i < 3 ? 20 : is_link ? high(robot.links[link]) : 4 * pi;
    }
    KDL::ChainFkSolverPos_recursive forward(chain);
    KDL::ChainIkSolverVel_pinv velocity(chain);
    KDL::ChainIkSolverPos_NR_JL inverse(chain, least, most, forward, velocity, 60, 1e-9);
    constexpr int starts = 4;
    for (int i = 0; i < starts; ++i) {
        for (unsigned k = 0; k < count; ++k) {
            start(k) = k < 3 ? wanted.p[static_cast<int>(k)]
                             : std::max(-pi, least(k)) +
                                   random.uniform(0, 1) * (std::min(pi, most(k)) - std::max(-pi, least(k)));
        }
        if (inverse.CartToJnt(start, wanted, found) >= 0) {
            return true;
        }
    }
    return false;
}

/// The greatest way of the ends of three axes of length 1.
double apart(const KDL::Rotation& a, const KDL::Rotation& b) {
    return std::max({(a.UnitX() - b.UnitX()).Norm(), (a.UnitY() - b.UnitY()).Norm(), (a.UnitZ() - b.UnitZ()).Norm()});
}

/// Goals of arms with so many joints.
struct Counts {
    int targets = 0, both = 0, only_ours = 0, only_kdl = 0, neither = 0;
    double worst_m = 0, worst_rad = 0;
    int tries = 0;
};

}  // namespace

TEST_CASE("Configurations at 10,000 goals of random arms meet them by KDL's kinematics, wherever KDL finds one") {
    test::Random random(20);
    Random draws(21);
    const auto nothing = std::make_shared<const Scene>(std::vector<Obstacle>());
    const SpaceBounds bounds{{-20, -20, -20}, {20, 20, 20}};
    Counts of_directions[7], of_poses[7];
    for (int i = 0; i < 10000; ++i) {
        const int joints = 1 + i % 6;
        const bool is_pose = i % 12 >= 6;
        const SpaceRobot robot = random_robot(joints, random);
        const KDL::Chain chain = chain_of(robot, false);
        // Half of the attitudes are somewhere, the others where joints within their limits take the hand.
        KDL::Frame wanted;
        if (i % 24 < 12) {
            SpaceConfiguration at{};
            at[space::yaw] = random.uniform(-pi, pi);
            for (std::size_t k = 0; k < robot.links.size(); ++k) {
                at[space::first_joint + k] =
                    low(robot.links[k]) + random.uniform(0, 1) * (high(robot.links[k]) - low(robot.links[k]));
            }
            wanted.M = end_of(chain, at).M;
        } else {
            const Vector3 axis = direction(random);
            wanted.M = KDL::Rotation::Rot(kdl(axis), random.uniform(-pi, pi));
        }
        const Vector3 place{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
        wanted.p = kdl(place);
        const KDL::Vector points = wanted.M * kdl(robot.tool_direction);
        SpaceGoal goal;
        if (is_pose) {
            SpacePoseGoal pose;
            pose.position_m = place;
            wanted.M.GetRPY(pose.rpy_rad[0], pose.rpy_rad[1], pose.rpy_rad[2]);
            goal.kind = pose;
        } else {
            SpaceEndEffectorGoal tool;
            tool.position_m = place;
            tool.direction = Vector3{points.x(), points.y(), points.z()};
            goal.kind = tool;
        }
        const SpaceGoalSampler sampler(robot, bounds, nothing, SpaceChecker(nothing, shape_of(robot)), 0, goal);
        const SpaceGoalSample sample = sampler.sample(draws, 0, 5000);
        Counts& counts = is_pose ? of_poses[joints] : of_directions[joints];
        ++counts.targets;
        if (sample.place) {
            counts.tries += sample.tries;
            const SpaceConfiguration& at = sample.place->at;
            for (std::size_t k = 0; k < robot.links.size(); ++k) {
                REQUIRE(at[space::first_joint + k] >= low(robot.links[k]));
                REQUIRE(at[space::first_joint + k] <= high(robot.links[k]));
            }
            const KDL::Frame is = end_of(chain, at);
            const KDL::Vector direction_off = is.M * kdl(robot.tool_direction) - points;
            const double off_rad = is_pose ? apart(is.M, wanted.M) : direction_off.Norm();
            counts.worst_m = std::max(counts.worst_m, (is.p - wanted.p).Norm());
            counts.worst_rad = std::max(counts.worst_rad, off_rad);
        }
        const bool by_kdl = is_met_by_kdl(chain_of(robot, !is_pose), robot, wanted, random);
        ++(sample.place ? (by_kdl ? counts.both : counts.only_ours) : by_kdl ? counts.only_kdl : counts.neither);
    }
    int met = 0;
    for (int joints = 1; joints <= 6; ++joints) {
        for (const Counts& counts : {of_directions[joints], of_poses[joints]}) {
            CAPTURE(joints, counts.targets, counts.both, counts.only_ours, counts.only_kdl, counts.neither,
                    counts.tries);
            CHECK(counts.worst_m < 1e-12);
            CHECK(counts.worst_rad < 1e-12);
            CHECK(counts.only_kdl == 0);
            CHECK(counts.both >= counts.targets / 2);
            met += counts.both + counts.only_ours;
        }
    }
    CHECK(met > 8000);
}
