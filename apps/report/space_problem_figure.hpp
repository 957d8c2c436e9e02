#pragma once

#include <string>
#include <vector>

#include "downwash/base/bounds.hpp"
#include "downwash/base/export.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/report/curve_figure.hpp"
#include "downwash/report/field.hpp"
#include "downwash/report/picture.hpp"
#include "downwash/results/run_record.hpp"
#include "downwash/scene/scene.hpp"

namespace downwash {

/// What is seen from one direction. Points are (across, up) in x_m and z_m.
struct SpaceView {
    std::string name;        ///< "from above"
    std::string across, up;  ///< names of the axes, such as "x [m]"
    Bounds extent;           ///< what is shown
    std::vector<ObstacleOutline> obstacles = {};
    std::vector<FigureLines> lines = {};
    std::vector<FigurePoints> points = {};  ///< the labels of theirs stand beside them, where there is room
};

/// Three views at right angles, to one scale: the one from above over the one from the side, beside it the one from the
/// front.
struct SpaceFigure {
    std::string title, subtitle;
    SpaceView top, side, front;
    bool has_names = true;  ///< whether obstacles have their names
};

/// A problem in space before it is planned: scene, bounds, goals, and the robot at its start.
/// @param scene of the problem   @pre space_problem_errors(problem) is empty
[[nodiscard]] DOWNWASH_EXPORT SpaceFigure space_problem_figure(const SpaceProblem& problem, const Scene& scene);

/// A run in space: the flying robot at equal intervals of time, its way and that of its end effector, and the way that
/// was planned.
/// @param scene of the run's problem   @throws InputError when nothing was flown
[[nodiscard]] DOWNWASH_EXPORT SpaceFigure space_run_figure(const SpaceRunRecord& run, const Scene& scene);

/// Diagrams of a run in space over time, one below the other: tracking error, tilt and yaw, joints, rotor commands,
/// aero factors, clearance, power. @throws InputError when nothing was flown
[[nodiscard]] DOWNWASH_EXPORT std::vector<CurveFigure> time_figures(const SpaceRunRecord& run);

/// The picture as the bytes of a file. Equal figures give equal bytes. Text may be arbitrary: it is shown, never run.
/// @throws InputError when the width cannot be drawn  @throws PictureError when gnuplot cannot
[[nodiscard]] DOWNWASH_EXPORT std::string draw(const SpaceFigure& figure, const PictureSettings& settings);

}  // namespace downwash
