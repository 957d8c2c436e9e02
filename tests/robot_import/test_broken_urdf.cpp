#include <algorithm>
#include <catch2/catch.hpp>

#include "../support/scratch_folder.hpp"
#include "downwash/robot_import/robot_import.hpp"
#include "text_edits.hpp"

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;

namespace {

/// One way to break the good file.
struct Broken {
    TextEdits edits;
    std::string at;       ///< a text on the line where the error is
    std::string message;  ///< what is wrong: the element by its name
    std::string remedy;
};

const std::string battery_mass = "<mass value=\"0.5\"/>";
const std::string battery_inertia =
    "<inertia ixx=\"0.0004\" ixy=\"0\" ixz=\"0\" iyy=\"0.0013\" iyz=\"0\" izz=\"0.0014\"/>";
const std::string battery_box = "<box size=\"0.16 0.06 0.05\"/>";
const std::string base_moments =
    "ixx=\"0.031\" ixy=\"0.0004\" ixz=\"-0.0002\" iyy=\"0.033\" iyz=\"0.0001\" izz=\"0.052\"";
const std::string shoulder = "<joint name=\"shoulder\" type=\"revolute\">";
const std::string elbow = "<joint name=\"elbow\" type=\"revolute\">";
const std::string shoulder_limit = "<limit lower=\"-1.6\" upper=\"1.6\" effort=\"3\" velocity=\"2\"/>";
const std::string elbow_limit = "<limit lower=\"-2\" upper=\"2\" effort=\"1.5\" velocity=\"3\"/>";
const std::string tool = "<link name=\"tool0\"/>";
const std::string first_constant = "<motorConstant>1.2e-5</motorConstant>";
const std::string first_place = "<origin xyz=\"0.24248711305964282 0.14 0.06\"/>";
const std::string plugin = "filename=\"librotors_gazebo_motor_model.so\"";

TextEdits replacing(const std::string& part, const std::string& by) {
    return {{part, by}};
}

const std::vector<Broken>& broken_files() {
    static const std::vector<Broken> all{
        // The file as such.
        {replacing("</robot>", ""), "", "not well-formed XML", "check the elements"},
        {replacing("<mass value=\"2.4\"/>", "<mass value=\"2.4\">"), "", "not well-formed XML", "check the elements"},
        {replacing(tool, "<xacro:macro name=\"m\"/>" + tool), "xacro:macro", "<xacro:macro>", "run `xacro"},
        {replacing(battery_mass, "<mass value=\"${m}\"/>"), "${m}", "value=\"${m}\" of <mass>", "run `xacro"},
        // Links and joints as a tree.
        {replacing(tool, "<link/>" + tool), "<link/>", "this link has no name", "expected name"},
        {replacing(tool, "<link name=\"gripper\"/>" + tool), "<link name=\"gripper\"/>", "two links named 'gripper'",
         "a name of its own"},
        {replacing(elbow, "<joint name=\"shoulder\" type=\"revolute\">"), "", "two joints named 'shoulder'",
         "a name of its own"},
        {replacing("<parent link=\"upper_link\"/>", "<parent link=\"upper\"/>"), "link=\"upper\"",
         "joint 'elbow' has the parent 'upper'", "expected the name of a <link>"},
        {replacing("<parent link=\"upper_link\"/>", ""), elbow, "joint 'elbow' has the parent ''",
         "expected the name of a <link>"},
        {replacing(tool,
                   "<joint name=\"loop\" type=\"fixed\"><parent link=\"gripper\"/><child "
                   "link=\"battery\"/></joint>" +
                       tool),
         "name=\"loop\"", "joint 'loop' closes a loop: link 'battery' hangs on joint 'battery_joint'", "leave out one"},
        {replacing(tool,
                   "<joint name=\"loop\" type=\"fixed\"><parent link=\"gripper\"/><child "
                   "link=\"base_link\"/></joint>" +
                       tool),
         "<link name=\"base_link\">", "link 'base_link' hangs on itself", "expected a tree"},
        {replacing(tool, "<link name=\"spare\"/>" + tool), "spare", "link 'spare' hangs on nothing", "one base"},
        // Masses.
        {replacing("<link name=\"battery\">\n    <inertial>\n      " + battery_mass + "\n      " + battery_inertia +
                       "\n    </inertial>",
                   "<link name=\"battery\">"),
         "<link name=\"battery\">", "link 'battery' has shapes and no inertial", "--massless battery"},
        {replacing(battery_mass, ""), "<inertial>", "link 'battery': <inertial> has no <mass>", "expected one"},
        {replacing(battery_inertia, ""), "<inertial>", "link 'battery': <inertial> has no <inertia>", "expected one"},
        {replacing("ixx=\"0.0004\" ixy=\"0\" ", "ixx=\"0.0004\" "), "izz=\"0.0014\"",
         "link 'battery': <inertia> has no ixy", "all six"},
        {replacing(battery_mass, "<mass value=\"0\"/>"), "<inertial>", "link 'battery' has a mass of 0 kg", "above 0"},
        {replacing(battery_mass, "<mass value=\"-0.5\"/>"), "<inertial>", "link 'battery' has a mass of -0.5 kg",
         "above 0"},
        {replacing(battery_mass, "<mass value=\"half\"/>"), "half", "value=\"half\" of <mass>", "a number"},
        {replacing(battery_mass, "<mass value=\"0,5\"/>"), "0,5", "value=\"0,5\" of <mass>", "decimal points"},
        {replacing("izz=\"0.0014\"", "izz=\"0.014\""), "<inertial>", "link 'battery' has the principal moments",
         "at most the sum"},
        {replacing("ixx=\"0.0004\"", "ixx=\"-0.0004\""), "<inertial>", "link 'battery' has the principal moments",
         "none below 0"},
        {replacing("ixy=\"0.0004\"", "ixy=\"0.4\""), "<inertial>", "link 'base_link' has the principal moments",
         "products of inertia are too large"},
        // Millimetres.
        {replacing(base_moments, "ixx=\"31000\" ixy=\"0\" ixz=\"0\" iyy=\"33000\" iyz=\"0\" izz=\"52000\""),
         "<inertial>", "link 'base_link' has the inertia of its mass at 147", "is this in mm?"},
        {replacing("xyz=\"0.03 0 -0.1\"", "xyz=\"30 0 -100\""), shoulder, "joint 'shoulder' stands 104.4 m",
         "is this in mm?"},
        {replacing(battery_box, "<box size=\"160 60 50\"/>"), "160 60 50", "link 'battery' has a shape",
         "is this in mm?"},
        {replacing("xyz=\"0.01 0 0.02\"", "xyz=\"10 0 20\""), "<inertial>", "link 'base_link' has its centre of mass",
         "is this in mm?"},
        {replacing(battery_box, "<mesh filename=\"millimetres.stl\"/>"), "millimetres", "link 'battery': the mesh",
         "scale=\"0.001"},
        // Shapes.
        {replacing(battery_box, "<mesh filename=\"package://models/battery.stl\"/>"), "battery.stl",
         "link 'battery': the mesh 'package://models/battery.stl' is not there", "--skip-meshes"},
        {replacing(battery_box, "<mesh filename=\"battery.dae\"/>"), "battery.dae", "link 'battery': the mesh",
         "expected .stl or .obj"},
        {replacing("<cylinder radius=\"0.15\"", "<cylinder radius=\"0\""), "radius=\"0\"",
         "link 'base_link' has a shape of no size", "above 0"},
        {replacing("xyz=\"0.03 0 -0.1\"", "xyz=\"0.03 0\""), "xyz=\"0.03 0\"", "xyz=\"0.03 0\" of <origin>",
         "3 numbers"},
        // Joints.
        {replacing(elbow, elbow + "<mimic joint=\"shoulder\"/>"), elbow, "joint 'elbow' mimics 'shoulder'",
         "--freeze elbow=DEG"},
        {replacing(shoulder, "<joint name=\"shoulder\" type=\"prismatic\">"), "\"shoulder\" type",
         "joint 'shoulder' is prismatic", "--freeze shoulder=M"},
        {replacing(elbow, "<joint name=\"elbow\" type=\"continuous\">"), "\"elbow\" type",
         "joint 'elbow' turns without end", "type=\"revolute\" with <limit>"},
        {replacing(elbow, "<joint name=\"elbow\" type=\"planar\">"), "\"elbow\" type", "joint 'elbow' is planar",
         "--freeze elbow=DEG"},
        {replacing(elbow, "<joint name=\"elbow\" type=\"floating\">"), "\"elbow\" type", "joint 'elbow' is floating",
         "--freeze elbow=DEG"},
        {replacing(elbow, "<joint name=\"elbow\" type=\"revolut\">"), "\"elbow\" type",
         "joint 'elbow' has the type 'revolut'", "did you mean 'revolute'?"},
        {replacing(elbow_limit, ""), elbow, "joint 'elbow' is revolute without <limit>", "expected <limit"},
        {replacing(elbow_limit, "<limit lower=\"-2\" upper=\"2\" velocity=\"3\"/>"), "lower=\"-2\"",
         "joint 'elbow': <limit> has no effort", "above 0"},
        {replacing(elbow_limit, "<limit lower=\"-2\" upper=\"2\" effort=\"0\" velocity=\"3\"/>"), elbow,
         "joint 'elbow' has no torque", "--freeze elbow=DEG"},
        {replacing(shoulder_limit, "<limit lower=\"1.6\" upper=\"-1.6\" effort=\"3\" velocity=\"2\"/>"), shoulder,
         "joint 'shoulder' has no range", "--freeze shoulder=DEG"},
        {replacing(shoulder_limit, "<limit lower=\"-90\" upper=\"90\" effort=\"3\" velocity=\"2\"/>"), shoulder,
         "joint 'shoulder' has limits of -90 and 90 rad", "Expected radians"},
        {replacing("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>"), shoulder,
         "joint 'shoulder' has an axis without direction", "other than 0 0 0"},
        {replacing("effort=\"3\"", "effort=\"0.1\""), shoulder, "joint 'shoulder': arm.links[0].max_torque_nm",
         "expected at least"},
        {replacing("<joint name=\"battery_joint\" type=\"fixed\">",
                   "<joint name=\"battery_joint\" type=\"revolute\"><limit lower=\"-1\" upper=\"1\" effort=\"1\" "
                   "velocity=\"1\"/>"),
         shoulder, "joint 'shoulder' begins a second arm beside that of joint 'battery_joint'", "--arm LINK"},
        // Rotors.
        {{{plugin, "filename=\"a.so\""},
          {plugin, "filename=\"a.so\""},
          {plugin, "filename=\"a.so\""},
          {plugin, "filename=\"a.so\""},
          {plugin, "filename=\"a.so\""},
          {plugin, "filename=\"a.so\""}},
         "",
         "nothing describes a rotor",
         "--rotors REGEX"},
        {replacing("<linkName>rotor_0</linkName>", "<linkName>propeller_0</linkName>"), "propeller_0",
         "<linkName> 'propeller_0'", "expected the name of a link"},
        {replacing("<turningDirection>ccw</turningDirection>", "<turningDirection>left</turningDirection>"), "left",
         "<turningDirection> is 'left'", "expected cw or ccw"},
        {replacing("<turningDirection>ccw</turningDirection>", ""), "name=\"motor_0\"",
         "rotor 'rotor_0' lacks how they turn", "--spin"},
        {replacing(first_constant, "<motorConstant>-1.2e-5</motorConstant>"), "-1.2e-5", "<motorConstant> is -1.2e-05",
         "above 0"},
        {replacing(first_constant, "<motorConstant>strong</motorConstant>"), "strong", "<motorConstant> is 'strong'",
         "expected a number"},
        {replacing("<maxRotVelocity>900</maxRotVelocity>", ""), "name=\"motor_0\"",
         "rotor 'rotor_0' lacks their greatest thrust", "--max-thrust-n N"},
        {replacing("<momentConstant>0.016</momentConstant>", ""), "name=\"motor_0\"",
         "rotor 'rotor_0' lacks a ratio of drag torque to thrust", "--torque-ratio-m M"},
        {replacing("<timeConstantUp>0.0125</timeConstantUp><timeConstantDown>0.025</timeConstantDown>", ""),
         "name=\"motor_0\"", "rotor 'rotor_0' lacks the lag of thrust", "--rotor-lag-s S"},
        {replacing("<collision><geometry><cylinder radius=\"0.127\" length=\"0.01\"/></geometry></collision>", ""),
         "name=\"motor_0\"", "rotor 'rotor_0' lacks a radius", "--rotor-radius-m M"},
        {replacing(first_place, "<origin xyz=\"0.24248711305964282 0.14 0.06\" rpy=\"3.14159265 0 0\"/>"),
         "name=\"motor_0\"", "rotor 'rotor_0' pushes downwards", "are the axes mirrored"},
        {replacing(first_place + "<parent link=\"base_link\"/>", first_place + "<parent link=\"upper_link\"/>"),
         "name=\"motor_0\"", "rotor 'rotor_0' is on the arm", "fixed to the multirotor"},
        {{{"<maxRotVelocity>900", "<maxRotVelocity>300"},
          {"<maxRotVelocity>900", "<maxRotVelocity>300"},
          {"<maxRotVelocity>900", "<maxRotVelocity>300"},
          {"<maxRotVelocity>900", "<maxRotVelocity>300"},
          {"<maxRotVelocity>900", "<maxRotVelocity>300"},
          {"<maxRotVelocity>900", "<maxRotVelocity>300"}},
         "name=\"motor_0\"",
         "rotors.max_thrust_n of the robot that this makes lifts",
         "cannot carry the weight"},
    };
    return all;
}

/// The line of a text, counted from 1.
int line_of(const std::string& text, std::size_t at) {
    return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

}  // namespace

TEST_CASE("each of forty and more broken URDFs gets a message with its element, its line and a remedy") {
    const ScratchFolder folder;
    write_text(folder / "battery.dae", "<COLLADA/>");
    write_text(folder / "millimetres.stl",
               "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 160 0 0\nvertex 0 60 "
               "50\nendloop\nendfacet\nendsolid s\n");
    const std::string good = text_of(DOWNWASH_MODELS "/hexa_arm2.urdf");
    CHECK(broken_files().size() >= 40);
    for (const Broken& broken : broken_files()) {
        CAPTURE(broken.message);
        const std::string text = edited(good, broken.edits);
        const std::filesystem::path file = folder / "robot.urdf";
        write_text(file, text);
        std::vector<LocatedError> errors;
        try {
            static_cast<void>(import_robot(file));
        } catch (const ProblemFileError& error) {
            errors = error.errors();
        }
        REQUIRE(!errors.empty());
        std::string all;
        bool is_named = false, is_placed = broken.at.empty();
        for (const LocatedError& error : errors) {
            all += to_text(error) + "\n";
            if (error.message.find(broken.message) == std::string::npos) {
                continue;
            }
            is_named = true;
            CHECK(error.file == file.string());
            CHECK_THAT(error.message, Contains(broken.remedy));
            // The line holds the text that is meant; of elements that several links have, one of those lines.
            for (std::size_t at = text.find(broken.at); at != std::string::npos; at = text.find(broken.at, at + 1)) {
                is_placed = is_placed || line_of(text, at) == error.line;
            }
        }
        INFO(all);
        CHECK(is_named);
        CHECK(is_placed);
    }
}

TEST_CASE("what is no robot at all is rejected with what was expected") {
    const ScratchFolder folder;
    const auto errors_of = [&](const std::string& text) {
        write_text(folder / "robot.urdf", text);
        try {
            static_cast<void>(import_robot(folder / "robot.urdf"));
        } catch (const ProblemFileError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK_THAT(errors_of(""), Contains("not well-formed XML"));
    CHECK_THAT(errors_of("schema: downwash/robot/v1\n"), Contains("not well-formed XML"));
    CHECK_THAT(errors_of("<html/>"), Contains("robot.urdf:1:1: has the root element <html>"));
    CHECK_THAT(errors_of("<robot name=\"r\"/>"), Contains("has no links"));
    std::string deep;
    for (int i = 0; i < 2000; ++i) {
        deep += "<a>";
    }
    for (int i = 0; i < 2000; ++i) {
        deep += "</a>";
    }
    CHECK_THAT(errors_of(deep), Contains("nested more than 100 elements deep"));
    CHECK_THROWS_WITH(import_robot(folder.path()), Contains("is a folder"));
    CHECK_THROWS_WITH(import_robot(folder / "missing.urdf"), Contains("cannot be read"));
}

TEST_CASE("options that name nothing in the file say what there is") {
    const std::filesystem::path model = DOWNWASH_MODELS "/hexa_arm2.urdf";
    ImportSettings settings;
    settings.frozen = {{"wrist", 0}};
    CHECK_THROWS_WITH(import_robot(model, settings),
                      Contains("--freeze wrist: there is no such joint") && Contains("shoulder, elbow"));
    settings = {};
    settings.frozen = {{"elbow", 150}};
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("joint 'elbow' is frozen beyond its limits"));
    settings = {};
    settings.arm_end = "hand";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("--arm hand: there is no such link"));
    settings = {};
    settings.tool = "battery";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("--tool battery: this link does not turn with the last"));
    settings = {};
    settings.massless = {"cable"};
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("--massless cable: there is no such link"));
    settings = {};
    settings.rotors = "propeller.*";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("matches no link and no joint of base_link, battery"));
    settings.rotors = "(";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("is no regular expression"));
    settings = {};
    settings.up = "w";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("--up w: expected an axis"));
    settings.up = "-x";
    CHECK_THROWS_WITH(import_robot(model, settings), Contains("are one axis: expected two"));
}
