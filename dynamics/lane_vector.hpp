#pragma once

#include "downwash/base/lane_math.hpp"

// Vectors, symmetric matrices and rotations of three dimensions for the tick: plain numbers of one lane type.

namespace downwash::dynamics {

/// Three coordinates in one frame.
template <class T>
struct LaneVector {
    T x, y, z;
};

/// Sum.
template <class T>
LaneVector<T> operator+(const LaneVector<T>& a, const LaneVector<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
/// Difference.
template <class T>
LaneVector<T> operator-(const LaneVector<T>& a, const LaneVector<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// Multiple.
template <class T>
LaneVector<T> operator*(const T& s, const LaneVector<T>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
/// Scalar product.
template <class T>
T dot(const LaneVector<T>& a, const LaneVector<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Vector product.
template <class T>
LaneVector<T> cross(const LaneVector<T>& a, const LaneVector<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// A vector copied to every lane.
template <class T, class P>
LaneVector<T> spread(const LaneVector<P>& a) {
    return {T(a.x), T(a.y), T(a.z)};
}

/// A symmetric 3 x 3 matrix.
template <class T>
struct LaneSymmetric {
    T xx, xy, xz, yy, yz, zz;
};

/// Sum.
template <class T>
LaneSymmetric<T> operator+(const LaneSymmetric<T>& a, const LaneSymmetric<T>& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
/// Difference.
template <class T>
LaneSymmetric<T> operator-(const LaneSymmetric<T>& a, const LaneSymmetric<T>& b) {
    return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
}
/// Product.
template <class T>
LaneVector<T> operator*(const LaneSymmetric<T>& m, const LaneVector<T>& v) {
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
/// A matrix copied to every lane.
template <class T, class P>
LaneSymmetric<T> spread(const LaneSymmetric<P>& m) {
    return {T(m.xx), T(m.xy), T(m.xz), T(m.yy), T(m.yz), T(m.zz)};
}
/// s (|a|^2 1 - a a^T): the inertia of a point of mass s at a.
template <class T>
LaneSymmetric<T> point_inertia(const T& s, const LaneVector<T>& a) {
    const LaneVector<T> b = s * a;
    const T xx = a.x * b.x;
    const T yy = a.y * b.y;
    const T zz = a.z * b.z;
    return {yy + zz, -(a.x * b.y), -(a.x * b.z), xx + zz, -(a.y * b.z), xx + yy};
}

/// a b^T, where b is a multiple of a.
template <class T>
LaneSymmetric<T> outer_square(const LaneVector<T>& a, const LaneVector<T>& b) {
    return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.y, a.y * b.z, a.z * b.z};
}

/// A rotation by the images of the three axes of the turned frame.
template <class T>
struct LaneRotation {
    LaneVector<T> first, second, third;
};

/// From the turned frame to the outer one.
template <class T>
LaneVector<T> operator*(const LaneRotation<T>& r, const LaneVector<T>& v) {
    return v.x * r.first + v.y * r.second + v.z * r.third;
}
/// From the outer frame to the turned one.
template <class T>
LaneVector<T> turned_back(const LaneRotation<T>& r, const LaneVector<T>& v) {
    return {dot(r.first, v), dot(r.second, v), dot(r.third, v)};
}
/// First `b`, then `a`.
template <class T>
LaneRotation<T> operator*(const LaneRotation<T>& a, const LaneRotation<T>& b) {
    return {a * b.first, a * b.second, a * b.third};
}
/// r m r^T: a matrix of the turned frame, in the outer one.
template <class T>
[[gnu::always_inline]] inline LaneSymmetric<T> turned(const LaneRotation<T>& r, const LaneSymmetric<T>& m) {
    // The columns of m r^T, one per outer axis.
    const LaneVector<T> x = m * LaneVector<T>{r.first.x, r.second.x, r.third.x};
    const LaneVector<T> y = m * LaneVector<T>{r.first.y, r.second.y, r.third.y};
    const LaneVector<T> z = m * LaneVector<T>{r.first.z, r.second.z, r.third.z};
    const auto row_x = [&](const LaneVector<T>& v) { return r.first.x * v.x + r.second.x * v.y + r.third.x * v.z; };
    const auto row_y = [&](const LaneVector<T>& v) { return r.first.y * v.x + r.second.y * v.y + r.third.y * v.z; };
    const auto row_z = [&](const LaneVector<T>& v) { return r.first.z * v.x + r.second.z * v.y + r.third.z * v.z; };
    return {row_x(x), row_x(y), row_x(z), row_y(y), row_y(z), row_z(z)};
}

/// The rotation of a quaternion (w, x, y, z) of any length but 0.
template <class T>
[[gnu::always_inline]] inline LaneRotation<T> rotation_of(const T q[4]) {
    const T s = T(2) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const T sx = s * q[1];
    const T sy = s * q[2];
    const T sz = s * q[3];
    const T wx = q[0] * sx;
    const T wy = q[0] * sy;
    const T wz = q[0] * sz;
    const T xx = q[1] * sx;
    const T xy = q[1] * sy;
    const T xz = q[1] * sz;
    const T yy = q[2] * sy;
    const T yz = q[2] * sz;
    const T zz = q[3] * sz;
    return {{T(1) - (yy + zz), xy + wz, xz - wy},
            {xy - wz, T(1) - (xx + zz), yz + wx},
            {xz + wy, yz - wx, T(1) - (xx + yy)}};
}

/// The rotation by an angle about a unit vector (Rodrigues). @pre |angle| <= 1e5 rad
template <class T>
[[gnu::always_inline]] inline LaneRotation<T> rotation_about(const LaneVector<T>& axis, const T& angle_rad) {
    T sine, cosine;
    lane::sin_cos(angle_rad, sine, cosine);
    const LaneVector<T> s = sine * axis;
    const LaneVector<T> c = (T(1) - cosine) * axis;
    return {{cosine + c.x * axis.x, c.x * axis.y + s.z, c.x * axis.z - s.y},
            {c.y * axis.x - s.z, cosine + c.y * axis.y, c.y * axis.z + s.x},
            {c.z * axis.x + s.y, c.z * axis.y - s.x, cosine + c.z * axis.z}};
}

}  // namespace downwash::dynamics
