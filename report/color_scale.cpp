#include "downwash/report/color_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace downwash {
namespace {

/// Viridis of matplotlib (Smith, van der Walt, Firing 2015) in nine equal steps, from light to dark.
constexpr std::array viridis{color_of(0xfde725), color_of(0xb5de2b), color_of(0x6ece58), color_of(0x35b779),
                             color_of(0x1f9e89), color_of(0x26828e), color_of(0x31688e), color_of(0x3e4989),
                             color_of(0x482878), color_of(0x440154)};

/// The halves of RdBu of ColorBrewer (Brewer 2002), outwards from the middle.
constexpr Color neutral = color_of(0xf7f7f7);
constexpr std::array blues{color_of(0xd1e5f0), color_of(0x92c5de), color_of(0x4393c3), color_of(0x2166ac),
                           color_of(0x053061)};
constexpr std::array reds{color_of(0xfddbc7), color_of(0xf4a582), color_of(0xd6604d), color_of(0xb2182b),
                          color_of(0x67001f)};

/// The i-th of n colours spread evenly over a row of them.
template <std::size_t size>
Color spread(const std::array<Color, size>& row, std::size_t i, std::size_t n) {
    const double place = n == 1 ? 0 : static_cast<double>(i) * (size - 1) / static_cast<double>(n - 1);
    const auto left = std::min(static_cast<std::size_t>(place), size - 2);
    const double part = place - static_cast<double>(left);
    const auto mixed = [&](std::uint8_t a, std::uint8_t b) {
        return static_cast<std::uint8_t>(std::lround(a + part * (b - a)));
    };
    const Color &a = row[left], &b = row[left + 1];
    return {mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue)};
}

/// Limits on both sides of a neutral class: all `steps` above, the first ones of them below.
ColorScale about(double middle, std::string label, const std::vector<double>& steps, std::size_t below) {
    ColorScale scale;
    scale.label = std::move(label);
    for (std::size_t i = below; i-- > 0;) {
        scale.limits.push_back(middle - steps[i]);
    }
    for (const double step : steps) {
        scale.limits.push_back(middle + step);
    }
    for (std::size_t i = below - 1; i-- > 0;) {
        scale.colors.push_back(spread(blues, i, below - 1));
    }
    scale.colors.push_back(neutral);
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        scale.colors.push_back(spread(reds, i, steps.size() - 1));
    }
    return scale;
}

/// The number of classes for values up to `reach`, at least three.
std::size_t steps_up_to(const std::vector<double>& steps, double reach) {
    const auto first = std::lower_bound(steps.begin(), steps.end(), reach * (1 - 1e-9));
    return std::clamp<std::size_t>(static_cast<std::size_t>(first - steps.begin()) + 1, 3, steps.size());
}

/// The smallest 1, 2 or 5 times a power of ten that is not below a step.
double round_step(double step) {
    const double power = std::pow(10, std::floor(std::log10(step)));
    for (const double factor : {1., 2., 5.}) {
        if (factor * power >= step * (1 - 1e-9)) {
            return factor * power;
        }
    }
    return 10 * power;
}

}  // namespace

double position_on(const ColorScale& scale, double value) {
    if (std::isnan(value)) {
        return value;
    }
    const auto& limits = scale.limits;
    if (value <= limits.front()) {
        return 0;
    }
    if (value >= limits.back()) {
        return static_cast<double>(limits.size() - 1);
    }
    const auto upper = std::upper_bound(limits.begin(), limits.end(), value);
    const double low = *(upper - 1);
    return static_cast<double>(upper - limits.begin() - 1) + (value - low) / (*upper - low);
}

ColorScale factor_scale(std::string label, double low, double high) {
    const std::vector<double> steps{0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1, 2, 5, 10, 100};
    std::vector<double> above(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps_up_to(steps, high - 1)));
    constexpr double rounding = 1e-6;  // of maps, which store float
    if (low < 1 - rounding) {
        constexpr std::size_t steps_to_zero = 8;
        const std::size_t below = std::min(steps_up_to(steps, 1 - low), steps_to_zero);
        if (above.size() < below) {
            above.assign(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(below));
        }
        return about(1, std::move(label), above, below);
    }
    ColorScale scale{std::move(label), {1}, {Color{255, 255, 255}}, {}};
    for (const double step : above) {
        scale.limits.push_back(1 + step);
    }
    for (std::size_t i = 0; i + 1 < above.size(); ++i) {
        scale.colors.push_back(spread(viridis, i, above.size() - 1));
    }
    return scale;
}

ColorScale linear_scale(std::string label, double low, double high) {
    constexpr double wanted_classes = 10;
    const double step = round_step((high - low) / wanted_classes);
    ColorScale scale;
    scale.label = std::move(label);
    const double first = std::floor(low / step + 1e-9);
    const double last = std::max(std::ceil(high / step - 1e-9), first + 2);
    for (double i = first; i <= last; ++i) {
        scale.limits.push_back(i * step);
    }
    for (std::size_t i = 0; i + 1 < scale.limits.size(); ++i) {
        scale.colors.push_back(spread(viridis, i, scale.limits.size() - 1));
    }
    return scale;
}

ColorScale signed_scale(std::string label, double reach, int classes) {
    std::vector<double> steps{round_step(reach)};
    while (steps.size() < static_cast<std::size_t>(std::clamp(classes, 2, 8))) {
        const double next = steps.front();
        const double digit = next / std::pow(10, std::floor(std::log10(next) + 1e-9));
        steps.insert(steps.begin(), digit > 4 && digit < 6 ? next * 0.4 : next * 0.5);
    }
    return about(0, std::move(label), steps, steps.size());
}

ColorScale scale_of_kinds(std::string label, std::vector<std::string> names, std::vector<Color> colors) {
    ColorScale scale{std::move(label), {}, std::move(colors), std::move(names)};
    for (std::size_t i = 0; i <= scale.colors.size(); ++i) {
        scale.limits.push_back(static_cast<double>(i) - 0.5);
    }
    return scale;
}

}  // namespace downwash
