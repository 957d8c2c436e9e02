#include "downwash/report/color_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace downwash {
namespace {

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

constexpr double factor_rounding = 1e-6;  // of given maps, which may store float

/// The classes of thrust ratios away from 1, as distances from it. The colours are fixed: each class has its own in
/// every picture. Blues and YlOrBr of ColorBrewer (Brewer 2002), told apart by people who do not tell red from green.
struct FactorClass {
    double from, to;
    Color color;
};
constexpr std::array above_one{FactorClass{0.01, 0.02, color_of(0xc6dbef)}, FactorClass{0.02, 0.05, color_of(0x9ecae1)},
                               FactorClass{0.05, 0.1, color_of(0x6baed6)},  FactorClass{0.1, 0.2, color_of(0x4292c6)},
                               FactorClass{0.2, 0.3, color_of(0x2171b5)},   FactorClass{0.3, 0.5, color_of(0x08519c)},
                               FactorClass{0.5, 1, color_of(0x08306b)},     FactorClass{1, 2, color_of(0x062350)},
                               FactorClass{2, 5, color_of(0x04183a)},       FactorClass{5, 10, color_of(0x020d21)},
                               FactorClass{10, 100, color_of(0x000000)}};
constexpr std::array below_one{FactorClass{0.01, 0.02, color_of(0xfee391)}, FactorClass{0.02, 0.05, color_of(0xfec44f)},
                               FactorClass{0.05, 0.1, color_of(0xfe9929)},  FactorClass{0.1, 0.2, color_of(0xec7014)},
                               FactorClass{0.2, 0.3, color_of(0xcc4c02)},   FactorClass{0.3, 0.5, color_of(0x993404)},
                               FactorClass{0.5, 1, color_of(0x662506)}};
constexpr std::size_t usual_classes_above = 7;  // up to 2, the default of aero.max_factor

/// The number of classes that reach to a distance from 1.
template <std::size_t size>
std::size_t classes_up_to(const std::array<FactorClass, size>& classes, double distance) {
    const auto last = std::find_if(classes.begin(), classes.end() - 1, [distance](const FactorClass& factors) {
        return factors.to >= distance - factor_rounding;
    });
    return static_cast<std::size_t>(last - classes.begin()) + 1;
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

ColorScale factor_scale(std::string label, const AxisRange& range) {
    const bool has_below = range.low < 1 - factor_rounding;
    const std::size_t below = has_below ? classes_up_to(below_one, 1 - range.low) : 0;
    const std::size_t above = std::max(usual_classes_above, classes_up_to(above_one, range.high - 1));
    ColorScale scale;
    scale.label = std::move(label);
    for (std::size_t i = below; i-- > 0;) {
        scale.limits.push_back(1 - below_one[i].to);
        scale.colors.push_back(below_one[i].color);
    }
    scale.limits.push_back(has_below ? 1 - below_one[0].from : 1);
    scale.colors.push_back({255, 255, 255});
    for (std::size_t i = 0; i < above; ++i) {
        scale.limits.push_back(1 + above_one[i].from);
        scale.colors.push_back(above_one[i].color);
    }
    scale.limits.push_back(1 + above_one[above - 1].to);
    scale.neutral = 1;
    return scale;
}

ColorScale signed_scale(std::string label, double reach, int classes) {
    std::vector<double> steps{round_step(reach)};
    while (steps.size() < static_cast<std::size_t>(std::clamp(classes, 2, 8))) {
        const double next = steps.front();
        const double digit = next / std::pow(10, std::floor(std::log10(next) + 1e-9));
        steps.insert(steps.begin(), digit > 4 && digit < 6 ? next * 0.4 : next * 0.5);
    }
    const std::size_t size = steps.size();
    ColorScale scale;
    scale.label = std::move(label);
    scale.limits.resize(2 * size);
    scale.colors.resize(2 * size - 1, neutral);
    scale.neutral = 0;
    for (std::size_t i = 0; i < size; ++i) {
        scale.limits[size - 1 - i] = -steps[i];
        scale.limits[size + i] = steps[i];
    }
    for (std::size_t i = 0; i + 1 < size; ++i) {
        scale.colors[size - 2 - i] = spread(blues, i, size - 1);
        scale.colors[size + i] = spread(reds, i, size - 1);
    }
    return scale;
}

ColorScale scale_of_kinds(std::string label, std::vector<std::string> names, std::vector<Color> colors) {
    ColorScale scale{std::move(label), {}, std::move(colors), std::move(names)};
    for (std::size_t i = 0; i <= scale.colors.size(); ++i) {
        scale.limits.push_back(static_cast<double>(i) - 0.5);
    }
    return scale;
}

}  // namespace downwash
