#include "downwash/scene/fcl_distances.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "downwash/base/infinity.hpp"
#include "downwash/scene/fcl_geometry.hpp"
#include "downwash/scene/scene_solids.hpp"

namespace downwash {
namespace {

using in_fcl::box_around;
using in_fcl::Geometry;
using in_fcl::half_extent_m;
using in_fcl::placed_solid;
using in_fcl::Pose;
using in_fcl::pose_of;
using in_fcl::Triangles;
using in_fcl::vector_of;

constexpr double gjk_tolerance = 1e-10;
/// A distance that is proven up to this is not asked for again [m].
constexpr double trusted_m = 1e-6;
/// FCL's tree takes 4 us and 600 bytes a triangle: only those near which a robot comes are put into one.
constexpr std::size_t max_triangles_together = 256;

/// A shape that the caller keeps, as FCL's objects want it: nothing is counted, so that threads do not wait for it.
Geometry borrowed(fcl::CollisionGeometryd& shape) {
    return {Geometry{}, &shape};
}

/// A box along the axes of the world with all that is within `around_m` of another, for FCL's tree, whose own boxes
/// around turned solids are wide.
class Proxy {
 public:
    Proxy(const fcl::AABBd& box, double around_m)
        : shape_(Eigen::Vector3d(box.max_ - box.min_ + Eigen::Vector3d::Constant(2 * around_m))),
          object_(borrowed(shape_), Eigen::Matrix3d::Identity(), box.center()) {}
    Proxy(const Proxy&) = delete;
    Proxy& operator=(const Proxy&) = delete;

    fcl::CollisionObjectd* object() { return &object_; }
    const fcl::AABBd& box() const { return object_.getAABB(); }

 private:
    fcl::Boxd shape_;
    fcl::CollisionObjectd object_;
};

/// A convex part of the scene in the world, or some of its triangles.
class Part {
 public:
    Part(Geometry geometry, const Pose& pose)
        : pose_(pose), geometry_(std::move(geometry)), proxy_(box_around(*geometry_, pose), contact_m) {
        proxy_.object()->setUserData(this);
    }
    explicit Part(Triangles triangles)
        : pose_(Pose::Identity()), triangles_(std::move(triangles)), proxy_(box_around(*triangles_), contact_m) {
        proxy_.object()->setUserData(this);
    }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    static const Part& of(const fcl::CollisionObjectd& proxy) { return *static_cast<const Part*>(proxy.getUserData()); }

    const Pose& pose() const { return pose_; }
    bool is_mesh() const { return triangles_.has_value(); }
    const fcl::AABBd& box() const { return proxy_.box(); }
    fcl::CollisionObjectd* proxy() { return proxy_.object(); }
    const fcl::CollisionGeometryd& geometry() const {
        if (is_mesh()) {
            std::call_once(is_made_, [this] { geometry_ = in_fcl::tree_of(*triangles_); });
        }
        return *geometry_;
    }

 private:
    Pose pose_;
    std::optional<Triangles> triangles_;
    mutable std::once_flag is_made_;
    mutable Geometry geometry_;  ///< of triangles: when first asked for
    Proxy proxy_;
};

/// A solid of the robot in one of its frames.
struct Piece {
    Geometry geometry;
    Pose pose;
    std::size_t frame = 0;
};

/// A piece in the world.
struct PlacedPiece {
    const fcl::CollisionGeometryd& geometry;
    Pose pose;
    fcl::AABBd box;
};

/// What a piece is compared with.
struct Target {
    const fcl::CollisionGeometryd& geometry;
    const Pose& pose;
    bool is_mesh = false;
};

Target target_of(const Part& part) {
    return {part.geometry(), part.pose(), part.is_mesh()};
}

fcl::GJKSolverType solver_of(FclSolver solver) {
    return solver == FclSolver::indep ? fcl::GST_INDEP : fcl::GST_LIBCCD;
}

bool are_in_contact(fcl::GJKSolverType solver, const fcl::CollisionGeometryd& a, const Pose& at_a,
                    const Target& target) {
    fcl::CollisionRequestd request;
    request.gjk_solver_type = solver;
    fcl::CollisionResultd result;
    return fcl::collide(&a, at_a, &target.geometry, target.pose, request, result) > 0;
}

/// Whether a piece that grew by a margin touches a target: the same as being nearer than the margin for round pieces,
/// while the corners of others are sharp, so that only false is sure.
bool may_be_nearer(fcl::GJKSolverType solver, const PlacedPiece& piece, const Target& target, double margin_m) {
    const auto collides = [&](const fcl::CollisionGeometryd& grown) {
        return are_in_contact(solver, grown, piece.pose, target);
    };
    switch (piece.geometry.getNodeType()) {
        case fcl::GEOM_BOX: {
            const auto& box = static_cast<const fcl::Boxd&>(piece.geometry);
            return collides(fcl::Boxd(Eigen::Vector3d(box.side + Eigen::Vector3d::Constant(2 * margin_m))));
        }
        case fcl::GEOM_SPHERE:
            return collides(fcl::Sphered(static_cast<const fcl::Sphered&>(piece.geometry).radius + margin_m));
        case fcl::GEOM_CAPSULE: {
            const auto& capsule = static_cast<const fcl::Capsuled&>(piece.geometry);
            return collides(fcl::Capsuled(capsule.radius + margin_m, capsule.lz));
        }
        case fcl::GEOM_CYLINDER: {
            const auto& cylinder = static_cast<const fcl::Cylinderd&>(piece.geometry);
            return collides(fcl::Cylinderd(cylinder.radius + margin_m, cylinder.lz + 2 * margin_m));
        }
        default:
            return true;
    }
}

/// Whether solids that are nearer than a margin are those that touch when one grows by it in FCL's own shapes.
bool grows_exactly(const PlacedPiece& piece) {
    const fcl::NODE_TYPE type = piece.geometry.getNodeType();
    return type == fcl::GEOM_SPHERE || type == fcl::GEOM_CAPSULE;
}

/// What one of FCL's solvers says.
struct Answer {
    double distance_m;  ///< 0 on contact
    double proven_m;    ///< no less, if above 0: the gap along the line between the nearest points that it names
};

Answer answer_of(fcl::GJKSolverType solver, const PlacedPiece& piece, const Target& target) {
    fcl::DistanceRequestd request(true);
    request.gjk_solver_type = solver;
    request.distance_tolerance = gjk_tolerance;
    fcl::DistanceResultd result;
    const double distance_m =
        fcl::distance(&piece.geometry, piece.pose, &target.geometry, target.pose, request, result);
    Answer answer{distance_m > 0 ? distance_m : 0, 0};  // what is no number is contact, too
    const Eigen::Vector3d line = result.nearest_points[1] - result.nearest_points[0];
    const double length_m = line.norm();
    if (length_m > 0 && !target.is_mesh) {
        const Eigen::Vector3d n = line / length_m;
        const auto half_along = [&n](const fcl::CollisionGeometryd& shape, const Pose& at) {
            return half_extent_m(shape, at.linear().transpose() * n);
        };
        answer.proven_m = n.dot(target.pose.translation() - piece.pose.translation()) -
                          half_along(piece.geometry, piece.pose) - half_along(target.geometry, target.pose);
    }
    return answer;
}

/// The distance of two solids [m], 0 on contact.
double measured_m(FclSolver solver, const PlacedPiece& piece, const Target& target) {
    const fcl::GJKSolverType first_solver = solver_of(solver);
    const Answer first = answer_of(first_solver, piece, target);
    if (solver != FclSolver::both) {
        return first.distance_m;
    }
    const bool is_trusted = first.proven_m > 0 && first.distance_m - first.proven_m <= trusted_m;
    if (is_trusted) {
        return first.distance_m;
    }
    if (are_in_contact(first_solver, piece.geometry, piece.pose, target)) {
        return 0;
    }
    const Answer second = answer_of(fcl::GST_INDEP, piece, target);
    return std::max({std::min(first.distance_m, second.distance_m), first.proven_m, second.proven_m, contact_m});
}

bool is_within(FclSolver solver, const PlacedPiece& piece, const Target& target, double margin_m) {
    const fcl::GJKSolverType first = solver_of(solver);
    if (margin_m <= contact_m) {
        return are_in_contact(first, piece.geometry, piece.pose, target);
    }
    if (!may_be_nearer(first, piece, target, margin_m)) {
        return false;
    }
    return grows_exactly(piece) || measured_m(solver, piece, target) < margin_m;
}

}  // namespace

struct FclDistances::Solids {
    std::shared_ptr<const Scene> scene;
    FclSolver solver;
    std::deque<Part> parts;
    fcl::DynamicAABBTreeCollisionManagerd tree;
    std::vector<Piece> pieces;
    double reach_m = 0;  ///< of all pieces from the origin of frame 0

    void add_parts();
    void add_part(const SpaceShape& shape, const Pose& pose) {
        const auto [geometry, at] = placed_solid(shape, pose);
        parts.emplace_back(geometry, at);
    }
    /// Neighbours become a part together. @param some of all; changes their order
    void add_triangles(const std::vector<Triangle>& all, std::span<std::uint32_t> some);
    void add_pieces(const std::vector<FramedSolid>& solids);

    PlacedPiece placed(const Piece& piece, std::span<const RobotFrame> frames) const {
        const RobotFrame& frame = frames[piece.frame];
        const Pose at = pose_of(frame.rotation, frame.origin_m) * piece.pose;
        return {*piece.geometry, at, box_around(*piece.geometry, at)};
    }

    /// Calls `visit(piece placed in the world, its frame)` until it returns true; whether it did.
    template <class Visit>
    bool any_piece(std::span<const RobotFrame> frames, const Visit& visit) const {
        return std::any_of(pieces.begin(), pieces.end(),
                           [&](const Piece& piece) { return visit(placed(piece, frames), piece.frame); });
    }

    /// Calls `visit(part)` for parts whose boxes come within `near_m` of a box, until it returns true; whether it did.
    template <class Visit>
    bool any_part_near(const fcl::AABBd& box, double near_m, const Visit& visit) const {
        struct Query {
            const Visit* visit;
            bool is_found = false;
            static bool ask(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* query) {
                auto& self = *static_cast<Query*>(query);
                self.is_found = (*self.visit)(Part::of(a->getUserData() != nullptr ? *a : *b));
                return self.is_found;
            }
        };
        Proxy around(box, near_m);
        Query query{&visit};
        tree.collide(around.object(), &query, Query::ask);
        return query.is_found;
    }

    /// Whether the box that holds the robot at any attitude keeps `margin_m` from every obstacle.
    bool is_far_away(const Vector3& center_m, double margin_m) const {
        const fcl::AABBd center(vector_of(center_m));
        return !any_part_near(center, reach_m + margin_m, [](const Part&) { return true; }) &&
               !is_inside_mesh(center_m);
    }

    bool is_inside_mesh(const Vector3& p_m) const { return scene->solids().is_inside_mesh(p_m); }
    bool is_inside_mesh(const PlacedPiece& piece) const {
        const Eigen::Vector3d& center_m = piece.pose.translation();
        return is_inside_mesh({center_m.x(), center_m.y(), center_m.z()});
    }

    /// The least distance of a piece if it is below `enough_m`, else `enough_m`; 0 on contact.
    double clearance_m(const PlacedPiece& piece, double enough_m) const {
        struct Query {
            const Solids* solids;
            const PlacedPiece* piece;
            double least_m;
            static bool ask(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* query, double& bound_m) {
                auto& self = *static_cast<Query*>(query);
                const Part& part = Part::of(a->getUserData() != nullptr ? *a : *b);
                if (self.piece->box.distance(part.box()) < self.least_m) {
                    self.least_m =
                        std::min(self.least_m, measured_m(self.solids->solver, *self.piece, target_of(part)));
                }
                bound_m = self.least_m;
                return self.least_m <= 0;
            }
        };
        Proxy around(piece.box, 0);
        Query query{this, &piece, enough_m};
        tree.distance(around.object(), &query, Query::ask);
        return query.least_m > 0 && is_inside_mesh(piece) ? 0 : query.least_m;
    }
};

void FclDistances::Solids::add_parts() {
    const Parts& placed = scene->solids().parts;
    for (std::size_t i = 0; i < placed.primitives.size(); ++i) {
        const Placement& placement = placed.primitive_placements[i];
        const Pose pose = pose_of(placement.rotation, placed.primitive_centers_m[i]);
        std::visit([&](const auto& primitive) { add_part(primitive, pose); }, placed.primitives[i]);
    }
    for (const OctreeBox& box : placed.octree_boxes) {
        add_part(Box{box.size_m}, pose_of(placed.octree_placements[box.turned].rotation, box.center_m));
    }
    std::vector<std::uint32_t> all(placed.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    add_triangles(placed.triangles, all);
    std::vector<fcl::CollisionObjectd*> proxies;
    proxies.reserve(parts.size());
    for (Part& part : parts) {
        proxies.push_back(part.proxy());
    }
    if (!proxies.empty()) {
        tree.registerObjects(proxies);
        tree.setup();
    }
}

void FclDistances::Solids::add_triangles(const std::vector<Triangle>& all, std::span<std::uint32_t> some) {
    if (some.size() <= max_triangles_together) {
        if (!some.empty()) {
            parts.emplace_back(Triangles{&all, {some.begin(), some.end()}});
        }
        return;
    }
    fcl::AABBd corners;
    for (const std::uint32_t i : some) {
        corners += vector_of(all[i][0]);
    }
    Eigen::Index longest = 0;
    (corners.max_ - corners.min_).maxCoeff(&longest);
    const auto along = static_cast<std::size_t>(longest);
    const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(some.begin(), middle, some.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return all[i][0][along] < all[j][0][along]; });
    add_triangles(all, {some.begin(), middle});
    add_triangles(all, {middle, some.end()});
}

void FclDistances::Solids::add_pieces(const std::vector<FramedSolid>& solids) {
    for (const FramedSolid& framed : solids) {
        Pose pose = Pose::Identity();
        pose.translation() = vector_of(framed.solid.center_m);
        const auto [geometry, at] = placed_solid(framed.solid.shape, pose);
        geometry->computeLocalAABB();
        pieces.push_back({geometry, at, framed.frame});
    }
}

FclDistances::FclDistances(const std::shared_ptr<const Scene>& scene, const std::vector<FramedSolid>& robot,
                           double reach_m, FclSolver solver) {
    auto solids = std::make_unique<Solids>();
    solids->scene = scene;
    solids->solver = solver;
    solids->reach_m = reach_m;
    solids->add_parts();
    solids->add_pieces(robot);
    solids_ = std::move(solids);
}

FclDistances::~FclDistances() = default;

bool FclDistances::is_nearer_than(std::span<const RobotFrame> frames, std::span<const double> margins_m) const {
    const Solids& s = *solids_;
    const double most_m = std::max(*std::max_element(margins_m.begin(), margins_m.end()), contact_m);
    return !s.is_far_away(frames[0].origin_m, most_m) &&
           s.any_piece(frames, [&](const PlacedPiece& piece, std::size_t frame) {
               const double near_m = std::max(margins_m[frame], contact_m);
               return s.any_part_near(piece.box, near_m, [&](const Part& part) {
                   return is_within(s.solver, piece, target_of(part), near_m);
               }) || s.is_inside_mesh(piece);
           });
}

double FclDistances::clearance_m(std::span<const RobotFrame> frames, double enough_m) const {
    double least_m = enough_m;
    solids_->any_piece(frames, [&](const PlacedPiece& piece, std::size_t) {
        least_m = solids_->clearance_m(piece, least_m);
        return least_m <= 0;
    });
    return least_m;
}

bool FclDistances::are_nearer(std::span<const RobotFrame> frames, std::size_t first, std::size_t second,
                              double margin_m) const {
    const PlacedPiece a = solids_->placed(solids_->pieces[first], frames);
    const PlacedPiece b = solids_->placed(solids_->pieces[second], frames);
    const double near_m = std::max(margin_m, contact_m);
    return a.box.distance(b.box) <= near_m && is_within(solids_->solver, a, Target{b.geometry, b.pose}, near_m);
}

double FclDistances::distance_m(std::span<const RobotFrame> frames, std::size_t first, std::size_t second) const {
    const PlacedPiece a = solids_->placed(solids_->pieces[first], frames);
    const PlacedPiece b = solids_->placed(solids_->pieces[second], frames);
    return measured_m(solids_->solver, a, Target{b.geometry, b.pose});
}

}  // namespace downwash
