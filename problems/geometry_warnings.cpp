#include "downwash/problems/geometry_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include "downwash/base/text.hpp"
#include "downwash/scene/mesh_remarks.hpp"
#include "downwash/scene/obstacle_placement.hpp"

namespace downwash {
namespace {

/// Obstacles this many times larger or smaller than the bounds are suspicious.
constexpr double suspicious_ratio = 100;
/// Single precision is coarse beyond this [m].
constexpr double max_step_m = 0.01;
/// A surface farther from a rotor changes its thrust by less than half a percent [radii].
constexpr double aerodynamic_reach_radii = 4;
/// Files with coordinates beyond this are likely those of a map [m].
constexpr double map_distance_m = 1000;
constexpr double quarter_turn_rad = 1.5707963267948966;

std::string rounded(double value) {
    return to_text(value, 4);
}

std::string text_of(const Vector3& v, int digits) {
    return "[" + joined(v, ", ", [digits](double x) { return to_text(x, digits); }) + "]";
}

/// The bounding box of an obstacle from a file in the plane's coordinates (x, lateral, z).
class BoxInPlane {
 public:
    BoxInPlane(const Obstacle& obstacle, const PlaneOfMotion& plane)
        : plane_(plane), center_m_(obstacle.center_world_m), rotation_(rotation_of(obstacle.rpy_rad)) {
        std::visit(*this, obstacle.shape);
    }

    [[nodiscard]] const BoundingBox& box() const noexcept { return box_; }

    void operator()(const Mesh& mesh) {
        for (const auto& triangle : mesh.surface->triangles) {
            for (const std::uint32_t corner : triangle) {
                add(local_m(mesh, mesh.surface->vertices_m[corner]));
            }
        }
    }
    void operator()(const Octomap& octomap) {
        for_each_solid_box(octomap, [this](const LocalBox& box) {
            for (unsigned corner = 0; corner < 8; ++corner) {
                Vector3 p_m = box.center_m;
                for (unsigned axis = 0; axis < 3; ++axis) {
                    p_m[axis] += (corner >> axis & 1U) != 0 ? box.size_m[axis] / 2 : -box.size_m[axis] / 2;
                }
                add(p_m);
            }
        });
    }
    template <class Primitive>
    void operator()(const Primitive& /*not from a file*/) {}

 private:
    void add(const Vector3& p_m) {
        const Vector3 in_plane = plane_.from_world(center_m_ + rotation_ * p_m);
        box_.include({in_plane, in_plane});
    }

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    const PlaneOfMotion& plane_;
    Vector3 center_m_;
    Matrix3 rotation_;
    BoundingBox box_{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
};

double size_of(const BoundingBox& box) {
    const Vector3 size = box.high_m - box.low_m;
    return std::max({size[0], size[1], size[2]});
}

bool do_meet(const BoundingBox& a, const BoundingBox& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.low_m[k] > b.high_m[k] || b.low_m[k] > a.high_m[k]) {
            return false;
        }
    }
    return true;
}

/// Where obstacles matter, in the plane's coordinates, and how large they usually are.
struct Region {
    BoundingBox reach;
    BoundingBox surroundings;  ///< wider across the plane, by the longer side of the bounds
    double bounds_m;           ///< longer side of the bounds

    explicit Region(const ProblemCheck& check) {
        const Problem& problem = check.problem();
        const RotorParameters& rotors = problem.robot.rotors;
        double reach_m = check.collisions().robot_reach_m();
        for (const Vector3& hub_m : rotors.positions_m) {
            reach_m = std::max(reach_m, std::sqrt(dot(hub_m, hub_m)) + (1 + aerodynamic_reach_radii) * rotors.radius_m);
        }
        const Bounds& b = problem.bounds;
        reach = {{b.x_low_m - reach_m, -reach_m, b.z_low_m - reach_m},
                 {b.x_high_m + reach_m, reach_m, b.z_high_m + reach_m}};
        bounds_m = std::max(b.x_high_m - b.x_low_m, b.z_high_m - b.z_low_m);
        surroundings = reach;
        surroundings.low_m[1] -= bounds_m;
        surroundings.high_m[1] += bounds_m;
    }

    [[nodiscard]] bool is_huge(const BoundingBox& box) const { return size_of(box) >= suspicious_ratio * bounds_m; }
    [[nodiscard]] bool is_tiny(const BoundingBox& box) const { return suspicious_ratio * size_of(box) <= bounds_m; }
    /// Whether a size may be that of another unit.
    [[nodiscard]] bool is_unlikely(const BoundingBox& box) const {
        constexpr double unlikely_ratio = 5;
        return size_of(box) >= unlikely_ratio * bounds_m || is_tiny(box);
    }
    [[nodiscard]] bool fits(const BoundingBox& box) const {
        return do_meet(box, reach) && !is_huge(box) && !is_tiny(box);
    }
};

/// The obstacle with its mesh at another scale, turned or not.
Obstacle changed(const Obstacle& obstacle, double factor, bool is_turned) {
    Obstacle tried = obstacle;
    if (auto* mesh = std::get_if<Mesh>(&tried.shape)) {
        mesh->scale *= factor;
    }
    if (is_turned) {
        tried.rpy_rad = {quarter_turn_rad, 0, 0};
    }
    return tried;
}

/// Keys that would put an obstacle where it is in the way, the first of those that do; nothing if none does. A scale is
/// among them if the obstacle's size is unlikely: that of every unit that fits.
std::optional<std::string> remedy_for(const Obstacle& obstacle, const PlaneOfMotion& plane, const Region& region) {
    const std::string turn = "`rpy_deg: [90, 0, 0]`, for a file whose y axis points up";
    const bool may_turn = obstacle.rpy_rad == Vector3{};
    const auto box_of = [&](double factor, bool is_turned) {
        return BoxInPlane(changed(obstacle, factor, is_turned), plane).box();
    };
    if (may_turn && region.fits(box_of(1, true))) {
        return turn;
    }
    const auto* mesh = std::get_if<Mesh>(&obstacle.shape);
    if (mesh == nullptr || !region.is_unlikely(box_of(1, false))) {
        return std::nullopt;
    }
    for (const bool is_turned : {false, true}) {
        std::vector<std::string> scales;
        for (const double scale : {1., 0.001, 0.01, 0.0254}) {
            const BoundingBox box = box_of(scale / mesh->scale, is_turned);
            if (scale != mesh->scale && (may_turn || !is_turned) && region.fits(box)) {
                scales.push_back("`scale: " + to_text(scale, 6) + "` (" + rounded(size_of(box)) + " m long)");
            }
        }
        if (!scales.empty()) {
            return joined_names(std::vector<std::string_view>(scales.begin(), scales.end())) +
                   (is_turned ? " and " + turn : "");
        }
    }
    return std::nullopt;
}

/// An offset that brings a mesh in map coordinates near to the origin; nothing if it has one or is near.
std::optional<std::string> offset_for(const Obstacle& obstacle) {
    const auto* mesh = std::get_if<Mesh>(&obstacle.shape);
    if (mesh == nullptr || mesh->offset_m != Vector3{}) {
        return std::nullopt;
    }
    const BoundingBox local = BoxInPlane({"", *mesh, {}, {}}, PlaneOfMotion()).box();
    Vector3 middle_m = 0.5 * (local.low_m + local.high_m);
    if (dot(middle_m, middle_m) < map_distance_m * map_distance_m) {
        return std::nullopt;
    }
    for (double& x : middle_m) {
        x = std::round(x);
    }
    return "`offset_m: " + text_of(middle_m, 15) + "`, for a file in map coordinates";
}

void add_place_warning(const Obstacle& obstacle, const std::string& key, const PlaneOfMotion& plane,
                       const Region& region, std::vector<KeyError>& warnings) {
    const BoundingBox box = BoxInPlane(obstacle, plane).box();
    // What has its centre beside the plane is likely meant to be there.
    const bool is_put_beside = plane.from_world(obstacle.center_world_m)[1] != 0;
    const bool is_outside = !do_meet(box, is_put_beside ? region.surroundings : region.reach);
    std::string what;
    if (region.is_huge(box) || region.is_tiny(box)) {
        what =
            "is " + rounded(size_of(box)) + " m long, " +
            (region.is_huge(box) ? "more than a hundred times the bounds, " : "less than a hundredth of the bounds, ") +
            rounded(region.bounds_m) + " m";
    }
    if (is_outside) {
        const auto range = [&](const char* name, std::size_t k) {
            return std::string(name) + " from " + rounded(box.low_m[k]) + " to " + rounded(box.high_m[k]) + " m";
        };
        what += std::string(what.empty() ? "" : ", and ") +
                "lies wholly outside of what the robot reaches within the bounds: in the plane of motion " +
                range("x", 0) + ", " + range("lateral", 1) + " and " + range("z", 2);
    }
    if (what.empty()) {
        return;
    }
    std::optional<std::string> remedy = remedy_for(obstacle, plane, region);
    if (!remedy && is_outside) {
        remedy = offset_for(obstacle);
    }
    warnings.push_back({key, what + (remedy ? "; it would be near with " + *remedy
                                            : "; check its place and its unit, or leave it out if the robot never "
                                              "gets there")});
}

void add_surface_warnings(const Mesh& mesh, const SurfaceFacts& facts, const std::string& key,
                          std::vector<KeyError>& warnings) {
    const std::string& file = mesh.file;
    for (const std::string& remark : mesh.surface->remarks) {
        warnings.push_back({key, "'" + file + "' "});
        warnings.back().message += remark;
    }
    const bool is_stl = is_same_word(std::filesystem::path(file).extension().string(), ".stl");
    if (const double step_m = is_stl ? mesh.scale * single_precision_step(*mesh.surface) : 0; step_m > max_step_m) {
        warnings.push_back({key, "'" + file +
                                     "' has coordinates so large that single precision rounds them to steps of " +
                                     rounded(step_m) + " m: export it about a local origin, or as OBJ"});
    }
    const std::size_t sheets = facts.pieces - facts.solid_pieces;
    if (facts.open_edges == 0 && sheets > 0) {
        warnings.push_back({key, "'" + file + "' has " + std::to_string(sheets) +
                                     (sheets == 1 ? " piece that is" : " pieces that are") +
                                     " closed but without volume: a sheet that is there twice, with nothing inside; "
                                     "give it a thickness if it is meant to be solid"});
    }
    if (facts.open_edges > 0) {
        const std::string which = facts.pieces == 1
                                      ? "the mesh is a sheet"
                                      : std::to_string(sheets) + " of its " + std::to_string(facts.pieces) +
                                            " pieces " + (sheets == 1 ? "is a sheet" : "are sheets");
        const std::size_t shared = shared_edges(*mesh.surface);
        const std::optional<Vector3> junction = shared == 0 ? t_junction(*mesh.surface) : std::nullopt;
        const std::string remedy =
            shared > 0 ? "three triangles or more meet at " + std::to_string(shared) +
                             " of these edges: write a wall between two rooms once for each"
            : junction ? "a corner of other triangles lies on such an edge at " + text_of(*junction, 7) +
                             " (a T-junction): split edges at such corners if it is meant to be solid"
                       : "close it if it is meant to be solid";
        warnings.push_back({key, "'" + file + "' is open at " + std::to_string(facts.open_edges) +
                                     (facts.open_edges == 1 ? " edge" : " edges, one of them") + " near " +
                                     text_of(facts.open_place, 7) + " in the file: " + which +
                                     " with nothing inside; " + remedy});
    }
}

/// Of a closed shell whose triangles face both ways: beside or around others it may be the wall of a cavity.
void add_turned_warning(const Mesh& mesh, const SurfaceFacts& facts, const std::string& key,
                        std::vector<KeyError>& warnings) {
    constexpr double near_tie = 1. / 3;
    if (facts.solid_pieces < 2) {
        return;
    }
    if (const double share = most_turned(*mesh.surface); share >= near_tie) {
        warnings.push_back({key, "'" + mesh.file + "' has a piece in which " + rounded(100 * share) +
                                     " % of the triangles face the other way than the rest: whether it is solid or a "
                                     "cavity is a guess; let all its triangles face away from what is solid"});
    }
}

/// What space that no sensor has seen counts as, where that is likely not meant.
void add_unseen_warning(const Octomap& octomap, const std::string& key, std::vector<KeyError>& warnings) {
    const OccupancyTree& tree = *octomap.tree;
    const std::string file = "'" + octomap.file + "' ";
    if (octomap.unknown == UnknownSpace::occupied) {
        if (!tree.has_free_leaf && tree.unseen_share > 0) {
            warnings.push_back({key, file +
                                         "has no free leaf, so that `unknown: occupied` fills the whole bounding box "
                                         "of its leaves; use `unknown: free` if it was not made from a sensor's rays"});
        }
        return;
    }
    if (tree.has_free_leaf && tree.unseen_share > 0) {
        warnings.push_back(
            {key, file + "has no leaf in " + rounded(100 * tree.unseen_share) +
                      " % of the bounding box of its leaves: no sensor saw that space, and it counts as free; "
                      "`unknown: occupied` makes it solid" +
                      (tree.lists_unseen ? "" : ". It has too many pieces to count flights in it")});
    }
}

}  // namespace

std::vector<KeyError> geometry_warnings(const ProblemCheck& check) {
    std::vector<KeyError> warnings;
    std::optional<Region> region;
    std::set<const TriangleMesh*> told;  // several obstacles may have the same file
    const std::vector<Obstacle>& obstacles = check.problem().obstacles;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const auto* mesh = std::get_if<Mesh>(&obstacles[i].shape);
        if (mesh == nullptr && !std::holds_alternative<Octomap>(obstacles[i].shape)) {
            continue;
        }
        const std::string key =
            "environment.obstacles[" + std::to_string(i) + "]" + (mesh != nullptr ? ".mesh.file" : ".octomap.file");
        if (mesh != nullptr && told.insert(mesh->surface.get()).second) {
            add_surface_warnings(*mesh, check.scene()->facts(i), key, warnings);
            add_turned_warning(*mesh, check.scene()->facts(i), key, warnings);
        }
        if (const auto* octomap = std::get_if<Octomap>(&obstacles[i].shape)) {
            add_unseen_warning(*octomap, key, warnings);
        }
        if (!region) {
            region.emplace(check);
        }
        add_place_warning(obstacles[i], key, check.problem().plane, *region, warnings);
    }
    return warnings;
}

}  // namespace downwash
