#include "downwash/judge/reference.hpp"

namespace downwash::judge {

Course between(const Course& from, const Course& to, double duration_s, double s) {
    // The Hermite basis of degree five on [0, 1], with derivatives scaled by the duration T.
    const double r = 1 - s;
    struct Basis {
        double value, slope, curvature;
    };
    // H0, H1, H2 belong to the beginning; mirrored, H3 = H0(1 - s), -H1(1 - s) and H2(1 - s) belong to the end.
    const auto h0 = [](double t) {
        return Basis{1 - t * t * t * (10 - t * (15 - 6 * t)), -30 * t * t * (1 - t) * (1 - t),
                     -60 * t * (1 - t) * (1 - 2 * t)};
    };
    const auto h1 = [](double t) {
        return Basis{t - t * t * t * (6 - t * (8 - 3 * t)), 1 - t * t * (18 - t * (32 - 15 * t)),
                     -t * (36 - t * (96 - 60 * t))};
    };
    const auto h2 = [](double t) {
        return Basis{0.5 * t * t * (1 - t) * (1 - t) * (1 - t), t - t * t * (4.5 - t * (6 - 2.5 * t)),
                     1 - t * (9 - t * (18 - 10 * t))};
    };
    const Basis begin[] = {h0(s), h1(s), h2(s)};
    const Basis end[] = {h0(r), h1(r), h2(r)};
    const double p[] = {from.position, from.velocity * duration_s, from.acceleration * duration_s * duration_s};
    const double q[] = {to.position, -to.velocity * duration_s, to.acceleration * duration_s * duration_s};
    Course at;
    for (int k = 0; k < 3; ++k) {
        at.position += p[k] * begin[k].value + q[k] * end[k].value;
        at.velocity += p[k] * begin[k].slope - q[k] * end[k].slope;
        at.acceleration += p[k] * begin[k].curvature + q[k] * end[k].curvature;
    }
    at.velocity /= duration_s;
    at.acceleration /= duration_s * duration_s;
    return at;
}

ReferencePoint Reference::at(std::int64_t tick) {
    const std::vector<ReferenceKnot>& knots = plan_.reference;
    while (piece_ + 1 < knots.size() && tick >= knots[piece_ + 1].tick) {
        ++piece_;
    }
    const ReferenceKnot& from = knots[piece_];
    if (tick <= from.tick || piece_ + 1 == knots.size()) {
        return from.point;
    }
    const ReferenceKnot& to = knots[piece_ + 1];
    const double duration_s = static_cast<double>(to.tick - from.tick) * plan_.tick_s;
    const double s = static_cast<double>(tick - from.tick) / static_cast<double>(to.tick - from.tick);
    ReferencePoint point;
    for (int axis = 0; axis < 3; ++axis) {
        const Course at =
            between({from.point.position[axis], from.point.velocity[axis], from.point.acceleration[axis]},
                    {to.point.position[axis], to.point.velocity[axis], to.point.acceleration[axis]}, duration_s, s);
        point.position[axis] = at.position;
        point.velocity[axis] = at.velocity;
        point.acceleration[axis] = at.acceleration;
    }
    return point;
}

}  // namespace downwash::judge
