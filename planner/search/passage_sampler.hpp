#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "downwash/search/random.hpp"
#include "downwash/search/search_task.hpp"

namespace downwash::planning {

/// A way through a narrow passage: from rest at one place to rest at another, through a point at speed.
struct Passage {
    ReferencePoint run_up;   ///< reference at rest
    ReferencePoint through;  ///< moving and, where the thrust has a limit, accelerated: the vehicle is tilted there
    ReferencePoint run_out;  ///< reference at rest
};

/// A passage flown backwards: with the same accelerations, so within the same limits.
[[nodiscard]] Passage reversed(const Passage& passage);

/// Draws ways through narrow passages, which nothing that stops and nothing level comes through. Passages are found by
/// the bridge test (Hsu, Jiang, Reif and Sun 2003): the vehicle, as tilted as its acceleration there takes, collides on
/// both sides of a point, and not at it. Ways beside those that were found are drawn, too.
class PassageSampler {
 public:
    /// @param task must outlive it
    explicit PassageSampler(const SearchTask& task);

    /// A way whose reference is within bounds and limits of motion and free of collision, between places on both sides
    /// of a passage that no motion from rest to rest connects; nothing after some tries.
    /// @param is_wanted whether a way is worth knowing
    [[nodiscard]] std::optional<Passage> sample(Random& random, const std::function<bool(const Passage&)>& is_wanted);

 private:
    /// A place between two sides that a vehicle with this pitch collides with.
    struct Bridge {
        Configuration middle;
        double across_rad;  ///< direction from one side to the other
        double pitch_rad;
    };

    /// A point at speed in a passage.
    struct Through {
        ReferencePoint point;
        double along[max_axes];  ///< direction along the passage, over the translations; of unit length
    };
    struct FoundPassage {
        Through through;
        Passage passage;
    };

    [[nodiscard]] double tilt(const ReferencePoint& point) const;
    [[nodiscard]] bool collides(const Configuration& at, double pitch_rad) const;
    [[nodiscard]] std::optional<Bridge> found(Random& random) const;
    /// A point there, with some speed along the passage and some force.
    [[nodiscard]] Through through(const Bridge& bridge, Random& random) const;
    /// A point beside that of a way that was found.
    [[nodiscard]] Through beside_known(Random& random) const;
    [[nodiscard]] std::optional<FoundPassage> passage_beside_known(Random& random) const;
    [[nodiscard]] std::optional<FoundPassage> passage_over_bridge(Random& random);
    [[nodiscard]] std::optional<FoundPassage> passage_through(const Through& through) const;
    /// The place from or to which a reference leads that is at rest there and at a point after or before it. It lies
    /// behind or ahead of the point along the passage: a way that turns back does not lead through.
    /// @param side -1: before the point, 1: after it
    [[nodiscard]] std::optional<ReferencePoint> rest_beside(const Through& through, double side) const;
    /// Whether the fastest reference between two points is within the limits and free of collision.
    [[nodiscard]] bool leads(const ReferencePoint& from, const ReferencePoint& to) const;
    [[nodiscard]] bool is_free(const ReferenceSegment& segment) const;

    const SearchSpace& space_;
    MotionLimits limits_;
    double tick_s_;
    double bridge_m_;  ///< longest distance between the two sides
    std::vector<Bridge> bridges_;
    std::vector<Through> known_;  ///< points of passages that were found
};

}  // namespace downwash::planning
