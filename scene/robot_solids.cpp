#include "downwash/scene/robot_solids.hpp"

#include <cmath>
#include <iterator>
#include <variant>

namespace downwash {

std::vector<FramedSolid> solids_of(const RobotShape& robot) {
    std::vector<FramedSolid> solids;
    for (const BodyShape& body : robot.bodies) {
        const SpaceShape shape = std::visit([](const auto& primitive) { return SpaceShape(primitive); }, body.shape);
        solids.push_back({{shape, body.center_body_m}, 0});
    }
    solids.push_back({{Capsule{robot.arm_radius_m, {0, 0, 0}, {robot.arm_length_m, 0, 0}}, {}}, 1});
    return solids;
}

std::vector<RobotPiece> pieces_of(const std::vector<FramedSolid>& solids) {
    std::vector<RobotPiece> pieces;
    std::transform(solids.begin(), solids.end(), std::back_inserter(pieces), [](const FramedSolid& framed) {
        return RobotPiece{convex_of(framed.solid), framed.frame};
    });
    return pieces;
}

void inspect(const SpaceBodyShape& solid, const std::string& key, std::vector<KeyError>& errors) {
    struct Inspector {
        const std::string& key;
        std::vector<KeyError>& errors;

        void operator()(const Primitive& primitive) const { inspect(primitive, key, errors); }
        void operator()(const Capsule& capsule) const {
            if (!(std::isfinite(capsule.radius_m) && capsule.radius_m > 0)) {
                errors.push_back({key + ".capsule.radius_m", "must be a finite length above 0 in metres"});
            }
            if (!is_finite(capsule.from_m) || !is_finite(capsule.to_m)) {
                errors.push_back({key + ".capsule", "must have ends of three finite numbers each, in metres"});
            }
        }
    };
    std::visit(Inspector{key, errors}, solid.shape);
    if (!is_finite(solid.center_m)) {
        errors.push_back({key + ".center_m", "must be three finite numbers, in metres"});
    }
}

}  // namespace downwash
