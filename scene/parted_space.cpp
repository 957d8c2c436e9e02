#include "downwash/scene/parted_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>
#include <set>
#include <unordered_map>

#include "downwash/scene/space_checker.hpp"

namespace downwash {
namespace {

constexpr double side_share = 0.7;
/// Of the radius: a centre within a cube is this much nearer to its middle than to an obstacle, and rounding.
constexpr double middle_share = 1 - side_share * 0.8660254037844387 - 1e-6;

using Cube = std::array<std::int64_t, 3>;

/// Two fronts of cubes that grow toward each other.
class Fronts {
 public:
    Fronts(const std::shared_ptr<const Scene>& scene, const SpaceBounds& bounds, double radius_m)
        : bounds_(bounds),
          side_m_(side_share * radius_m),
          ball_(scene, {{{Sphere{middle_share * radius_m}, {}}}, {}}) {}

    [[nodiscard]] Cube cube_at(const Vector3& at_m) const {
        Cube cube{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cube[axis] = static_cast<std::int64_t>(std::floor((at_m[axis] - bounds_.low_m[axis]) / side_m_));
        }
        return cube;
    }

    void begin(std::size_t front, const Cube& cube) { add(front, cube); }

    /// Where the cubes of a front should go first.
    void aim(std::size_t front, const Cube& cube) { toward_[front] = cube; }

    /// Takes the next cube of a front. @return false if it has none
    bool grow(std::size_t front) {
        if (open_[front].empty()) {
            return false;
        }
        const Cube cube = open_[front].top().cube;
        open_[front].pop();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const std::int64_t step : {-1, 1}) {
                Cube next = cube;
                next[axis] += step;
                if (is_inside(next, axis)) {
                    add(front, next);
                }
            }
        }
        return true;
    }

    [[nodiscard]] bool have_met() const noexcept { return have_met_; }
    [[nodiscard]] std::size_t cubes() const noexcept { return seen_.size(); }
    /// Obstacles that stop a front.
    [[nodiscard]] const std::set<std::size_t>& obstacles(std::size_t front) const noexcept { return stops_[front]; }

 private:
    struct Open {
        std::int64_t far;
        Cube cube;
        bool operator<(const Open& other) const { return far != other.far ? far > other.far : cube > other.cube; }
    };

    [[nodiscard]] bool is_inside(const Cube& cube, std::size_t axis) const {
        const double low_m = static_cast<double>(cube[axis]) * side_m_;
        return low_m + side_m_ >= 0 && low_m <= bounds_.high_m[axis] - bounds_.low_m[axis];
    }

    void add(std::size_t front, const Cube& cube) {
        std::uint64_t key = 0;
        for (const std::int64_t number : cube) {
            key = key << 21U | static_cast<std::uint64_t>(number & 0x1fffff);
        }
        const auto [found, is_new] = seen_.emplace(key, static_cast<std::uint8_t>(front));
        if (!is_new) {
            have_met_ = have_met_ || (found->second != front && found->second < blocked);
            if (found->second == blocked) {
                note_stop(front, cube);
            }
            return;
        }
        if (ball_.is_nearer_than(pose_of(cube), 0)) {
            found->second = blocked;
            note_stop(front, cube);
            return;
        }
        std::int64_t far = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            far += std::abs(cube[axis] - toward_[front][axis]);
        }
        open_[front].push({far, cube});
    }

    void note_stop(std::size_t front, const Cube& cube) {
        if (const auto obstacle = ball_.nearest_obstacle(pose_of(cube), side_m_)) {
            stops_[front].insert(*obstacle);
        }
    }

    [[nodiscard]] SpacePose pose_of(const Cube& cube) const {
        SpacePose pose;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose.position_m[axis] = bounds_.low_m[axis] + (static_cast<double>(cube[axis]) + 0.5) * side_m_;
        }
        return pose;
    }

    static constexpr std::uint8_t blocked = 2;
    SpaceBounds bounds_;
    double side_m_;
    SpaceChecker ball_;
    std::unordered_map<std::uint64_t, std::uint8_t> seen_;
    std::array<std::priority_queue<Open>, 2> open_;
    std::array<Cube, 2> toward_{};
    std::array<std::set<std::size_t>, 2> stops_;
    bool have_met_ = false;
};

}  // namespace

std::optional<BallWay> way_of_ball(const std::shared_ptr<const Scene>& scene, const SpaceBounds& bounds,
                                   double radius_m, const Vector3& from_m, std::span<const Vector3> to_m,
                                   std::size_t max_cubes) {
    if (to_m.empty()) {
        return BallWay{};
    }
    Fronts fronts(scene, bounds, radius_m);
    fronts.aim(0, fronts.cube_at(to_m.front()));
    fronts.aim(1, fronts.cube_at(from_m));
    fronts.begin(0, fronts.cube_at(from_m));
    for (const Vector3& to : to_m) {
        fronts.begin(1, fronts.cube_at(to));
    }
    while (!fronts.have_met()) {
        for (const std::size_t front : {std::size_t{0}, std::size_t{1}}) {
            if (!fronts.grow(front) && !fronts.have_met()) {
                const std::set<std::size_t>& stops = fronts.obstacles(front);
                return BallWay{true, {stops.begin(), stops.end()}};
            }
        }
        if (fronts.cubes() > max_cubes) {
            return std::nullopt;
        }
    }
    return BallWay{};
}

}  // namespace downwash
