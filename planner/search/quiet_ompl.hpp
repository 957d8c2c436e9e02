#pragma once

namespace downwash::planning {

/// Keeps OMPL's console silent while one of these lives, and puts back what was there before; safe across threads.
class QuietOmpl {
 public:
    QuietOmpl();
    ~QuietOmpl();
    QuietOmpl(const QuietOmpl&) = delete;
    QuietOmpl& operator=(const QuietOmpl&) = delete;
};

}  // namespace downwash::planning
