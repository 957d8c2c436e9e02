#include "downwash/scene/self_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "downwash/scene/convex.hpp"

namespace downwash {
namespace {

using std::numbers::pi;

/// Joint angles between limits.
struct JointBox {
    std::array<double, max_links> low_rad{}, high_rad{};

    double middle_rad(std::size_t joint) const { return 0.5 * (low_rad[joint] + high_rad[joint]); }
};

/// Within the limits or a little beyond, and at most one turn of each joint.
JointBox joint_box(const SpaceArm& arm, double beyond_rad) {
    JointBox box;
    for (std::size_t i = 0; i < arm.links(); ++i) {
        const double lower = arm.lower_limit_rad(i) - beyond_rad;
        const double upper = arm.upper_limit_rad(i) + beyond_rad;
        const bool is_whole_turn = !(upper - lower < 2 * pi);
        box.low_rad[i] = is_whole_turn ? -pi : lower;
        box.high_rad[i] = is_whole_turn ? pi : upper;
    }
    return box;
}

/// Two solids on one arm.
class Pair {
 public:
    Pair(const SpaceArm& arm, const SpaceReach& reach, const RobotPiece& first, const RobotPiece& second)
        : arm_(arm), reach_(reach), first_(first), second_(second) {}

    bool touch_always(const JointBox& box) const {
        constexpr int samples = 256;
        for (int n = 0; n < samples; ++n) {
            if (distance_at(angles_in(box, n), contact_m) >= contact_m) {
                return false;
            }
        }
        return true;
    }

    /// Whether they may touch somewhere in a box: false is proven.
    bool may_touch(const JointBox& whole) const {
        constexpr int max_distances = 2000;
        std::vector<JointBox> open{whole};
        for (int n = 0; !open.empty(); ++n) {
            if (n == max_distances) {
                return true;
            }
            const JointBox box = open.back();
            open.pop_back();
            double motion_m = 0, most_m = 0;
            std::size_t widest = first_.frame;
            std::array<double, max_links> middle_rad{};
            for (std::size_t i = first_.frame; i < second_.frame; ++i) {
                const double one_m = 0.5 * (box.high_rad[i] - box.low_rad[i]) * reach_.bodies[second_.frame].joint_m[i];
                motion_m += one_m;
                if (one_m > most_m) {
                    most_m = one_m;
                    widest = i;
                }
                middle_rad[i] = box.middle_rad(i);
            }
            const double apart_m = distance_at(middle_rad, motion_m + 2 * contact_m);
            if (apart_m < contact_m) {
                return true;
            }
            if (apart_m < motion_m + contact_m) {
                JointBox low = box, high = box;
                low.high_rad[widest] = high.low_rad[widest] = box.middle_rad(widest);
                open.push_back(low);
                open.push_back(high);
            }
        }
        return false;
    }

 private:
    /// The n-th of evenly spread angles (Roberts 2018: powers of one number as steps fill a box of six dimensions).
    static std::array<double, max_links> angles_in(const JointBox& box, int n) {
        constexpr double step = 1 / 1.1127756842787055;  // the root of x^7 = x + 1, 7 for max_links + 1
        std::array<double, max_links> angles{};
        double share = 1;
        for (std::size_t i = 0; i < max_links; ++i) {
            share *= step;
            const double whole = 0.5 + n * share;
            angles[i] = box.low_rad[i] + (whole - std::floor(whole)) * (box.high_rad[i] - box.low_rad[i]);
        }
        return angles;
    }

    double distance_at(const std::array<double, max_links>& joints_rad, double enough_m) const {
        const SpaceFrames frames = arm_.frames_seen_from(first_.frame, second_.frame, joints_rad);
        return distance_m(first_.convex, frames[second_.frame].placed(second_.convex), enough_m);
    }

    const SpaceArm& arm_;
    const SpaceReach& reach_;
    const RobotPiece& first_;
    const RobotPiece& second_;
};

/// What a link is mounted on, links without a solid passed over. @param frame of a link
std::size_t carrier_of(std::size_t frame, const SpaceReach& reach) {
    std::size_t carrier = frame - 1;
    while (carrier > 0 && !reach.bodies[carrier].can_touch) {
        --carrier;
    }
    return carrier;
}

}  // namespace

SelfPairs self_pairs(const SpaceArm& arm, const std::vector<RobotPiece>& pieces, const SpaceReach& reach) {
    const JointBox within = joint_box(arm, 0);
    const JointBox swung = joint_box(arm, joint_swing_rad);
    SelfPairs pairs;
    for (std::uint32_t first = 0; first < pieces.size(); ++first) {
        for (std::uint32_t second = first + 1; second < pieces.size(); ++second) {
            const RobotPiece& a = pieces[first];
            const RobotPiece& b = pieces[second];
            if (a.frame == b.frame || carrier_of(b.frame, reach) == a.frame) {
                continue;
            }
            const Pair pair(arm, reach, a, b);
            if (pair.touch_always(within)) {
                continue;
            }
            pairs.beyond_limits.push_back({first, second});
            if (pair.may_touch(swung)) {
                pairs.within_limits.push_back({first, second});
            }
        }
    }
    return pairs;
}

}  // namespace downwash
