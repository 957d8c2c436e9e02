#include "downwash/judge/space_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/judge/placement.hpp"
#include "downwash/judge/solids.hpp"
#include "downwash/judge/space_surroundings.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

Pose pose_of(const BodyFrame& frame) {
    Pose pose = moved(frame.origin_m);
    pose.linear() = frame.attitude;
    return pose;
}

/// The solids of a shape in the frame of its body, and how far they reach from its origin.
struct Reader {
    Vector3d center_m;
    std::vector<Part>& parts;
    double& reach_m;

    void add(const Shape& shape, double radius_m) const {
        read_shape(shape, moved(center_m),
                   [&](Geometry geometry, const Pose& pose) { parts.emplace_back(std::move(geometry), pose); });
        reach_m = std::max(reach_m, center_m.norm() + radius_m);
    }
    void operator()(const Box& box) const { add(box, 0.5 * vector_of(box.size_m).norm()); }
    void operator()(const Cylinder& c) const { add(c, std::hypot(c.radius_m, 0.5 * c.length_m)); }
    void operator()(const Sphere& sphere) const { add(sphere, sphere.radius_m); }
    void operator()(const Capsule& capsule) const {
        const Vector3d from = vector_of(capsule.from_m);
        const Vector3d to = vector_of(capsule.to_m);
        Pose pose = moved(center_m + 0.5 * (from + to));
        if (from != to) {
            pose.linear() = turn_from_z(to - from).toRotationMatrix();
        }
        parts.emplace_back(capsule_of(capsule.radius_m, (to - from).norm()), pose);
        reach_m =
            std::max({reach_m, (center_m + from).norm() + capsule.radius_m, (center_m + to).norm() + capsule.radius_m});
    }
};

}  // namespace

std::vector<BodyFrame> frames_of(const SpaceVehicle& vehicle, const BodyMotions& bodies, const SpaceWorld& world) {
    std::vector<BodyFrame> frames;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(-world.scene_yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Vector3d lever = i == 0 ? Vector3d(-vehicle.center_of_mass_m) : vehicle.joints[i - 1].in_outer_m;
        frames.push_back({nominal_place(world, bodies[i].position_m + bodies[i].attitude * lever),
                          turn * bodies[i].attitude.toRotationMatrix()});
    }
    return frames;
}

struct SpaceObstacles::Solids {
    ObstacleSolids obstacles;
    std::vector<std::vector<Part>> bodies;
    Geometry disc;
    struct Pair {
        std::size_t body_a, part_a, body_b, part_b;
    };
    std::vector<Pair> pairs;  ///< of the robot itself, that may meet

    explicit Solids(const std::vector<Obstacle>& all) : obstacles(all) {}

    [[nodiscard]] double distance_m(const Pair& pair, const std::vector<BodyFrame>& frames) const {
        const Part& a = bodies[pair.body_a][pair.part_a];
        const Part& b = bodies[pair.body_b][pair.part_b];
        return distance_between(*a.geometry, pose_of(frames[pair.body_a]) * a.pose, *b.geometry,
                                pose_of(frames[pair.body_b]) * b.pose);
    }
};

SpaceObstacles::SpaceObstacles(const std::vector<Obstacle>& obstacles, const SpaceRobot& robot) {
    auto solids = std::make_unique<Solids>(obstacles);
    const std::size_t count = robot.links.size() + 1;
    solids->bodies.resize(count);
    reach_m_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (const SpaceBodyShape& body : i == 0 ? robot.body : robot.links[i - 1].body) {
            std::visit(Reader{vector_of(body.center_m), solids->bodies[i], reach_m_[i]}, body.shape);
        }
    }
    solids->disc = disc_of(robot.rotor_radius_m);
    // A link without a solid counts as part of what it is mounted on: what comes after it is that one's neighbour.
    std::vector<std::size_t> inner(count);
    for (std::size_t i = 1; i < count; ++i) {
        inner[i] = i - 1;
        while (inner[i] > 0 && solids->bodies[inner[i]].empty()) {
            --inner[i];
        }
    }
    for (std::size_t b = 1; b < count; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            for (std::size_t i = 0; a != inner[b] && i < solids->bodies[a].size(); ++i) {
                for (std::size_t k = 0; k < solids->bodies[b].size(); ++k) {
                    solids->pairs.push_back({a, i, b, k});
                }
            }
        }
    }
    // What touches at all of many arms overlaps by design.
    const SpaceVehicle vehicle = vehicle_in(SpaceWorld{}, robot);
    constexpr int arms = 256;
    const auto overlaps_always = [&](const Solids::Pair& pair) {
        for (int arm = 0; arm < arms; ++arm) {
            SpaceCoordinates at{
                Vector3d::Zero(), Eigen::Quaterniond::Identity(),         Vector3d::Zero(),
                Vector3d::Zero(), Eigen::VectorXd(vehicle.joint_count()), Eigen::VectorXd::Zero(vehicle.joint_count())};
            for (int i = 0; i < vehicle.joint_count(); ++i) {
                // Multiples of roots spread evenly (Weyl).
                constexpr double roots[] = {1.4142135623730951, 1.7320508075688772, 2.23606797749979,
                                            2.6457513110645907, 3.3166247903554,    3.605551275463989};
                const double share = std::fmod((arm + 0.5) * roots[i], 1.0);
                const SpaceLinkLimits& limits = robot.links[static_cast<std::size_t>(i)];
                const double low = limits.is_limited ? limits.lower_limit_rad : -std::numbers::pi;
                const double high = limits.is_limited ? limits.upper_limit_rad : std::numbers::pi;
                at.joints_rad[i] = low + share * (high - low);
            }
            if (solids->distance_m(pair, frames_of(vehicle, bodies_at(vehicle, at), SpaceWorld{})) > 0) {
                return false;
            }
        }
        return true;
    };
    std::erase_if(solids->pairs, overlaps_always);
    solids_ = std::move(solids);
}

SpaceObstacles::~SpaceObstacles() = default;

double SpaceObstacles::clearance_m(const std::vector<BodyFrame>& frames) const {
    double least_m = infinity;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        for (const Part& part : solids_->bodies[i]) {
            least_m = solids_->obstacles.distance_m(part.geometry, pose_of(frames[i]) * part.pose, least_m);
        }
    }
    return least_m;
}

double SpaceObstacles::self_clearance_m(const std::vector<BodyFrame>& frames) const {
    double least_m = infinity;
    for (const Solids::Pair& pair : solids_->pairs) {
        least_m = std::min(least_m, solids_->distance_m(pair, frames));
    }
    return least_m;
}

bool SpaceObstacles::disc_keeps(double distance_m, const Vector3d& hub_m) const {
    return solids_->obstacles.distance_m(solids_->disc, moved(hub_m), distance_m) >= distance_m;
}

bool SpaceObstacles::line_keeps(double distance_m, const Vector3d& from_m, const Vector3d& to_m) const {
    const Vector3d line = to_m - from_m;
    Pose pose = moved(0.5 * (from_m + to_m));
    if (!line.isZero(0)) {
        pose.linear() = turn_from_z(line).toRotationMatrix();
    }
    return solids_->obstacles.distance_m(capsule_of(distance_m, line.norm()), pose, infinity) > 0;
}

double SpaceObstacles::reach_beyond_m(const std::vector<BodyFrame>& frames, std::size_t body, const Vector3d& point_m,
                                      const Vector3d& direction) const {
    // What the solids leave of the gap to a plate in front of them.
    constexpr double ahead_m = 1, width_m = 4, thickness_m = 0.2;
    Pose pose = moved(point_m + (ahead_m + 0.5 * thickness_m) * direction);
    pose.linear() = turn_from_z(direction).toRotationMatrix();
    std::vector<Part> plate;
    read_shape(Box{{width_m, width_m, thickness_m}}, pose,
               [&](Geometry geometry, const Pose& at) { plate.emplace_back(std::move(geometry), at); });
    double gap_m = ahead_m;
    for (const Part& part : solids_->bodies[body]) {
        gap_m = std::min(gap_m, distance_between(*part.geometry, pose_of(frames[body]) * part.pose,
                                                 *plate.front().geometry, plate.front().pose));
    }
    return ahead_m - gap_m;
}

struct NamedObstacle::Solids {
    ObstacleSolids obstacles;
    Geometry dot;

    explicit Solids(const std::vector<Obstacle>& named) : obstacles(named) {
        read_shape(Sphere{dot_m}, Pose::Identity(), [&](Geometry geometry, const Pose&) { dot = std::move(geometry); });
        dot->computeLocalAABB();
    }
    static constexpr double dot_m = 1e-3;
};

NamedObstacle::NamedObstacle(const std::vector<Obstacle>& all, const std::string& name) {
    std::vector<Obstacle> named;
    std::copy_if(all.begin(), all.end(), std::back_inserter(named),
                 [&](const Obstacle& obstacle) { return obstacle.name == name; });
    solids_ = std::make_unique<const Solids>(named);
}

NamedObstacle::~NamedObstacle() = default;

double NamedObstacle::distance_m(const Vector3d& at_m) const {
    const double from_dot_m = solids_->obstacles.distance_m(solids_->dot, moved(at_m), infinity);
    return from_dot_m > 0 ? from_dot_m + Solids::dot_m : 0;
}

}  // namespace downwash::judge
