#include "downwash/simulation/space_hover.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/beyond_model.hpp"
#include "downwash/simulation/hover_modes.hpp"
#include "downwash/simulation/linear_loop.hpp"
#include "downwash/simulation/space_hover_loop.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash {
namespace {

using simulation::HoverChange;
using simulation::HoverTick;
using simulation::LatePart;
using simulation::LinearLoops;
using simulation::SpaceHoverLoop;

/// A hover that was linearised, with a loop for each of space_loops.
struct LinearHover {
    LinearLoops loops;
    std::vector<int> used;  ///< the number of the state that each row is
};

/// By central differences. K is linear already, so that the step may be small: 1e-6 leaves an error of some 1e-10.
LinearHover linearised(SpaceHoverLoop& loop) {
    constexpr double step = 1e-6;
    LinearHover linear;
    LinearLoops& found = linear.loops;
    const std::vector<bool> feeds_back = loop.feeds_back();
    for (std::size_t i = 0; i < feeds_back.size(); ++i) {
        if (feeds_back[i]) {
            linear.used.push_back(static_cast<int>(i));
        }
    }
    const auto size = static_cast<Eigen::Index>(linear.used.size());
    HoverTick above, below;
    const auto loops = [&] { return static_cast<Eigen::Index>(above.asked.size()); };
    /// How a tick depends on one number. @param[out] next,asked columns
    const auto differentiate = [&](HoverChange change, auto&& next, auto&& asked) {
        change.by = step;
        loop.tick(change, above);
        change.by = -step;
        loop.tick(change, below);
        for (Eigen::Index row = 0; row < size; ++row) {
            const auto i = static_cast<std::size_t>(linear.used[static_cast<std::size_t>(row)]);
            next(row) = (above.next[i] - below.next[i]) / (2 * step);
        }
        for (Eigen::Index row = 0; row < loops(); ++row) {
            const auto i = static_cast<std::size_t>(row);
            asked(row) = (above.asked[i] - below.asked[i]) / (2 * step);
        }
    };
    loop.tick({}, above);
    found.a.resize(size, size);
    found.b.resize(size, loops());
    found.c.resize(loops(), size);
    for (Eigen::Index column = 0; column < size; ++column) {
        const int number = linear.used[static_cast<std::size_t>(column)];
        differentiate({HoverChange::Of::state, number}, found.a.col(column), found.c.col(column));
    }
    Eigen::VectorXd at_once(loops());  // the law decides before anything is added
    for (Eigen::Index i = 0; i < loops(); ++i) {
        differentiate({HoverChange::Of::loop, static_cast<int>(i)}, found.b.col(i), at_once);
    }
    // The delay lies between two ages.
    const int motion = loop.motion_numbers();
    const int oldest = static_cast<int>(std::ceil(loop.delay_ticks()));
    for (int age = std::max(1, static_cast<int>(std::floor(loop.delay_ticks()))); age <= oldest; ++age) {
        LatePart part{age, Eigen::MatrixXd(size, motion), Eigen::MatrixXd(loops(), motion)};
        for (int i = 0; i < motion; ++i) {
            differentiate({HoverChange::Of::past_motion, i, 0, age}, part.a.col(i), part.c.col(i));
        }
        found.late.push_back(std::move(part));
    }
    return linear;
}

/// Where the slowest mode of a Jacobian shows most, by metres and radians; found by inverse iteration.
/// @param attitude about which the vehicle turns   @param joints number of joints
int slowest_loop(const Eigen::MatrixXd& jacobian, const SpaceHoverStability& stability, double tick_s,
                 const std::array<double, 4>& attitude, int joints) {
    using Complex = std::complex<double>;
    const Complex mode = std::polar(stability.spectral_radius * (1 + 1e-10), stability.frequency_rad_s * tick_s);
    const Eigen::PartialPivLU<Eigen::MatrixXcd> shifted(
        jacobian.cast<Complex>() - mode * Eigen::MatrixXcd::Identity(jacobian.rows(), jacobian.cols()));
    Eigen::VectorXcd v = Eigen::VectorXcd::Ones(jacobian.rows());
    for (int i = 0; i < 3; ++i) {
        v = shifted.solve(v);
        v /= v.norm();
    }
    // A small turn about the body's axes is twice the vector part of the change, seen from the attitude.
    const auto [w, x, y, z] = attitude;
    const Complex scalar = v[3], a = v[4], b = v[5], c = v[6];
    const Complex turn[] = {w * a - x * scalar - (y * c - z * b), w * b - y * scalar - (z * a - x * c),
                            w * c - z * scalar - (x * b - y * a)};
    std::vector<double> sizes;  // by space_loops
    sizes.reserve(static_cast<std::size_t>(space_loops::first_joint + joints));
    for (int i = 0; i < 3; ++i) {
        sizes.push_back(std::abs(v[i]));
    }
    for (const Complex& half : turn) {
        sizes.push_back(2 * std::abs(half));
    }
    for (int i = 0; i < joints; ++i) {
        sizes.push_back(std::abs(v[7 + i]));
    }
    return static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
}

SpaceHoverStability stability_of(SpaceHoverLoop& loop, const LinearHover& linear, const SpaceHoverTrim& trim,
                                 int joints) {
    SpaceHoverStability stability;
    const Eigen::MatrixXd jacobian = simulation::with_past(linear.loops.a, linear.loops.late);
    simulation::find_modes(jacobian, loop.tick_s(), stability);
    if (std::isfinite(stability.spectral_radius)) {
        stability.slowest_loop = slowest_loop(jacobian, stability, loop.tick_s(), trim.motion.attitude, joints);
    }
    const simulation::HoverSlopes slopes = loop.slopes();
    stability.force_slope_n_m = slopes.force_n_m;
    stability.force_gain_n_m = slopes.force_gain_n_m;
    stability.roll_slope_nm_rad = slopes.roll_nm_rad;
    stability.pitch_slope_nm_rad = slopes.pitch_nm_rad;
    return stability;
}

SpacePoint point_with(const std::vector<double>& joints_rad) {
    SpacePoint place;
    std::copy(joints_rad.begin(), joints_rad.end(), place.position + space::first_joint);
    return place;
}

}  // namespace

std::string space_loop_name(int loop) {
    static constexpr const char* names[] = {"x", "y", "height", "roll", "pitch", "yaw"};
    return loop < space_loops::first_joint ? names[loop]
                                           : "joint_" + std::to_string(loop - space_loops::first_joint + 1);
}

struct SpaceHover::Impl {
    const SpaceRobot& robot;
    std::shared_ptr<const Scene> scene;
    AeroSettings aero;
    SpaceChecker checker;
    DirectEffect rotor;  ///< the same for all
};

SpaceHover::SpaceHover(const SpaceRobot& robot, std::shared_ptr<const Scene> scene, const AeroSettings& aero)
    : impl_(new Impl{robot, scene, aero, SpaceChecker(scene, shape_of(robot)),
                     DirectEffect(scene, aero, robot.rotor_radius_m)}) {
    simulation::require_built_joints(robot);
    static_cast<void>(direct_effect());  // its settings are sound
}

SpaceHover::~SpaceHover() = default;

std::unique_ptr<simulation::SpaceEffect> SpaceHover::direct_effect() const {
    return std::make_unique<simulation::DirectSpaceEffect>(impl_->scene, impl_->aero, impl_->robot);
}

SpaceHoverAnalysis SpaceHover::at(const SpacePoint& place, simulation::SpaceEffect& surfaces) const {
    SpaceHoverAnalysis analysis;
    const SpaceRobot& robot = impl_->robot;
    const auto loop =
        simulation::make_space_hover_loop(robot, simulation::space_aero(impl_->aero, robot.rotor_radius_m), surfaces);
    const auto are_all = [&](const auto& meets) {
        const std::vector<Vector3> hubs_m = loop->hubs_m();
        for (std::size_t i = 0; i < hubs_m.size(); ++i) {
            if (!meets(static_cast<int>(i), hubs_m[i])) {
                return false;
            }
        }
        return true;
    };
    loop->stand(place);
    const auto is_flyable = [&](int rotor, const Vector3& hub_m) {
        return surfaces.is_flyable(rotor, {hub_m[0], hub_m[1], hub_m[2]});
    };
    if (!are_all(is_flyable)) {
        return analysis;
    }
    analysis.trim = loop->settle();
    analysis.verdict = HoldVerdict::not_flyable;
    if (!are_all(is_flyable)) {
        return analysis;
    }
    analysis.verdict = HoldVerdict::in_collision;
    const SpaceMotion& motion = analysis.trim.motion;
    if (impl_->checker.is_nearer_than({motion.position_m, motion.attitude, motion.joints_rad}, 0)) {
        return analysis;
    }
    analysis.verdict = HoldVerdict::no_equilibrium;
    if (analysis.trim.limit != HoldLimit::none) {
        return analysis;
    }
    analysis.stability = stability_of(*loop, linearised(*loop), analysis.trim, robot.joints());
    if (!(analysis.stability.spectral_radius < 1 - simulation::radius_slack)) {
        analysis.verdict = HoldVerdict::unstable;
        return analysis;
    }
    const bool is_known =
        are_all([&](int /*rotor*/, const Vector3& hub_m) { return !simulation::is_beyond_model(impl_->rotor, hub_m); });
    analysis.verdict = is_known ? HoldVerdict::stable : HoldVerdict::unknown;
    return analysis;
}

SpaceLoopMargins space_loop_margins(const SpaceRobot& robot, const std::vector<double>& joints_rad) {
    simulation::NoEffectInSpace calm;
    const auto loop = simulation::make_space_hover_loop(robot, {}, calm);
    loop->stand(point_with(joints_rad));
    const SpaceHoverTrim trim = loop->settle();
    SpaceLoopMargins margins;
    std::string why;
    if (trim.limit != HoldLimit::none) {
        why = name_of(trim.limit);
    } else {
        const LinearHover linear = linearised(*loop);
        margins.stability = stability_of(*loop, linear, trim, robot.joints());
        if (margins.stability.spectral_radius < 1 - simulation::radius_slack) {
            margins.loops = simulation::margins_of(linear.loops, loop->tick_s());
        } else {
            why = "the loop is unstable, most of all in " + space_loop_name(margins.stability.slowest_loop);
        }
    }
    if (!why.empty()) {
        throw_input_error("cannot hover in free air" +
                              (joints_rad.empty() ? "" : " with its joints at " + joints_text(joints_rad) + " deg") +
                              ": " + why,
                          "controller");
    }
    return margins;
}

std::vector<ExaminedPose> examined_poses(const SpaceRobot& robot) {
    ExaminedPose zero{"zero", {}};
    for (const SpaceLinkLimits& link : robot.links) {
        zero.joints_rad.push_back(link.is_limited ? std::clamp(0.0, link.lower_limit_rad, link.upper_limit_rad) : 0.0);
    }
    std::vector<ExaminedPose> poses{zero};
    if (robot.joints() == 0) {
        return poses;
    }
    WorstPose aside;
    for (const Vector3& way : {Vector3{1, 0, 0}, Vector3{-1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, -1, 0}}) {
        const WorstPose worst = worst_pose(robot, [&](const std::vector<double>& joints_rad) {
            return dot(way, center_of_mass_m(robot, arm_pose(robot, joints_rad)));
        });
        constexpr double rounding_m = 1e-9;
        if (aside.joints_rad.empty() || worst.value > aside.value + rounding_m) {
            aside = worst;
        }
    }
    const auto highest = [&](double sign) {
        return worst_pose(robot, [&](const std::vector<double>& joints_rad) {
            return sign * center_of_mass_m(robot, arm_pose(robot, joints_rad))[2];
        });
    };
    poses.push_back({"aside", aside.joints_rad});
    poses.push_back({"up", highest(1).joints_rad});
    poses.push_back({"down", highest(-1).joints_rad});
    return poses;
}

namespace simulation {

bool find_root(const std::function<void(const std::vector<double>& x, std::vector<double>& f)>& f,
               std::vector<double>& x) {
    constexpr int most_rounds = 30;
    constexpr double step = 1e-6, enough = 1e-9;
    const auto size = static_cast<Eigen::Index>(x.size());
    Eigen::MatrixXd slope(size, size);
    std::vector<double> here, there;
    const auto vector = [](const std::vector<double>& v) {
        return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
    };
    for (int round = 0; round < most_rounds; ++round) {
        f(x, here);
        const Eigen::VectorXd off = vector(here);
        if (!off.allFinite()) {
            return false;
        }
        if (off.cwiseAbs().maxCoeff() < enough) {
            return true;
        }
        for (Eigen::Index i = 0; i < size; ++i) {
            std::vector<double> changed = x;
            changed[static_cast<std::size_t>(i)] += step;
            f(changed, there);
            slope.col(i) = (vector(there) - off) / step;
        }
        const Eigen::VectorXd change = slope.partialPivLu().solve(off);
        if (!change.allFinite()) {
            return false;
        }
        for (Eigen::Index i = 0; i < size; ++i) {
            x[static_cast<std::size_t>(i)] -= change[i];
        }
    }
    return false;
}

template <int n>
std::unique_ptr<SpaceHoverLoop> make_space_hover_loop_of(const SpaceRobot& robot, const SpaceAero& aero,
                                                         SpaceEffect& surfaces);

namespace {

template <int... n>
std::unique_ptr<SpaceHoverLoop> made(const SpaceRobot& robot, const SpaceAero& aero, SpaceEffect& surfaces,
                                     std::integer_sequence<int, n...> /*built*/) {
    using Make = std::unique_ptr<SpaceHoverLoop> (*)(const SpaceRobot&, const SpaceAero&, SpaceEffect&);
    static constexpr Make make[] = {&make_space_hover_loop_of<n>...};
    return make[robot.joints()](robot, aero, surfaces);
}

}  // namespace

std::unique_ptr<SpaceHoverLoop> make_space_hover_loop(const SpaceRobot& robot, const SpaceAero& aero,
                                                      SpaceEffect& surfaces) {
    require_built_joints(robot);
    return made(robot, aero, surfaces, std::make_integer_sequence<int, DOWNWASH_MAX_JOINTS + 1>());
}

}  // namespace simulation
}  // namespace downwash
