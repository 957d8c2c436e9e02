#include <cstddef>
#include <cstdint>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/claims.hpp"
#include "downwash/results/solution_file.hpp"
#include "downwash/results/space_solution_file.hpp"

namespace {

/// Reads a file as execute and as validate do.
template <class Problem>
void read(const std::string& file, const Problem& problem) {
    try {
        static_cast<void>(downwash::read_solution(file, problem));
    } catch (const downwash::ProblemFileError&) {
    }
    try {
        static_cast<void>(downwash::read_claims(file, problem));
    } catch (const downwash::ProblemFileError&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const downwash::Problem plane = downwash::read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    static const downwash::SpaceProblem space =
        downwash::read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    static const downwash::test::ScratchFolder folder;
    const std::string file = (folder / "solution.json").string();
    downwash::write_file(file, {reinterpret_cast<const char*>(data), size});
    read(file, plane);
    read(file, space);
    return 0;
}
