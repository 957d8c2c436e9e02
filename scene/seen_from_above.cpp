#include "downwash/scene/seen_from_above.hpp"

#include <algorithm>
#include <cmath>

namespace downwash {
namespace {

/// Sine of an angle too small to matter: over 100 m it moves a surface by 1e-10 m.
constexpr double negligible_tilt = 1e-12;

double without_negligible(double sine) {
    return std::abs(sine) < negligible_tilt ? 0 : sine;
}

SeenFromAbove prepared(const Box& box, const Placement& placement) {
    return box_from_above(box, placement);
}

SeenFromAbove prepared(const Sphere& sphere, const Placement&) {
    return SphereFromAbove{sphere.radius_m * sphere.radius_m};
}

SeenFromAbove prepared(const Cylinder& cylinder, const Placement& placement) {
    const Vector3& axis = placement.axis_world;
    const double level = without_negligible(std::sqrt(axis[0] * axis[0] + axis[1] * axis[1]));
    const double upright = without_negligible(axis[2]);
    CylinderFromAbove form{1,
                           0,
                           level,
                           upright,
                           inverse_or_zero(level),
                           inverse_or_zero(upright),
                           cylinder.radius_m,
                           0.5 * cylinder.length_m};
    if (level != 0) {
        form.along_x = axis[0] / level;
        form.along_y = axis[1] / level;
    }
    return form;
}

}  // namespace

BoxFromAbove box_from_above(const Box& box, const Placement& placement) {
    const Matrix3& r = placement.rotation;
    BoxFromAbove form{};
    for (std::size_t i = 0; i < 3; ++i) {
        form.faces[i] = {r[0][i], r[1][i], inverse_or_zero(without_negligible(r[2][i])), 0.5 * box.size_m[i]};
        const double nx = -without_negligible(r[1][i]);
        const double ny = without_negligible(r[0][i]);
        double reach = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            reach += std::abs(nx * r[0][k] + ny * r[1][k]) * 0.5 * box.size_m[k];
        }
        form.shadow[i] = {nx, ny, 0, reach};
    }
    return form;
}

SeenFromAbove seen_from_above(const Primitive& shape, const Placement& placement) {
    return std::visit([&](const auto& solid) { return prepared(solid, placement); }, shape);
}

bool has_level_faces(const SeenFromAbove& form) {
    if (const auto* box = std::get_if<BoxFromAbove>(&form)) {
        return std::count_if(box->faces.begin(), box->faces.end(),
                             [](const Slab& face) { return face.per_rise == 0; }) == 2;
    }
    const auto* cylinder = std::get_if<CylinderFromAbove>(&form);
    return cylinder != nullptr && cylinder->level == 0;
}

}  // namespace downwash
