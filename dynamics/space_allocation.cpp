#include "downwash/dynamics/space_allocation.hpp"

#include <algorithm>
#include <cmath>

namespace downwash {
namespace {

using dynamics::LaneVector;

/// Solves the 4 x 4 system g x = b by Gauss' elimination with pivots.
bool solve(double (&g)[4][4], double (&b)[4]) {
    for (int i = 0; i < 4; ++i) {
        int pivot = i;
        for (int k = i + 1; k < 4; ++k) {
            pivot = std::abs(g[k][i]) > std::abs(g[pivot][i]) ? k : pivot;
        }
        if (!(std::abs(g[pivot][i]) > 1e-9)) {
            return false;
        }
        std::swap(g[i], g[pivot]);
        std::swap(b[i], b[pivot]);
        for (int k = i + 1; k < 4; ++k) {
            const double factor = g[k][i] / g[i][i];
            for (int j = i; j < 4; ++j) {
                g[k][j] -= factor * g[i][j];
            }
            b[k] -= factor * b[i];
        }
    }
    for (int i = 3; i >= 0; --i) {
        for (int j = i + 1; j < 4; ++j) {
            b[i] -= g[i][j] * b[j];
        }
        b[i] /= g[i][i];
    }
    return true;
}

/// The direction of the force of a lift without torque.
LaneVector<double> lift_axis_of(const SpaceAllocation& allocation, const SpaceRotorNumbers<double>* rotors) {
    LaneVector<double> force{0, 0, 0};
    for (int i = 0; i < allocation.rotor_count; ++i) {
        force = force + allocation.share[i][0] * rotors[i].axis;
    }
    const auto without_rounding = [](double side) { return std::abs(side) < 1e-12 ? 0 : side; };
    const LaneVector<double> axis{without_rounding(force.x), without_rounding(force.y), 1};  // the lift is 1
    return (1 / std::sqrt(dot(axis, axis))) * axis;
}

}  // namespace

SpaceAllocation make_space_allocation(int rotor_count, const SpaceRotorNumbers<double>* rotors) {
    SpaceAllocation allocation{};
    allocation.rotor_count = rotor_count;
    allocation.lift_axis = {0, 0, 1};
    double row[4][max_rotors] = {};
    double size[4] = {};
    for (int i = 0; i < rotor_count; ++i) {
        const auto& rotor = rotors[i];
        const LaneVector<double> torque = cross(rotor.position_m, rotor.axis) + rotor.reaction_m * rotor.axis;
        const double column[4] = {rotor.axis.z, torque.x, torque.y, torque.z};
        for (int k = 0; k < 4; ++k) {
            row[k][i] = column[k];
            size[k] += column[k] * column[k];
        }
    }
    // Rows of length 1, so that the rank does not depend on units.
    for (int k = 0; k < 4; ++k) {
        size[k] = std::sqrt(size[k]);
        for (int i = 0; i < rotor_count; ++i) {
            row[k][i] = size[k] > 0 ? row[k][i] / size[k] : 0;
        }
    }
    for (int demand = 0; demand < 4; ++demand) {
        double gram[4][4] = {};
        for (int k = 0; k < 4; ++k) {
            for (int j = 0; j < 4; ++j) {
                for (int i = 0; i < rotor_count; ++i) {
                    gram[k][j] += row[k][i] * row[j][i];
                }
            }
        }
        double weight[4] = {};
        weight[demand] = size[demand] > 0 ? 1 / size[demand] : 0;
        if (!solve(gram, weight)) {
            return SpaceAllocation{false, rotor_count, {}, {0, 0, 1}};
        }
        for (int i = 0; i < rotor_count; ++i) {
            for (int k = 0; k < 4; ++k) {
                allocation.share[i][demand] += row[k][i] * weight[k];
            }
        }
    }
    allocation.has_full_rank = true;
    allocation.lift_axis = lift_axis_of(allocation, rotors);
    return allocation;
}

}  // namespace downwash
