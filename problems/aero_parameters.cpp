#include "downwash/problems/aero_parameters.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/base/sha256.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/pipe_table.hpp"
#include "downwash/grids/factor_grid_file.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<AeroSettings>>;
using parameters::in;

template <class Member>
Parameter<AeroSettings> number(const std::string& path, std::string_view description, Member member) {
    return parameters::number<AeroSettings>(path, description, member);
}

/// Nearer to an edge or a pipe K jumps, and a map would need cells without end: the pipe rack's takes 0.5 s at 0.03
/// radii, 5 s at 0.01, and minutes at 0.
constexpr double least_distance_radii = 0.03;

bool has_no_map(const AeroSettings& a, std::size_t) {
    return !a.map;
}

/// One side's surface effect in the settings.
using SurfaceMember = SurfaceEffect AeroSettings::*;

/// The model's name, and as many rows as all models together have parameters.
void add_model(Rows& rows, const std::string& path, const std::vector<EffectModelInfo>& models, SurfaceMember side) {
    std::vector<std::string_view> names;
    names.reserve(models.size());
    for (const EffectModelInfo& model : models) {
        names.push_back(model.name);
    }
    auto model = parameters::row<AeroSettings>(ParameterKind::choice, path + ".model", "the formula");
    model.names = names;
    model.get = [side](const AeroSettings& a, std::size_t) { return Value(std::string(info((a.*side).model).name)); };
    model.set = [side](AeroSettings& a, std::size_t, const Value& value) {
        if (const EffectModelInfo* named = find_effect_model(std::get<std::string>(value))) {
            a.*side = named->model;
        }
    };
    rows.push_back(std::move(model));
    for (const EffectModelInfo& known : models) {
        for (std::size_t i = 0; i < known.parameters.size(); ++i) {
            const ModelParameter& parameter = known.parameters[i];
            auto row = number(
                path + "." + std::string(parameter.name), parameter.description,
                [ side, i ](auto& a) -> auto& { return (a.*side).parameters[i]; });
            row.get = [side, i, which = known.model, otherwise = parameter.source_value](const AeroSettings& a,
                                                                                         std::size_t) {
                return Value((a.*side).model == which ? (a.*side).parameters[i] : otherwise);
            };
            row.range = {parameter.low, parameter.high, parameter.is_open, false};
            rows.push_back(std::move(row).only(
                "with the model " + std::string(known.name),
                [side, which = known.model](const AeroSettings& a, std::size_t) { return (a.*side).model == which; }));
        }
    }
}

/// The table in a file, as K of points.
std::shared_ptr<const EffectTable> points_in(const std::string& file, const std::optional<double>& pipe_radii) {
    auto table = read_effect_table(file);
    return pipe_radii ? std::make_shared<const EffectTable>(points_of_pipe(*table, *pipe_radii)) : table;
}

void add_table(Rows& rows, const std::string& path, SurfaceMember side) {
    const auto is_table = [side](const AeroSettings& a, std::size_t) { return (a.*side).model == EffectModel::table; };
    rows.push_back(parameters::file<AeroSettings>(
                       path + ".file", "the table, CSV with z_over_r, perhaps d_over_r, and factor",
                       in(side, &SurfaceEffect::file),
                       [side](AeroSettings& a, std::size_t, const std::string& name) {
                           (a.*side).table = points_in(name, (a.*side).pipe_radii);
                       },
                       [side](const AeroSettings& a, std::size_t) { return digest_of(*(a.*side).table); })
                       .only("with the model table", is_table));
    auto pipe = number(
        path + ".pipe_radii",
        "the table was measured with the hub over the axis of a pipe of this radius, in rotor radii, and holds for the "
        "whole disc; null: over a wide, flat surface",
        in(side, &SurfaceEffect::pipe_radii));
    pipe.set = [side, keep = pipe.set](AeroSettings& a, std::size_t i, const Value& value) {
        keep(a, i, value);
        if ((a.*side).table) {
            (a.*side).table = points_in((a.*side).file, (a.*side).pipe_radii);
        }
    };
    rows.push_back(std::move(pipe).between(0.02, 100).only("with the model table", is_table));
    rows.push_back(number(path + ".d_over_r",
                          "second distance of a table over two; null: the distance to the nearest wall at rotor height",
                          in(side, &SurfaceEffect::d_over_r))
                       .between(0, 10000)
                       .only("with the model table", is_table));
}

void add_surface(Rows& rows, const std::string& path, const std::string& description,
                 const std::vector<EffectModelInfo>& models, SurfaceMember side, double TiltLoss::*tilt_loss) {
    auto surface = parameters::group<AeroSettings>(path, description).or_none().only("without aero.map", has_no_map);
    surface.resize = [side](AeroSettings& a, std::size_t, std::size_t count) {
        if (count == 0) {
            a.*side = EffectModel::none;
        }
    };
    rows.push_back(std::move(surface));
    add_model(rows, path, models, side);
    add_table(rows, path, side);
    rows.push_back(
        number(path + ".tilt_loss",
               "how fast the effect fades with the tilt of a rotor: K - 1 is halved where it equals tilt_loss "
               "times the squared sine of the tilt; 0: a tilted rotor counts as level",
               in(&AeroSettings::tilt_loss, tilt_loss))
            .between(0, 100));
}

}  // namespace

Rows aero_rows() {
    Rows rows;
    std::vector<EffectModelInfo> below(effect_models().begin(), effect_models().end());
    std::vector<EffectModelInfo> above = below;
    std::erase_if(above, [](const EffectModelInfo& model) {  // a fountain rises from the ground only
        return model.model == EffectModel::multirotor_body;
    });
    add_surface(rows, "ground", "surfaces below a rotor", below, &AeroSettings::ground, &TiltLoss::ground);
    add_surface(rows, "ceiling", "surfaces above a rotor", above, &AeroSettings::ceiling, &TiltLoss::ceiling);
    const auto wall = [](auto member) { return in(&AeroSettings::wall, member); };
    parameters::append(
        rows,
        {parameters::group<AeroSettings>(
             "wall",
             "what walls beside the vehicle do to it, as shares of the thrust; they fade with the gap to the nearest "
             "rotor's edge"),
         number("wall.force", "horizontal force where a rotor touches the wall, positive: away from it",
                wall(&WallEffect::force))
             .between(-0.2, 0.2),
         number("wall.moment",
                "pitch moment there, over thrust and rotor radius, positive: the side towards the wall sinks",
                wall(&WallEffect::moment))
             .between(-0.5, 0.5),
         number("wall.decay_radii", "gap in rotor radii over which both fall to 1/e", wall(&WallEffect::decay_radii))
             .between(0.05, 20),
         number("max_factor",
                "most that a surface may multiply thrust by; a low one hides from plans how a near ceiling pulls",
                &AeroSettings::max_factor)
             .between(1, 10)
             .only("without aero.map", has_no_map),
         number("min_distance_radii",
                "flyable area: least distance of a rotor's disc from obstacles, where models still apply",
                &AeroSettings::min_distance_radii)
             .between(least_distance_radii, 100),
         number("grid_m", "cell size of the map", &AeroSettings::grid_m).between(0.001, 10)});
    return rows;
}

void add_aero_rows(std::vector<Parameter<Problem>>& rows) {
    rows.push_back(aero_group<Problem>());
    rows.push_back(parameters::file<Problem>(
        "aero.map", "K on a grid of rotor positions, a CSV file, in place of the models; null: none",
        in(&Problem::aero, &AeroSettings::map_file),
        [](Problem& p, std::size_t, const std::string& name) {
            p.aero.map = std::make_shared<const FactorGrid>(read_factor_grid(name, p.plane));
        },
        [](const Problem& p, std::size_t) { return sha256_hex(vti_text(*p.aero.map)); }));
    for (const Parameter<AeroSettings>& row : aero_rows()) {
        rows.push_back(parameters::nested<Problem>(row, "aero.", &Problem::aero));
    }
}

}  // namespace downwash
