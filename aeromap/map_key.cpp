#include <initializer_list>
#include <span>
#include <type_traits>
#include <variant>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/base/text.hpp"
#include "downwash/base/version.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/scene/shape_digest.hpp"

// The members are bound by name: who adds one to a shape or a setting has to decide here whether it makes the map.

namespace downwash {
namespace {

/// A text that two makings of maps share only if they make the same map.
class Description {
 public:
    Description& add(std::string_view word) {
        text_ += word;
        text_ += '\n';
        return *this;
    }
    Description& add(double number) { return add(to_text(number)); }
    template <class Numbers>
    Description& add_all(const Numbers& numbers) {
        add("list");
        for (const double number : numbers) {
            add(number);
        }
        return add("end");
    }
    [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
    std::string text_;
};

void add_shape(Description& description, const Box& box) {
    const auto& [size_m] = box;
    description.add("box").add_all(size_m);
}

void add_shape(Description& description, const Cylinder& cylinder) {
    const auto& [radius_m, length_m, axis] = cylinder;
    description.add("cylinder").add(radius_m).add(length_m).add_all(axis);
}

void add_shape(Description& description, const Sphere& sphere) {
    const auto& [radius_m] = sphere;
    description.add("sphere").add(radius_m);
}

void add_shape(Description& description, const Mesh& mesh) {
    const auto& [file, scale, surface, offset_m] = mesh;
    description.add("mesh").add(scale).add(surface ? digest_of(*surface) : "none");
    if (offset_m != Vector3{}) {
        description.add("offset").add_all(offset_m);
    }
}

void add_shape(Description& description, const Octomap& octomap) {
    const auto& [file, tree, unknown] = octomap;  // the digest tells `unknown`
    description.add("octomap").add(tree ? digest_of(octomap) : "none");
}

void add_scene(Description& description, const Scene& scene) {
    description.add("scene");
    for (const auto& [name, shape, center_world_m, rpy_rad] : scene.obstacles()) {
        std::visit([&description](const auto& of_its_kind) { add_shape(description, of_its_kind); }, shape);
        description.add_all(center_world_m).add_all(rpy_rad);
    }
}

void add_effect(Description& description, const SurfaceEffect& effect) {
    const auto& [model, parameters, file, table, pipe_radii, d_over_r] = effect;
    description.add(info(model).name).add_all(parameters);
    if (table) {
        description.add(digest_of(*table));
    }
    description.add(d_over_r ? to_text(*d_over_r) : "measured");
}

void add_curve(Description& description, const EffectCurve& curve) {
    const auto& [distances_radii, offsets_radii, center_radii] = curve.neighbours();
    add_effect(description, curve.effect());
    description.add(curve.is_fountain() ? "fountain" : "rotor").add_all(distances_radii).add(center_radii);
    for (const auto& [x, y] : offsets_radii) {
        description.add(x).add(y);
    }
}

void add_axis(Description& description, const GridAxis& axis) {
    const auto& [low_m, high_m, count] = axis;
    description.add(low_m).add(high_m).add(std::to_string(count));
}

void add_field(Description& description, const std::vector<double>& values) {
    description.add(sha256_hex_of(std::span(values)));
}

/// What a grid says of K and the flyable area, not how it came about.
void add_grid(Description& description, const FactorGrid& grid) {
    description.add("grid").add_all(grid.frame().origin_m()).add(grid.frame().heading_rad());
    add_axis(description, grid.x());
    add_axis(description, grid.y());
    add_axis(description, grid.z());
    description.add_all(grid.lateral_offsets_m()).add_all(grid.edge_slack_m()).add(grid.layer_slack_m());
    add_field(description, *grid.field("factor"));
    if (const std::vector<double>* flyable = grid.field("flyable")) {
        add_field(description.add("flyable"), *flyable);
    }
}

/// All of it but the scene.
void add_direct_effect(Description& description, const DirectEffect& effect) {
    // The tilt comes in flight, behind the map.
    const auto& [enabled, ground, ceiling, tilt_loss, wall, map_file, map, max_factor, min_distance_radii, grid_m] =
        effect.settings();
    description.add(enabled ? "on" : "off").add(grid_m);
    description.add(effect.rotor_radius_m()).add(effect.min_clearance_m());
    add_effect(description, ground);
    add_effect(description, ceiling);
    description.add(max_factor).add(min_distance_radii);
    add_curve(description, effect.ground());
    add_curve(description, effect.ceiling());
    if (map) {
        add_grid(description, *map);
    }
    if (effect.is_of_walls()) {
        description.add("walls").add(wall.decay_radii).add(effect.wall_reach_m());
    }
}

}  // namespace

std::string map_key(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane, const Bounds& extent) {
    Description description;
    description.add("downwash map").add(version()).add(map_format_version);
    description.add_all(plane.origin_m()).add(plane.heading_rad());
    const auto& [x_low_m, x_high_m, z_low_m, z_high_m] = extent;
    description.add_all(std::initializer_list<double>{x_low_m, x_high_m, z_low_m, z_high_m});
    const Scene* described = nullptr;
    for (const auto& [effect, lateral_m] : layers) {
        description.add("layer").add(lateral_m);
        add_direct_effect(description, *effect);
        if (&effect->scene() == described) {
            description.add("same scene");
        } else {
            described = &effect->scene();
            add_scene(description, *described);
        }
    }
    return sha256_hex(description.text());
}

std::string map_key(const VolumeMap& map) {
    Description description;
    description.add("downwash volume").add(version()).add(map_format_version);
    description.add_all(map.frame().origin_m()).add(map.frame().heading_rad());
    description.add_all(map.low_m()).add_all(map.high_m());
    add_direct_effect(description, map.effect());
    description.add(map.effect().is_of_walls_around() ? "around" : "ahead");
    for (const EffectCurve* curve : {&map.effect().ground(), &map.effect().ceiling()}) {
        description.add(curve->image_distance_radii());
    }
    description.add(map.effect().column_radius_m());
    add_scene(description, map.effect().scene());
    return sha256_hex(description.text());
}

}  // namespace downwash
