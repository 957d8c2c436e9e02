#include "downwash/exports/export_format.hpp"

#include <array>

#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

constexpr std::array formats{
    ExportFormat{"csv", ".csv", "set-points of the plan in the world frame, a row each", setpoint_csv},
    ExportFormat{"ros", ".json",
                 "the same as ROS messages: trajectory_msgs/MultiDOFJointTrajectory of the vehicle and "
                 "trajectory_msgs/JointTrajectory of the arm",
                 ros_trajectory},
    ExportFormat{"qgc", ".plan", "the vehicle's way as a mission for QGroundControl; without the arm", qgc_plan},
    ExportFormat{"vtp", ".vtp", "the flight as VTK polydata: the ways of vehicle and end effector with all columns",
                 vtk_flight},
    ExportFormat{"vtp-scene", ".vtp", "the obstacles as VTK polydata", vtk_scene},
    ExportFormat{"glb", ".glb", "scene and flying vehicle as animated glTF", gltf_binary},
};

}  // namespace

std::span<const ExportFormat> export_formats() {
    return formats;
}

std::string exported(const RunRecord& run, const ExportFormat& format, const ExportSettings& settings) {
    return format.write(run, settings);
}

}  // namespace downwash
