#include "downwash/simulation/space_effect_slope.hpp"

#include "downwash/simulation/effect_slope.hpp"

namespace downwash::simulation {
namespace {

using Vector = dynamics::LaneVector<double>;

/// A turn by a small vector, of which squares count as well.
dynamics::LaneRotation<double> small_turn(const Vector& turn_rad) {
    const double q[] = {1, 0.5 * turn_rad.x, 0.5 * turn_rad.y, 0.5 * turn_rad.z};
    return dynamics::rotation_of(q);
}

std::array<double, 2> numbers_of(const SidedFactor<double>& factor) {
    return {factor.all, factor.above};
}

}  // namespace

template <std::size_t size, class Ask>
LinearSpaceEffect::Tangent<size> LinearSpaceEffect::tangent(const Vector& at_m, const Ask& ask) {
    constexpr double h = slope_step_m;
    Tangent<size> result;
    result.at_m = at_m;
    result.value = ask(at_m, Vector{});
    for (double Vector::*axis : {&Vector::x, &Vector::y, &Vector::z}) {
        Vector step{};
        step.*axis = h;
        const Vector none{};
        const auto after = ask(at_m + step, none), before = ask(at_m - step, none);
        const auto turned = ask(at_m, step), turned_back = ask(at_m, none - step);
        for (std::size_t i = 0; i < size; ++i) {
            result.slope_1_m[i].*axis = (after[i] - before[i]) / (2 * h);
            result.slope_1_rad[i].*axis = (turned[i] - turned_back[i]) / (2 * h);
        }
    }
    return result;
}

LinearSpaceEffect::LinearSpaceEffect(SpaceEffect& surfaces, const AskedPlaces& places) : attitude_(places.attitude) {
    const auto turned = [&](const Vector& turn_rad) { return attitude_ * small_turn(turn_rad); };
    const auto of_rotors = [&](const std::vector<Vector>& hubs_m) {
        std::vector<Tangent<2>> tangents;
        for (const Vector& hub_m : hubs_m) {
            const int rotor = static_cast<int>(tangents.size());
            tangents.push_back(tangent<2>(hub_m, [&](const Vector& at_m, const Vector& turn_rad) {
                return numbers_of(surfaces.at_turned_rotor(rotor, at_m, turned(turn_rad)));
            }));
        }
        return tangents;
    };
    rotor_ = of_rotors(places.hub_m);
    read_ = of_rotors(places.read_hub_m);
    if (places.has_fountain) {
        body_ = tangent<2>(places.center_m, [&](const Vector& at_m, const Vector& turn_rad) {
            return numbers_of(surfaces.at_turned_body(at_m, turned(turn_rad)));
        });
    }
    if (places.has_walls) {
        walls_ = tangent<3>(places.center_m, [&](const Vector& at_m, const Vector& /*turn_rad*/) {
            const Vector towards = surfaces.wall_nearness(at_m);
            return std::array<double, 3>{towards.x, towards.y, towards.z};
        });
    }
}

Vector LinearSpaceEffect::turn_rad(const dynamics::LaneRotation<double>& attitude) const {
    const auto& [x, y, z] = attitude_;
    return 0.5 * Vector{dot(z, attitude.second) - dot(y, attitude.third),
                        dot(x, attitude.third) - dot(z, attitude.first),
                        dot(y, attitude.first) - dot(x, attitude.second)};
}

SidedFactor<double> LinearSpaceEffect::at_rotor(int rotor, const Vector& hub_m) {
    return at_turned_rotor(rotor, hub_m, attitude_);
}

SidedFactor<double> LinearSpaceEffect::at_body(const Vector& center_m) {
    return at_turned_body(center_m, attitude_);
}

SidedFactor<double> LinearSpaceEffect::at_turned_rotor(int rotor, const Vector& hub_m,
                                                       const dynamics::LaneRotation<double>& attitude) {
    const auto i = static_cast<std::size_t>(rotor);
    const auto off_m = [&](const Tangent<2>& tangent) { return dot(hub_m - tangent.at_m, hub_m - tangent.at_m); };
    // A law whose map is displaced asks beside the rotor.
    const bool is_read = !read_.empty() && off_m(read_[i]) < off_m(rotor_[i]);
    const Tangent<2>& nearest = is_read ? read_[i] : rotor_[i];
    const Vector turn = turn_rad(attitude);
    return {nearest(0, hub_m, turn), nearest(1, hub_m, turn)};
}

SidedFactor<double> LinearSpaceEffect::at_turned_body(const Vector& center_m,
                                                      const dynamics::LaneRotation<double>& attitude) {
    const Vector turn = turn_rad(attitude);
    return {body_(0, center_m, turn), body_(1, center_m, turn)};
}

Vector LinearSpaceEffect::wall_nearness(const Vector& center_m) {
    return {walls_(0, center_m), walls_(1, center_m), walls_(2, center_m)};
}

}  // namespace downwash::simulation
