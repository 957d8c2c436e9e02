#include "downwash/problems/any_problem.hpp"

#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

namespace downwash {

std::string problem_sha256(const AnyProblem& problem) {
    return std::visit([](const auto& of) { return problem_sha256(of); }, problem);
}

AnyProblem read_any_problem(const std::filesystem::path& file,
                            const std::function<void(const LocatedError&)>& on_outdated,
                            const std::function<void(const LocatedError&)>& on_warning,
                            const FurtherSpaceErrors& further_errors) {
    if (is_space_problem_file(file)) {
        return read_space_problem(file, {}, on_warning, further_errors);
    }
    return read_problem(file, {}, on_outdated, on_warning);
}

}  // namespace downwash
