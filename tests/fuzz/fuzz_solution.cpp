#include <cstddef>
#include <cstdint>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/solution_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const downwash::Problem problem = downwash::read_problem(DOWNWASH_PROBLEMS "/open_air.yaml");
    static const downwash::test::ScratchFolder folder;
    downwash::write_file(folder / "solution.json", {reinterpret_cast<const char*>(data), size});
    try {
        static_cast<void>(downwash::read_solution((folder / "solution.json").string(), problem));
    } catch (const downwash::ProblemFileError&) {
    }
    return 0;
}
