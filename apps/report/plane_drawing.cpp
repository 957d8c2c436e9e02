#include "downwash/report/plane_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "downwash/report/figure_colors.hpp"

namespace downwash {

std::string short_name(const std::string& name) {
    const std::string last = name.substr(name.rfind(' ') + 1);
    return last.find_first_not_of("0123456789") == std::string::npos ? last : name;
}

double RobotDrawing::width_m() const {
    double low_m = 0, high_m = 0;
    for (const Vector3& hub_m : robot_.rotors.positions_m) {
        low_m = std::min(low_m, hub_m[0] - robot_.rotors.radius_m);
        high_m = std::max(high_m, hub_m[0] + robot_.rotors.radius_m);
    }
    return high_m - low_m;
}

void RobotDrawing::add_to(std::vector<Ring>& lines, double x_m, double z_m, double pitch_rad, double arm_rad) const {
    const double sine = std::sin(pitch_rad), cosine = std::cos(pitch_rad);
    const auto placed = [&](double forward_m, double up_m) {
        return PlanePoint{x_m + forward_m * cosine + up_m * sine, z_m - forward_m * sine + up_m * cosine};
    };
    for (const auto& body : bodies_) {
        auto& ring = lines.emplace_back();
        for (const PlanePoint& corner : body) {
            ring.push_back(placed(corner.x_m, corner.z_m));
        }
        ring.push_back(ring.front());
    }
    for (const Vector3& hub_m : robot_.rotors.positions_m) {
        lines.push_back(
            {placed(hub_m[0] - robot_.rotors.radius_m, hub_m[2]), placed(hub_m[0] + robot_.rotors.radius_m, hub_m[2])});
    }
    const PlanePoint joint = placed(robot_.arm.joint_x_m, robot_.arm.joint_z_m);
    const double direction_rad = pitch_rad + arm_rad;
    lines.push_back({joint,
                     {joint.x_m + robot_.arm.length_m * std::cos(direction_rad),
                      joint.z_m - robot_.arm.length_m * std::sin(direction_rad)}});
}

std::vector<FigurePoints> goal_points(const Problem& problem, const std::vector<std::string>& names) {
    FigurePoints goals{"goal of the end effector", {}, goal_color};
    std::size_t number = 0;
    for (const Goal& visited : goals_of(problem)) {
        const std::string& name = names[number++];
        for (const Goal& goal : alternatives(visited)) {
            const GoalDrawing drawing = drawing_of(goal);
            if (part_of(goal) != GoalPart::end_effector || !drawing.outline.empty()) {
                continue;
            }
            goals.points.push_back({drawing.x_m.value(), drawing.z_m.value()});
            if (names.size() > 1) {
                goals.labels.push_back(short_name(name));
            }
        }
    }
    if (goals.points.empty()) {
        return {};
    }
    return {std::move(goals)};
}

std::vector<Ring> goal_regions(const Problem& problem) {
    constexpr int corners = 36;
    std::vector<Ring> regions;
    for (const Goal& visited : goals_of(problem)) {
        for (const Goal& goal : alternatives(visited)) {
            if (part_of(goal) != GoalPart::end_effector) {
                continue;
            }
            const GoalDrawing drawing = drawing_of(goal);
            for (const std::vector<PlaneVector>& line : drawing.outline) {
                for (Ring& ring = regions.emplace_back(); const PlaneVector& point : line) {
                    ring.push_back({point.x, point.z});
                }
            }
            if (!drawing.outline.empty()) {
                continue;
            }
            const double x_m = drawing.x_m.value(), z_m = drawing.z_m.value();
            const GoalTolerance tolerance = tolerance_of(goal);
            Ring region;
            for (int i = 0; i <= corners && tolerance.is_disc; ++i) {
                const double angle_rad = 2 * std::numbers::pi * (i % corners) / corners;
                region.push_back(
                    {x_m + tolerance.x_m * std::cos(angle_rad), z_m + tolerance.z_m * std::sin(angle_rad)});
            }
            for (int i = 0; i <= 4 && !tolerance.is_disc; ++i) {
                const double side_x = i % 4 == 0 || i % 4 == 3 ? -1 : 1;
                const double side_z = i % 4 < 2 ? -1 : 1;
                region.push_back({x_m + side_x * tolerance.x_m, z_m + side_z * tolerance.z_m});
            }
            regions.push_back(std::move(region));
        }
    }
    return regions;
}

void widen_to_scale(Bounds& extent) {
    constexpr double max_ratio = 4;
    const auto widen = [](double& low, double& high, double other_side) {
        const double lacking_m = other_side / max_ratio - (high - low);
        if (lacking_m > 0) {
            low -= lacking_m / 2;
            high += lacking_m / 2;
        }
    };
    widen(extent.z_low_m, extent.z_high_m, extent.x_high_m - extent.x_low_m);
    widen(extent.x_low_m, extent.x_high_m, extent.z_high_m - extent.z_low_m);
}

}  // namespace downwash
