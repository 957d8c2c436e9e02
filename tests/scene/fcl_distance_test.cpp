// Why clearances do not come from FCL: its distances (0.7) between separated solids are off by millimetres, where a
// safety margin is fifty. Should this test ever fail, FCL has mended them and could take over.

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "reference.hpp"

namespace {

fcl::Transform3d pose_of(const reference::Solid& solid) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            pose.linear()(row, column) = solid.axes[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
        }
    }
    for (int row = 0; row < 3; ++row) {
        pose.translation()[row] = solid.center_m[static_cast<std::size_t>(row)];
    }
    return pose;
}

double fcl_distance(const reference::Solid& box, const reference::Solid& cylinder) {
    const fcl::Boxd first(2 * box.half_m[0], 2 * box.half_m[1], 2 * box.half_m[2]);
    const fcl::Cylinderd second(cylinder.half_m[0], 2 * cylinder.half_m[2]);
    fcl::DistanceResultd result;
    return fcl::distance(&first, pose_of(box), &second, pose_of(cylinder), fcl::DistanceRequestd(), result);
}

reference::Solid solid(reference::Dice& dice, const downwash::Shape& shape) {
    downwash::Obstacle obstacle;
    obstacle.shape = shape;
    obstacle.center_m = dice.vector(-1, 1);
    obstacle.rpy_rad = dice.vector(-3, 3);
    return reference::solid_of(obstacle);
}

}  // namespace

TEST_CASE("FCL's distances between boxes and cylinders are off by more than a millimetre") {
    reference::Dice dice(1);
    double worst_m = 0;
    for (int i = 0; i < 3000; ++i) {
        const reference::Solid box = solid(dice, downwash::Box{dice.vector(0.05, 1)});
        const reference::Solid cylinder =
            solid(dice, downwash::Cylinder{dice.between(0.05, 0.5), dice.between(0.05, 1), {0, 0, 1}});
        const reference::Enclosure truth = reference::distance(box, cylinder);
        if (truth.low > 0.01 && truth.high - truth.low < 1e-6) {
            const double measured_m = fcl_distance(box, cylinder);
            worst_m = std::max({worst_m, truth.low - measured_m, measured_m - truth.high});
        }
    }
    CAPTURE(worst_m);
    CHECK(worst_m > 1e-3);
}
