#pragma once

#include "downwash/dynamics/arm_wash.hpp"
#include "downwash/dynamics/space_loads.hpp"
#include "downwash/dynamics/space_slipstreams.hpp"

// What the slipstreams of the rotors do to the links of an arm in space (docs/model.md 2.9), one template over the lane
// type. The plane has arm_wash.hpp, whose slipstreams these are.

namespace downwash::dynamics {

/// The slipstream of one rotor beside a link, both straight: what it needs at s metres from the link's joint is linear
/// in s.
template <class T>
struct SlipstreamAtLink {
    LaneVector<T> axis;                              ///< of the rotor, body axes
    T depth_m, depth_slope;                          ///< below the disc
    T first_m, first_slope, second_m, second_slope;  ///< beside the axis, in two directions
    T disc_m_s;                                      ///< speed of the air at its disc
};

/// A part of a link. Empty where last <= first.
template <class T>
struct LinkPart {
    T first_m, last_m;
};

/// The part of a link that a slipstream may reach.
template <class T>
LinkPart<T> part_inside(const SlipstreamAtLink<T>& at, double radius_m, const T& length_m) {
    LinkPart<T> part{T(0), length_m};
    // Where at + slope s > 0 the link is outside.
    const auto leave_out = [&](T outside, T slope) {
        const T some = lane::select(lane::abs(slope) < T(1e-9), T(1e-9), slope);
        const T end_m = -outside / some;
        part.last_m = lane::select(some > T(0), lane::min(part.last_m, end_m), part.last_m);
        part.first_m = lane::select(some < T(0), lane::max(part.first_m, end_m), part.first_m);
    };
    const T edge_m = T(edge_radii * radius_m) + T(edge_spread) * at.depth_m;
    const T narrowing = T(-edge_spread) * at.depth_slope;
    leave_out(at.first_m - edge_m, narrowing + at.first_slope);
    leave_out(-at.first_m - edge_m, narrowing - at.first_slope);
    leave_out(at.second_m - edge_m, narrowing + at.second_slope);
    leave_out(-at.second_m - edge_m, narrowing - at.second_slope);
    leave_out(T(-inflow_radii * radius_m) - at.depth_m, -at.depth_slope);
    return part;
}

/// The part that is in one or the other, and what is between them.
template <class T>
LinkPart<T> joined(const LinkPart<T>& a, const LinkPart<T>& b) {
    const auto has_a = a.last_m > a.first_m;
    const auto has_b = b.last_m > b.first_m;
    const auto has_both = has_a & has_b;
    return {lane::select(has_both, lane::min(a.first_m, b.first_m), lane::select(has_a, a.first_m, b.first_m)),
            lane::select(has_both, lane::max(a.last_m, b.last_m), lane::select(has_a, a.last_m, b.last_m))};
}

/// What all slipstreams change of the links' drag. Neither inline nor with any effect but its value: what flies without
/// a wash stays as small and as fast as it is.
/// @param acting_n thrust of each rotor in free air   @param scale speed of the slipstreams over that of the model
template <class T, int n, class P>
[[gnu::noinline, gnu::pure]] LinkForces<T, n> link_wash(const BasicSpaceModel<P, n>& model,
                                                        const SpaceSlipstreams& slipstreams,
                                                        const LinkStreams<T, n>& streams, const T acting_n[max_rotors],
                                                        const T& scale) {
    const double radius_m = slipstreams.radius_m;
    const T inverse_radius_1_m(1 / radius_m);
    LinkForces<T, n> forces;
    for (int i = 0; i < n; ++i) {
        forces.of[i] = {{T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
    }
    const auto seen = [&](int rotor, const LinkStream<T>& link) {
        const LaneVector<T> axis = spread<T>(model.rotor[rotor].axis);
        const LaneVector<T> first = spread<T>(slipstreams.first_across[rotor]);
        const LaneVector<T> second = spread<T>(slipstreams.second_across[rotor]);
        const LaneVector<T> from_hub = link.joint_m - spread<T>(model.rotor[rotor].position_m);
        const T thrust_n = lane::max(acting_n[rotor], T(0));
        return SlipstreamAtLink<T>{axis,
                                   -dot(from_hub, axis),
                                   -dot(link.along, axis),
                                   dot(from_hub, first),
                                   dot(link.along, first),
                                   dot(from_hub, second),
                                   dot(link.along, second),
                                   scale * lane::sqrt(T(slipstreams.speed_squared_per_n) * thrust_n)};
    };
    const auto speed_at = [&](const SlipstreamAtLink<T>& at, const T& s) {
        const T depth = (at.depth_m + s * at.depth_slope) * inverse_radius_1_m;
        const T first = (at.first_m + s * at.first_slope) * inverse_radius_1_m;
        const T second = (at.second_m + s * at.second_slope) * inverse_radius_1_m;
        return at.disc_m_s * slipstream_speed(depth, first * first + second * second);
    };
    for (int slipstream = 0; slipstream < slipstreams.count; ++slipstream) {
        const int mirror = slipstreams.mirror[slipstream];
        for (int i = 0; i < n; ++i) {
            const LinkStream<T>& link = streams.of[i];
            const T linear(model.link[i].drag_n_s_m);
            const T quadratic(model.link[i].drag_n_s2_m2);
            const T whole_m(model.link[i].length_m);
            const SlipstreamAtLink<T> one = seen(slipstreams.rotor[slipstream], link);
            LinkPart<T> part = part_inside(one, radius_m, whole_m);
            SlipstreamAtLink<T> other = one;
            if (mirror >= 0) {
                other = seen(mirror, link);
                part = joined(part, part_inside(other, radius_m, whole_m));
            }
            const T inside_m = part.last_m - part.first_m;
            if (lane::bits_of(inside_m > T(0)) == 0) {
                continue;
            }
            const T length_m = lane::max(inside_m, T(0));
            const T share = length_m * T(model.link[i].inverse_length_1_m);
            for (int k = 0; k < wash_points; ++k) {
                const T s = part.first_m + T(wash_point[k]) * length_m;
                const T speed_m_s = speed_at(one, s);
                LaneVector<T> wash = T(-1) * (speed_m_s * one.axis);
                if (mirror >= 0) {  // momentum adds
                    const T other_m_s = speed_at(other, s);
                    const T squared = speed_m_s * speed_m_s;
                    const T other_squared = other_m_s * other_m_s;
                    const T both_m_s = lane::sqrt(lane::max(squared + other_squared, T(1e-300)));
                    wash = T(-1) / both_m_s * (squared * one.axis + other_squared * other.axis);
                }
                const LaneVector<T> still = link.across_m_s + s * link.turning_1_s;
                const LaneVector<T> washed = still - (wash - dot(wash, link.along) * link.along);
                const LaneVector<T> force = (T(wash_weight[k]) * share) *
                                            (drag_at(linear, quadratic, still) - drag_at(linear, quadratic, washed));
                forces.of[i].force_n = forces.of[i].force_n + force;
                forces.of[i].first_nm = forces.of[i].first_nm + s * force;
            }
        }
    }
    return forces;
}

}  // namespace downwash::dynamics
