#include "downwash/robot_import/robot_import.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/problems/designed_robot.hpp"
#include "downwash/robot_import/mjcf_reader.hpp"
#include "downwash/robot_import/robot_builder.hpp"
#include "downwash/robot_import/robot_text.hpp"
#include "downwash/robot_import/sdf_reader.hpp"
#include "downwash/robot_import/tree_graph.hpp"
#include "downwash/robot_import/urdf_reader.hpp"
#include "downwash/robot_import/xml_element.hpp"

namespace downwash {
namespace {

namespace fs = std::filesystem;
using namespace robot_import;

std::string text_of(const fs::path& file, Findings& findings) {
    constexpr std::uintmax_t largest = 64U << 20U;
    std::error_code error;
    if (fs::is_directory(file, error)) {
        findings.fail({}, "is a folder: expected a URDF, SDF or MJCF file");
    }
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        findings.fail({}, std::string("cannot be read: ") + std::strerror(errno));
    }
    if (const auto size = fs::file_size(file, error); !error && size > largest) {
        findings.fail({}, "has " + std::to_string(size) + " bytes: expected at most " + std::to_string(largest));
    }
    return {std::istreambuf_iterator<char>(in), {}};
}

KinematicTree read_tree(const fs::path& file, Findings& findings) {
    const std::string text = text_of(file, findings);
    const XmlElement root = parse_xml(text, findings);
    if (root.name == "robot") {
        return read_urdf(file, text, root, findings);
    }
    if (root.name == "sdf") {
        return read_sdf(file, findings);
    }
    if (root.name == "mujoco") {
        return read_mjcf(file, root, findings);
    }
    findings.fail(root.place, "has the root element <" + excerpt(root.name) +
                                  ">: expected <robot> (URDF), <sdf> (SDF) or <mujoco> (MJCF)");
}

/// The number in "arm.links[2].max_torque_nm"; -1 without one.
int link_number(const std::string& key) {
    constexpr std::string_view list = "arm.links[";
    if (!key.starts_with(list)) {
        return -1;
    }
    const std::string_view rest = std::string_view(key).substr(list.size());
    return parse_number<int>(rest.substr(0, rest.find(']'))).value_or(-1);
}

/// Where in the file what a key of the robot says comes from.
Place place_of(const std::string& key, const KinematicTree& tree, const BuiltRobot& built, int root) {
    if (const int i = link_number(key); i >= 0 && i < static_cast<int>(built.joint_names.size())) {
        return tree.joints[static_cast<std::size_t>(tree.joint(built.joint_names[static_cast<std::size_t>(i)]))].place;
    }
    if (key.starts_with("rotors") && !tree.rotors.empty()) {
        return tree.rotors.front().place;
    }
    return tree.links[static_cast<std::size_t>(root)].place;
}

std::string sentence_of(const KeyError& error, const BuiltRobot& built) {
    const int i = link_number(error.key);
    return (i >= 0 && i < static_cast<int>(built.joint_names.size())
                ? "joint '" + excerpt(built.joint_names[static_cast<std::size_t>(i)]) + "': "
                : "") +
           error.key + " of the robot that this makes " + error.message;
}

}  // namespace

ImportedRobot import_robot(const fs::path& file, const ImportSettings& settings) {
    Findings findings(file.string());
    const KinematicTree tree = read_tree(file, findings);
    findings.throw_if_any();
    const int root = require_tree(tree, findings);
    BuiltRobot built = built_robot(tree, root, settings, findings);
    const auto place = [&](const KeyError& error) { return place_of(error.key, tree, built, root); };
    for (const KeyError& error : space_robot_errors(built.robot)) {
        findings.error(place(error), sentence_of(error, built));
    }
    findings.throw_if_any();
    design_controller(built.robot, {});
    for (const KeyError& warning : space_robot_warnings(built.robot)) {
        findings.warn(place(warning), sentence_of(warning, built));
    }
    ImportedRobot imported;
    imported.yaml = robot_text(built, excerpt(file.filename().string()) + " (" + tree.format + ")");
    imported.robot = std::move(built.robot);
    imported.warnings = findings.warnings();
    return imported;
}

}  // namespace downwash
