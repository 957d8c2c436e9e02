#include "downwash/python/core.hpp"

#include <algorithm>
#include <thread>

#include "downwash/base/version.hpp"

namespace downwash::python {

int thread_count(int asked) {
    return asked > 0 ? asked : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

}  // namespace downwash::python

// NOLINTNEXTLINE: what the macro makes is not ours
PYBIND11_MODULE(_core, module) {
    using namespace downwash::python;
    module.doc() = "The library of Downwash as the package calls it. Not for users: import downwash instead.";
    module.attr("version") = std::string(downwash::version());
    bind_errors(module);
    bind_problem(module);
    bind_solution(module);
    bind_solve(module);
    bind_space(module);
    bind_planner(module);
    bind_aeromap(module);
    bind_hold(module);
#ifdef DOWNWASH_WITH_JUDGE
    bind_validate(module);
#endif
#ifdef DOWNWASH_WITH_REPORT
    bind_figures(module);
#endif
}
