// The program downwash-robot: the commands of `robot` that need readers of other formats.

#include "downwash/cli/program.hpp"
#include "downwash/cli/robot_commands.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("robot", argc, argv, [](Command program, Action& action) {
        Command robot = add_robot_group(program);
        add_robot_import(robot, action, import_robot_file);
        add_robot_show(robot, action, show_any_robot);
    });
}
