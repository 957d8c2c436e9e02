#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "downwash/base/checks.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash {

/// A problem under check, with what several checks need of it: made when first asked for, then kept.
class ProblemCheck {
 public:
    explicit ProblemCheck(const Problem& problem) : problem_(problem) {}

    [[nodiscard]] const Problem& problem() const noexcept { return problem_; }
    /// So that checks of the values alone take a Problem.
    // NOLINTNEXTLINE(google-explicit-constructor): as said
    operator const Problem&() const noexcept { return problem_; }

    /// @throws InputError when an obstacle cannot be placed
    [[nodiscard]] const std::shared_ptr<const Scene>& scene() const {
        if (scene_ == nullptr) {
            scene_ = std::make_shared<const Scene>(problem_.obstacles);
        }
        return scene_;
    }
    /// @throws InputError as scene()
    [[nodiscard]] const CollisionChecker& collisions() const {
        if (!collisions_) {
            collisions_.emplace(scene(), problem_.plane, problem_.robot.shape(), problem_.planner.collision_checker);
        }
        return *collisions_;
    }

 private:
    const Problem& problem_;
    mutable std::shared_ptr<const Scene> scene_;
    mutable std::optional<CollisionChecker> collisions_;
};

/// See further_problem_errors().
[[nodiscard]] std::vector<KeyError> further_errors(const ProblemCheck& check, WrongKeys wrong);

/// problem_warnings() of a problem that was checked and found sound.
[[nodiscard]] std::vector<KeyError> warnings_of(const ProblemCheck& check);

/// Those of problem_warnings() that tell of the files that a problem names, as far as what they need has no error.
[[nodiscard]] std::vector<KeyError> file_warnings_of(const ProblemCheck& check, const WrongKeys& wrong);

/// The flight model of a problem that was checked and found sound, in the scene of that check.
[[nodiscard]] std::shared_ptr<const FlightModel> model_of(const ProblemCheck& check);

}  // namespace downwash
