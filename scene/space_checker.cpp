#include "downwash/scene/space_checker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/direction.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/scene/fcl_distances.hpp"
#include "downwash/scene/robot_solids.hpp"
#include "downwash/scene/scene_solids.hpp"
#include "downwash/scene/self_pairs.hpp"
#include "downwash/scene/space_frames.hpp"

namespace downwash {
namespace {

void inspect(const std::vector<SpaceBodyShape>& bodies, const std::string& owner, std::vector<KeyError>& errors) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        inspect(bodies[i], owner + "bodies[" + std::to_string(i) + "]", errors);
    }
}

void inspect(const SpaceLinkShape& link, const std::string& key, std::vector<KeyError>& errors) {
    if (!is_finite(link.joint_m)) {
        errors.push_back({key + "joint_m", "must be three finite numbers, in metres"});
    }
    if (!is_finite(link.axis) || !has_direction(link.axis)) {
        errors.push_back({key + "axis", "has no direction: expected a finite vector other than [0, 0, 0]"});
    }
    if (!(link.lower_limit_rad <= link.upper_limit_rad)) {
        errors.push_back({key + "lower_limit_rad", "must be at most upper_limit_rad"});
    }
    inspect(link.bodies, key, errors);
}

void require_valid(const SpaceRobotShape& robot) {
    std::vector<KeyError> errors;
    inspect(robot.bodies, "", errors);
    if (robot.links.size() > max_links) {
        errors.push_back({"links", "has " + std::to_string(robot.links.size()) + " links: at most " +
                                       std::to_string(max_links) + " are possible"});
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        inspect(robot.links[i], "links[" + std::to_string(i) + "].", errors);
    }
    throw_if_any(std::move(errors));
}

/// The multirotor's solids, then those of the links.
std::vector<FramedSolid> solids_of(const SpaceRobotShape& robot) {
    std::vector<FramedSolid> solids;
    const auto add = [&solids](const std::vector<SpaceBodyShape>& bodies, std::size_t frame) {
        for (const SpaceBodyShape& body : bodies) {
            solids.push_back({body, frame});
        }
    };
    add(robot.bodies, 0);
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        add(robot.links[i].bodies, i + 1);
    }
    return solids;
}

SpaceRobotShape valid(const SpaceRobotShape& robot) {
    require_valid(robot);
    return robot;
}

/// Half of the size of the greatest part of a way that is not halved further [m].
constexpr double max_cut_m = 0.0005;

}  // namespace

struct SpaceChecker::Impl {
    Impl(std::shared_ptr<const Scene> the_scene, const SpaceRobotShape& robot, CollisionCheckerKind the_kind)
        : scene(std::move(the_scene)),
          solids(scene->solids()),
          kind(the_kind),
          arm(valid(robot)),
          framed(solids_of(robot)),
          pieces(pieces_of(framed)),
          reach(arm.reach_of(pieces)),
          robot_reach_m(reach.robot_m()),
          pairs(self_pairs(arm, pieces, reach)) {
        for (const RobotPiece& piece : pieces) {
            Convex at_origin = piece.convex;
            at_origin.center_m = {};
            radii_m.push_back(downwash::reach_m(at_origin));
        }
    }

    const FclDistances& fcl() const {
        std::call_once(is_fcl_made,
                       [this] { made_fcl = std::make_unique<const FclDistances>(scene, framed, robot_reach_m); });
        return *made_fcl;
    }

    bool is_usable(const SpacePose& pose) const {
        const auto& q = pose.attitude;
        const double squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        const double joints_rad = std::accumulate(
            pose.joints_rad.begin(), pose.joints_rad.begin() + static_cast<std::ptrdiff_t>(arm.links()), 0.0);
        return squared > 0 && std::isfinite(squared) && is_finite(pose.position_m) && std::isfinite(joints_rad);
    }

    const std::vector<SelfPair>& pairs_at(const SpacePose& pose) const {
        return arm.is_within_limits(pose.joints_rad) ? pairs.within_limits : pairs.beyond_limits;
    }
    /// Between two poses, too: joints change evenly.
    const std::vector<SelfPair>& pairs_between(const SpacePose& a, const SpacePose& b) const {
        return arm.is_within_limits(b.joints_rad) ? pairs_at(a) : pairs.beyond_limits;
    }

    /// Calls `visit(piece placed in the world, its frame)` until it returns true; whether it did.
    template <class Visit>
    bool any_piece(const SpaceFrames& frames, const Visit& visit) const {
        return std::any_of(pieces.begin(), pieces.end(), [&](const RobotPiece& piece) {
            return visit(frames[piece.frame].placed(piece.convex), piece.frame);
        });
    }
    /// The same for what does not ask for the frame.
    auto each_piece_at(const SpaceFrames& frames) const {
        return [this, &frames](const auto& visit) {
            return any_piece(frames, [&](const Convex& piece, std::size_t) { return visit(piece); });
        };
    }

    /// Whether a solid may come nearer than a margin to an obstacle, or touch another one of the robot, before
    /// coordinates change by more than that. Never false if one does; true is certain where nothing changes.
    bool may_come_near(const SpacePose& pose, double margin_m, const SpaceChange<double>& change,
                       const std::vector<SelfPair>& compared) const {
        std::array<double, max_links + 1> near_m{};
        for (std::size_t body = 0; body <= reach.links; ++body) {
            near_m[body] = reach.bodies[body].can_touch ? margin_m + motion_m(reach, body, change) : 0;
        }
        const bool is_far = kind == CollisionCheckerKind::own &&
                            is_far_away(solids, pose.position_m, robot_reach_m,
                                        std::max(*std::max_element(near_m.begin(), near_m.end()), contact_m));
        if (is_far && compared.empty()) {
            return false;
        }
        const SpaceFrames frames = arm.frames_at(pose);
        return (!is_far && are_obstacles_near(frames, near_m)) ||
               std::any_of(compared.begin(), compared.end(), [&](const SelfPair& pair) {
                   return are_nearer(
                       frames, pair,
                       contact_m + joint_motion_m(reach, pieces[pair.first].frame, pieces[pair.second].frame, change));
               });
    }

    bool are_obstacles_near(const SpaceFrames& frames, const std::array<double, max_links + 1>& near_m) const {
        return kind == CollisionCheckerKind::fcl ? fcl().is_nearer_than(frames, {near_m.data(), frames.count})
                                                 : any_piece(frames, [&](const Convex& piece, std::size_t body) {
                                                       return solids.are_near(piece, near_m[body]);
                                                   });
    }

    /// No greater than the distance of two solids of the robot: that of balls around them.
    double apart_m(const SpaceFrames& frames, const SelfPair& pair) const {
        const auto center_m = [&](std::uint32_t i) {
            return frames[pieces[i].frame].placed(pieces[i].convex.center_m);
        };
        const Vector3 line_m = center_m(pair.first) - center_m(pair.second);
        return std::sqrt(dot(line_m, line_m)) - (radii_m[pair.first] + radii_m[pair.second]);
    }

    bool are_nearer(const SpaceFrames& frames, const SelfPair& pair, double margin_m) const {
        if (apart_m(frames, pair) > margin_m + contact_m) {
            return false;
        }
        return kind == CollisionCheckerKind::fcl
                   ? fcl().are_nearer(frames, pair.first, pair.second, margin_m)
                   : downwash::is_nearer_than(placed(frames, pair.first), placed(frames, pair.second), margin_m);
    }

    double distance_of(const SpaceFrames& frames, const SelfPair& pair, double enough_m) const {
        if (apart_m(frames, pair) >= enough_m) {
            return enough_m;
        }
        return std::min(enough_m, kind == CollisionCheckerKind::fcl
                                      ? fcl().distance_m(frames, pair.first, pair.second)
                                      : distance_m(placed(frames, pair.first), placed(frames, pair.second), enough_m));
    }

    Convex placed(const SpaceFrames& frames, std::uint32_t i) const {
        return frames[pieces[i].frame].placed(pieces[i].convex);
    }

    double obstacle_clearance_m(const SpaceFrames& frames, double enough_m) const {
        return kind == CollisionCheckerKind::fcl ? fcl().clearance_m(frames, enough_m)
                                                 : clearance_of(solids, enough_m, each_piece_at(frames));
    }

    double self_clearance_m(const SpaceFrames& frames, const std::vector<SelfPair>& compared, double enough_m) const {
        const double min_m =
            std::accumulate(compared.begin(), compared.end(), enough_m,
                            [&](double so_far_m, const SelfPair& pair) { return distance_of(frames, pair, so_far_m); });
        return min_m < contact_m ? std::min(min_m, 0.0) : min_m;
    }

    bool comes_nearer(const SpacePose& from, const SpacePose& to, const SpaceChange<double>& change, double margin_m,
                      const std::vector<SelfPair>& compared) const {
        // Every point stays within what it moves in half of the change from where it is in the middle.
        const SpaceChange<double> half = change.half();
        const SpacePose middle = halfway(from, to);
        if (!may_come_near(middle, margin_m, half, compared)) {
            return false;
        }
        if (may_come_near(middle, margin_m, {}, compared)) {
            return true;
        }
        return motion_m(reach, half) > max_cut_m && (comes_nearer(from, middle, half, margin_m, compared) ||
                                                     comes_nearer(middle, to, half, margin_m, compared));
    }

    std::shared_ptr<const Scene> scene;
    const SceneSolids& solids;
    CollisionCheckerKind kind;
    SpaceArm arm;
    std::vector<FramedSolid> framed;
    std::vector<RobotPiece> pieces;
    SpaceReach reach;
    double robot_reach_m;
    SelfPairs pairs;
    std::vector<double> radii_m;  ///< of balls around the pieces, about their centres
    mutable std::once_flag is_fcl_made;
    mutable std::unique_ptr<const FclDistances> made_fcl;
};

SpaceChecker::SpaceChecker(std::shared_ptr<const Scene> scene, const SpaceRobotShape& robot, CollisionCheckerKind kind)
    : impl_(std::make_shared<const Impl>(std::move(scene), robot, kind)) {}

CollisionCheckerKind SpaceChecker::kind() const noexcept {
    return impl_->kind;
}

const SpaceReach& SpaceChecker::reach() const noexcept {
    return impl_->reach;
}

double SpaceChecker::robot_reach_m() const noexcept {
    return impl_->robot_reach_m;
}

bool SpaceChecker::is_nearer_than(const SpacePose& pose, double margin_m) const {
    return !impl_->is_usable(pose) || impl_->may_come_near(pose, margin_m, {}, impl_->pairs_at(pose));
}

double SpaceChecker::clearance_m(const SpacePose& pose, double enough_m) const {
    if (!impl_->is_usable(pose)) {
        return -infinity;
    }
    const SpaceFrames frames = impl_->arm.frames_at(pose);
    const double to_obstacles_m = impl_->obstacle_clearance_m(frames, enough_m);
    const double to_itself_m = impl_->self_clearance_m(frames, impl_->pairs_at(pose), contact_m);
    return to_itself_m < contact_m ? std::min(to_obstacles_m, to_itself_m) : to_obstacles_m;
}

std::optional<std::size_t> SpaceChecker::nearest_obstacle(const SpacePose& pose, double within_m) const {
    if (!impl_->is_usable(pose)) {
        return std::nullopt;
    }
    const SpaceFrames frames = impl_->arm.frames_at(pose);
    return nearest_of(impl_->solids, within_m, impl_->each_piece_at(frames));
}

double SpaceChecker::self_clearance_m(const SpacePose& pose, double enough_m) const {
    return impl_->is_usable(pose) ? impl_->self_clearance_m(impl_->arm.frames_at(pose), impl_->pairs_at(pose), enough_m)
                                  : -infinity;
}

std::optional<SpaceChecker::Bodies> SpaceChecker::touching_bodies(const SpacePose& pose) const {
    if (!impl_->is_usable(pose)) {
        return std::nullopt;
    }
    const SpaceFrames frames = impl_->arm.frames_at(pose);
    const std::vector<SelfPair>& pairs = impl_->pairs_at(pose);
    const auto found = std::find_if(pairs.begin(), pairs.end(),
                                    [&](const SelfPair& pair) { return impl_->are_nearer(frames, pair, contact_m); });
    return found != pairs.end()
               ? std::optional(Bodies{impl_->pieces[found->first].frame, impl_->pieces[found->second].frame})
               : std::nullopt;
}

SpaceChecker::FreeMotion SpaceChecker::free_motion(const SpacePose& pose, double margin_m, double enough_m) const {
    if (!impl_->is_usable(pose)) {
        return {};
    }
    const SpaceFrames frames = impl_->arm.frames_at(pose);
    const double to_obstacles_m = impl_->obstacle_clearance_m(frames, margin_m + enough_m) - margin_m;
    const double to_itself_m = impl_->self_clearance_m(frames, impl_->pairs_at(pose), enough_m);
    return {std::clamp(to_obstacles_m, 0.0, enough_m), std::clamp(to_itself_m, 0.0, enough_m)};
}

bool SpaceChecker::comes_nearer_between(const SpacePose& from, const SpacePose& to, double margin_m) const {
    const SpaceChange<double> change = change_between(from, to);
    return !impl_->is_usable(from) || !impl_->is_usable(to) || !std::isfinite(motion_m(impl_->reach, change)) ||
           impl_->comes_nearer(from, to, change, margin_m, impl_->pairs_between(from, to));
}

}  // namespace downwash
