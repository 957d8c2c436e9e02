#include "downwash/exports/setpoint_remedies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr double whole_turn_rad = 2 * std::numbers::pi;
/// Of rates that fit, while their integral does not.
constexpr char sparse_remedy[] = "; each fits at its own time: are they too far apart to be integrated?";

/// Whether expected is what a function makes of what was found, everywhere.
template <class Value, class Change, class Distance>
bool fit(const std::vector<Value>& found, const std::vector<Value>& expected, double tolerance, const Change& change,
         const Distance& distance) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!(distance(change(found[i]), expected[i]) <= tolerance)) {
            return false;
        }
    }
    return true;
}

double distance_of(const Vector3& a, const Vector3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double turned_distance_of(double a, double b) {
    return std::abs(std::remainder(a - b, whole_turn_rad));
}

double plain_distance_of(double a, double b) {
    return std::abs(a - b);
}

std::string degrees_text(double angle_rad) {
    return to_fixed_text(angle_rad * degrees_per_radian, 1) + " degrees";
}

/// The angle about z that brings vectors nearest to others.
double turn_between(const std::vector<Vector3>& found, const std::vector<Vector3>& expected) {
    double sine = 0, cosine = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        sine += found[i][0] * expected[i][1] - found[i][1] * expected[i][0];
        cosine += found[i][0] * expected[i][0] + found[i][1] * expected[i][1];
    }
    return std::atan2(sine, cosine);
}

/// An order of axes, each with a sign.
struct SignedAxes {
    std::array<std::size_t, 3> order{0, 1, 2};
    unsigned negative = 0;  ///< a bit for each

    [[nodiscard]] Vector3 operator()(const Vector3& v) const {
        const auto of = [&](std::size_t i) { return (negative >> i & 1U) != 0 ? -v[order[i]] : v[order[i]]; };
        return {of(0), of(1), of(2)};
    }
    [[nodiscard]] std::string text() const {
        constexpr std::array names{"x", "y", "z"};
        std::string text;
        for (std::size_t i = 0; i < order.size(); ++i) {
            text += std::string(i > 0 ? ", " : "(") + ((negative >> i & 1U) != 0 ? "-" : "") + names[order[i]];
        }
        return text + ")";
    }
};

/// Those of fewer changes first.
std::optional<SignedAxes> axes_that_fit(const std::vector<Vector3>& found, const std::vector<Vector3>& expected,
                                        double tolerance) {
    SignedAxes axes;
    do {
        for (axes.negative = 0; axes.negative < 8; ++axes.negative) {
            if (fit(found, expected, tolerance, axes, distance_of)) {
                return axes;
            }
        }
    } while (std::ranges::next_permutation(axes.order).found);
    return std::nullopt;
}

}  // namespace

std::string axes_remedy(const std::vector<Vector3>& found, const std::vector<Vector3>& expected, double tolerance,
                        bool may_be_shifted) {
    if (fit(found, expected, tolerance, std::identity(), distance_of)) {
        return sparse_remedy;
    }
    const Vector3 shift = expected.front() - found.front();
    if (may_be_shifted && fit(
                              found, expected, tolerance, [&](const Vector3& v) { return v + shift; }, distance_of)) {
        return "; all would fit if shifted by (" +
               joined(shift, ", ", [](double coordinate) { return to_fixed_text(coordinate, 2); }) +
               ") m: is the origin another one?";
    }
    const double turn_rad = turn_between(found, expected);
    const double sine = std::sin(turn_rad), cosine = std::cos(turn_rad);
    const auto turned = [&](const Vector3& v) {
        return Vector3{cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]};
    };
    if (fit(found, expected, tolerance, turned, distance_of)) {
        return "; all would fit if turned by " + degrees_text(turn_rad) + " about z: is --bearing another one?";
    }
    const auto axes = axes_that_fit(found, expected, tolerance);
    return axes ? "; all would fit as " + axes->text() + ": are these the axes of the format?" : "";
}

std::string angle_remedy(const std::vector<double>& found, const std::vector<double>& expected, double tolerance_rad) {
    const double turn_rad = std::remainder(expected.front() - found.front(), whole_turn_rad);
    if (fit(
            found, expected, tolerance_rad, [&](double angle) { return angle + turn_rad; }, turned_distance_of)) {
        return "; all would fit if turned by " + degrees_text(turn_rad) + ": from which axis do they count?";
    }
    if (fit(
            found, expected, tolerance_rad, [](double angle) { return -angle; }, turned_distance_of)) {
        return "; all would fit with the other sign";
    }
    // Both: east for north, and counterclockwise for clockwise.
    const double mirrored_rad = std::remainder(expected.front() + found.front(), whole_turn_rad);
    if (fit(
            found, expected, tolerance_rad, [&](double angle) { return mirrored_rad - angle; }, turned_distance_of)) {
        return "; all would fit with the other sign and turned by " + degrees_text(mirrored_rad) +
               ": from which axis do they count?";
    }
    return fit(
               found, expected, tolerance_rad, [](double angle) { return angle / degrees_per_radian; },
               turned_distance_of)
               ? "; all would fit as degrees: expected radians"
               : "";
}

std::string rate_remedy(const std::vector<double>& found, const std::vector<double>& expected, double tolerance) {
    if (fit(found, expected, tolerance, std::identity(), plain_distance_of)) {
        return sparse_remedy;
    }
    if (fit(
            found, expected, tolerance, [](double number) { return -number; }, plain_distance_of)) {
        return "; all would fit with the other sign";
    }
    return fit(
               found, expected, tolerance, [](double number) { return number / degrees_per_radian; }, plain_distance_of)
               ? "; all would fit as degrees: expected radians"
               : "";
}

}  // namespace downwash
