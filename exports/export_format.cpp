#include "downwash/exports/export_format.hpp"

#include <array>

#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

constexpr bool yes = true, no = false;

constexpr std::array formats{
    ExportFormat{"csv", "setpoints.csv", "set-points of the plan in the world frame, a row each", yes, yes, no,
                 setpoint_csv},
    ExportFormat{"ros", "trajectory.json",
                 "the same as ROS messages: trajectory_msgs/MultiDOFJointTrajectory of the vehicle and "
                 "trajectory_msgs/JointTrajectory of the arm",
                 yes, yes, no, ros_trajectory},
    ExportFormat{"qgc", "mission.plan", "the vehicle's way as a mission for QGroundControl; without the arm", yes, no,
                 yes, qgc_plan},
    ExportFormat{"vtp", "flight.vtp",
                 "the flight as VTK polydata: the ways of vehicle and end effector with all columns", no, no, no,
                 vtk_flight},
    ExportFormat{"vtp-scene", "scene.vtp", "the obstacles as VTK polydata", no, no, no, vtk_scene},
    ExportFormat{"glb", "run.glb", "scene and flying vehicle as animated glTF", no, no, no, gltf_binary},
};

}  // namespace

std::span<const ExportFormat> export_formats() {
    return formats;
}

std::string exported(const RunRecord& run, const ExportFormat& format, const ExportSettings& settings) {
    return format.write(run, settings);
}

}  // namespace downwash
