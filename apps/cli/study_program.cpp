// The program downwash-study.

#include "downwash/cli/program.hpp"
#include "downwash/cli/study_commands.hpp"

int main(int argc, char** argv) {
    using namespace downwash::cli;
    return run_part("study", argc, argv, [](Command program, Action& action) {
        add_study(program, action, {study_uncertainty, study_awareness, study_thesis});
    });
}
