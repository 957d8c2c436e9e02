#include "downwash/simulation/space_effect_slope.hpp"

#include "downwash/simulation/effect_slope.hpp"

namespace downwash::simulation {
namespace {

std::array<double, 2> numbers_of(const SidedFactor<double>& factor) {
    return {factor.all, factor.above};
}

}  // namespace

template <std::size_t size, class Ask>
LinearSpaceEffect::Tangent<size> LinearSpaceEffect::tangent(const dynamics::LaneVector<double>& at_m, const Ask& ask) {
    constexpr double h = slope_step_m;
    Tangent<size> result;
    result.at_m = at_m;
    result.value = ask(at_m);
    for (double dynamics::LaneVector<double>::*axis :
         {&dynamics::LaneVector<double>::x, &dynamics::LaneVector<double>::y, &dynamics::LaneVector<double>::z}) {
        dynamics::LaneVector<double> to = at_m, from = at_m;
        to.*axis += h;
        from.*axis -= h;
        const std::array<double, size> after = ask(to), before = ask(from);
        for (std::size_t i = 0; i < size; ++i) {
            result.slope_1_m[i].*axis = (after[i] - before[i]) / (2 * h);
        }
    }
    return result;
}

LinearSpaceEffect::LinearSpaceEffect(SpaceEffect& surfaces, const AskedPlaces& places) {
    const auto of_rotors = [&](const std::vector<dynamics::LaneVector<double>>& hubs_m) {
        std::vector<Tangent<2>> tangents;
        for (const dynamics::LaneVector<double>& hub_m : hubs_m) {
            const int rotor = static_cast<int>(tangents.size());
            tangents.push_back(
                tangent<2>(hub_m, [&](const auto& at_m) { return numbers_of(surfaces.at_rotor(rotor, at_m)); }));
        }
        return tangents;
    };
    rotor_ = of_rotors(places.hub_m);
    read_ = of_rotors(places.read_hub_m);
    if (places.has_fountain) {
        body_ = tangent<2>(places.center_m, [&](const auto& at_m) { return numbers_of(surfaces.at_body(at_m)); });
    }
    if (places.has_walls) {
        walls_ = tangent<3>(places.center_m, [&](const auto& at_m) {
            const dynamics::LaneVector<double> towards = surfaces.wall_nearness(at_m);
            return std::array<double, 3>{towards.x, towards.y, towards.z};
        });
    }
}

SidedFactor<double> LinearSpaceEffect::at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) {
    const auto i = static_cast<std::size_t>(rotor);
    const auto off_m = [&](const Tangent<2>& tangent) { return dot(hub_m - tangent.at_m, hub_m - tangent.at_m); };
    // A law whose map is displaced asks beside the rotor.
    const bool is_read = !read_.empty() && off_m(read_[i]) < off_m(rotor_[i]);
    const Tangent<2>& nearest = is_read ? read_[i] : rotor_[i];
    return {nearest(0, hub_m), nearest(1, hub_m)};
}

SidedFactor<double> LinearSpaceEffect::at_body(const dynamics::LaneVector<double>& center_m) {
    return {body_(0, center_m), body_(1, center_m)};
}

dynamics::LaneVector<double> LinearSpaceEffect::wall_nearness(const dynamics::LaneVector<double>& center_m) {
    return {walls_(0, center_m), walls_(1, center_m), walls_(2, center_m)};
}

}  // namespace downwash::simulation
