#include "downwash/grids/factor_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::array<std::string_view, 4> field_names{"factor", "ground", "ceiling", "flyable"};
constexpr double max_coordinate_m = 1e6;

bool is_coordinate(double value) {
    return std::abs(value) <= max_coordinate_m;  // NaN fails
}

void check_axis(std::string_view name, const GridAxis& axis, std::vector<KeyError>& errors) {
    const std::string key(name);
    if (axis.count < 2) {
        errors.push_back({key, "has a single coordinate: expected two or more"});
    } else if (!is_coordinate(axis.low_m) || !is_coordinate(axis.high_m)) {
        errors.push_back({key, "runs from " + to_text(axis.low_m) + " to " + to_text(axis.high_m) +
                                   " m: expected finite coordinates, at most 1e6 m"});
    } else if (!(axis.low_m < axis.high_m)) {
        errors.push_back({key, "runs from " + to_text(axis.low_m) + " to " + to_text(axis.high_m) +
                                   " m: expected the lower end first"});
    } else if (!(axis.low_m + axis.step_m() > axis.low_m && axis.high_m - axis.step_m() < axis.high_m)) {
        errors.push_back({key, "has steps of " + to_text(axis.step_m()) + " m: too fine to tell its nodes apart"});
    }
}

void check_offsets(const FactorGridParts& parts, std::vector<KeyError>& errors) {
    const std::vector<double>& offsets_m = parts.lateral_offsets_m;
    if (!std::all_of(offsets_m.begin(), offsets_m.end(), is_coordinate)) {
        errors.push_back({"lateral_offsets_m", "expected finite distances, at most 1e6 m"});
        return;
    }
    const auto is_not_rising = [](double a, double b) { return !(b - a > 2 * default_layer_slack_m); };
    if (std::adjacent_find(offsets_m.begin(), offsets_m.end(), is_not_rising) != offsets_m.end()) {
        errors.push_back({"lateral_offsets_m", "expected rising distances, more than 2e-6 m apart"});
    }
    if (parts.y.count > 1 && !offsets_m.empty()) {
        errors.push_back({"lateral_offsets_m", "belong to planar grids only, this one is a volume"});
    }
}

/// Whether there is room for so many nodes; 0 when there is not.
std::size_t checked_nodes(const FactorGridParts& parts) {
    std::size_t nodes = 1;
    for (const std::size_t count :
         {parts.x.count, parts.y.count, parts.z.count, std::max<std::size_t>(1, parts.lateral_offsets_m.size())}) {
        if (count > max_grid_nodes || nodes * count > max_grid_nodes) {
            return 0;
        }
        nodes *= count;
    }
    return nodes;
}

void check_field(const GridField& field, std::size_t nodes, std::vector<KeyError>& errors) {
    if (std::find(field_names.begin(), field_names.end(), field.name) == field_names.end()) {
        errors.push_back(
            {"fields", "'" + excerpt(field.name) + "' is no field: expected " + joined_names(field_names)});
        return;
    }
    if (field.values.size() != nodes) {
        errors.push_back({field.name, "has " + std::to_string(field.values.size()) + " values: expected " +
                                          std::to_string(nodes) + ", one per node"});
        return;
    }
    const bool is_flag = field.name == "flyable";
    const auto is_good = [is_flag](double value) {
        return is_flag ? value == 0 || value == 1 : value >= 0 && value <= max_grid_factor;  // NaN fails
    };
    const auto bad = std::find_if_not(field.values.begin(), field.values.end(), is_good);
    if (bad != field.values.end()) {
        errors.push_back({field.name, "value " + std::to_string(bad - field.values.begin() + 1) + " of " +
                                          std::to_string(nodes) + " is " + to_text(*bad) + ": expected " +
                                          (is_flag ? "0 or 1" : "a finite factor from 0 to 100")});
    }
}

void check_fields(const FactorGridParts& parts, std::size_t nodes, std::vector<KeyError>& errors) {
    for (const std::string_view name : field_names) {
        const auto count = std::count_if(parts.fields.begin(), parts.fields.end(),
                                         [name](const GridField& field) { return field.name == name; });
        if (count > 1 || (count == 0 && name == "factor")) {
            errors.push_back({std::string(name), count == 0 ? "is missing" : "occurs twice"});
        }
    }
    for (const GridField& field : parts.fields) {
        check_field(field, nodes, errors);
    }
}

bool is_one_line(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    return std::none_of(text.begin(), text.end(),
                        [](char c) { return c != '\t' && static_cast<unsigned char>(c) < 0x20; }) &&
           (text.empty() || (!is_blank(text.front()) && !is_blank(text.back())));
}

void check_provenance(const Provenance& provenance, std::vector<KeyError>& errors) {
    for (const auto& [key, value] : provenance) {
        if (key.empty() || !is_one_line(key) || key.ends_with(':') || key.find(": ") != std::string::npos ||
            key.starts_with("frame_")) {
            errors.push_back({"provenance", "key '" + excerpt(key) +
                                                "': expected a short name without ': ', line break or blanks around "
                                                "it that does not begin with frame_"});
        } else if (!is_one_line(value)) {
            errors.push_back({"provenance", excerpt(key) + ": expected one line of text without blanks around it"});
        }
    }
}

/// The interval of an axis that holds a coordinate, and where in it, 0 to 1. False outside.
bool locate(const GridAxis& axis, double slack_m, double coordinate_m, std::size_t& index, double& part) {
    if (!(coordinate_m >= axis.low_m - slack_m && coordinate_m <= axis.high_m + slack_m)) {
        return false;
    }
    const double steps = (coordinate_m - axis.low_m) / axis.step_m();
    index = static_cast<std::size_t>(std::clamp(steps, 0.0, static_cast<double>(axis.count - 2)));
    part = std::clamp(steps - static_cast<double>(index), 0.0, 1.0);
    return true;
}

double between(double a, double b, double part) {
    return a + part * (b - a);
}

}  // namespace

FactorGrid::FactorGrid(FactorGridParts parts) : parts_(std::move(parts)) {
    std::vector<KeyError> errors;
    const Vector3& origin_m = parts_.frame.origin_m();
    if (!std::all_of(origin_m.begin(), origin_m.end(), is_coordinate) || !is_coordinate(parts_.frame.heading_rad())) {
        errors.push_back({"frame", "expected a finite origin and heading"});
    }
    check_axis("x", parts_.x, errors);
    check_axis("z", parts_.z, errors);
    if (parts_.y.count != 1) {
        check_axis("y", parts_.y, errors);
    } else if (!(parts_.y == GridAxis{})) {
        errors.push_back({"y", "of a planar grid is 0: expected the frame's origin in its plane"});
    }
    check_offsets(parts_, errors);
    const auto is_slack = [](double slack_m) { return slack_m >= 0 && is_coordinate(slack_m); };
    if (!std::all_of(parts_.edge_slack_m.begin(), parts_.edge_slack_m.end(), is_slack) ||
        !is_slack(parts_.layer_slack_m)) {
        errors.push_back({"slack", "expected finite distances, at least 0"});
    }
    const std::size_t nodes = checked_nodes(parts_);
    if (nodes == 0) {
        errors.push_back({"", "the grid has more than 2^24 nodes: expected a larger step or a smaller extent"});
    } else {
        check_fields(parts_, nodes, errors);
    }
    check_provenance(parts_.provenance, errors);
    throw_if_any(std::move(errors));
    const auto factor = std::find_if(parts_.fields.begin(), parts_.fields.end(),
                                     [](const GridField& field) { return field.name == "factor"; });
    std::rotate(parts_.fields.begin(), factor, factor + 1);
}

std::size_t FactorGrid::layers() const noexcept {
    return std::max<std::size_t>(1, parts_.lateral_offsets_m.size());
}

std::size_t FactorGrid::nodes() const noexcept {
    return layers() * parts_.x.count * parts_.y.count * parts_.z.count;
}

const std::vector<double>* FactorGrid::field(std::string_view name) const noexcept {
    for (const GridField& field : parts_.fields) {
        if (field.name == name) {
            return &field.values;
        }
    }
    return nullptr;
}

std::optional<FactorGrid::Place> FactorGrid::place_of(const Vector3& hub_m) const noexcept {
    const auto [x_m, y_m, z_m] = parts_.frame.from_world(hub_m);
    Place place{};
    const auto& [slack_x_m, slack_y_m, slack_z_m] = parts_.edge_slack_m;
    if (!locate(parts_.x, slack_x_m, x_m, place.i, place.s) || !locate(parts_.z, slack_z_m, z_m, place.k, place.u)) {
        return std::nullopt;
    }
    if (!is_planar()) {
        return locate(parts_.y, slack_y_m, y_m, place.j, place.t) ? std::optional(place) : std::nullopt;
    }
    const std::vector<double>& offsets_m = parts_.lateral_offsets_m;
    for (; place.layer < offsets_m.size(); ++place.layer) {
        if (std::abs(y_m - offsets_m[place.layer]) <= parts_.layer_slack_m) {
            return place;
        }
    }
    return offsets_m.empty() && std::isfinite(y_m) ? std::optional(place) : std::nullopt;
}

bool FactorGrid::contains(const Vector3& hub_m) const noexcept {
    return place_of(hub_m).has_value();
}

bool FactorGrid::is_flyable_between(std::span<const Vector3> corners_m) const noexcept {
    std::optional<Place> low;
    std::optional<Place> high;
    for (const Vector3& corner_m : corners_m) {
        const auto place = place_of(corner_m);
        if (!place || (low && place->layer != low->layer)) {
            return false;
        }
        if (!low) {
            low = high = place;
        }
        low->i = std::min(low->i, place->i);
        low->j = std::min(low->j, place->j);
        low->k = std::min(low->k, place->k);
        high->i = std::max(high->i, place->i);
        high->j = std::max(high->j, place->j);
        high->k = std::max(high->k, place->k);
    }
    const std::vector<double>* flags = field("flyable");
    if (!low || !flags) {
        return low.has_value();
    }
    const std::size_t last_j = is_planar() ? 0 : high->j + 1;
    for (std::size_t k = low->k; k <= high->k + 1; ++k) {
        for (std::size_t j = low->j; j <= last_j; ++j) {
            const double* row =
                flags->data() + ((low->layer * parts_.z.count + k) * parts_.y.count + j) * parts_.x.count;
            if (std::find(row + low->i, row + high->i + 2, 0.0) != row + high->i + 2) {
                return false;
            }
        }
    }
    return true;
}

double FactorGrid::factor(const Vector3& hub_m) const noexcept {
    const auto place = place_of(hub_m);
    if (!place) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const std::size_t row = parts_.x.count;
    const std::size_t level = row * parts_.y.count;
    const double* node = parts_.fields.front().values.data() + (place->layer * parts_.z.count + place->k) * level +
                         place->j * row + place->i;
    const auto along_x = [&](const double* at) { return between(at[0], at[1], place->s); };
    const auto along_y = [&](const double* at) {
        return is_planar() ? along_x(at) : between(along_x(at), along_x(at + row), place->t);
    };
    return between(along_y(node), along_y(node + level), place->u);
}

}  // namespace downwash
