#pragma once

#include "downwash/robot_import/kinematic_tree.hpp"
#include "downwash/robot_import/xml_element.hpp"

namespace downwash::robot_import {

/// Adds the rotors that plug-ins of Gazebo describe to a tree:
/// - the motor models of RotorS and PX4 (gazebo_motor_model) and of gz-sim (MulticopterMotorModel): thrust is
///   motorConstant * speed^2 along the link's z, drag torque momentConstant * thrust;
/// - ArduPilot's plug-in, whose controls give joints and speeds, with one LiftDrag plug-in for each blade.
/// @param root of the file, whose <plugin> elements count at any depth
void add_motor_plugins(KinematicTree& tree, const XmlElement& root, Findings& findings);

}  // namespace downwash::robot_import
