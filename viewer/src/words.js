// The planner's names in plain words.

export const causes = {
    bounds: "leaves the bounds",
    collision: "touches an obstacle",
    direct_flight: "fails when flown with direct aerodynamics",
    flyable_area: "leaves the flyable area",
    goal_missed: "misses the goal",
    saturation: "asks more than a limit allows",
    too_long: "takes too long",
    tracking: "strays from its reference",
    unstable: "becomes unstable",
};

export const cause_text = (cause) => causes[cause] ?? String(cause).replace(/_/g, " ");

export const outcomes = {
    ok: "reaches the goal and holds there",
    collision: "ends in a collision",
    unstable: "becomes unstable",
    left_flyable_area: "leaves the flyable area",
    goal_missed: "misses the goal",
};

export const outcome_text = (outcome) => outcomes[outcome] ?? String(outcome).replace(/_/g, " ");

/** What the search reckoned with. */
export const knowledge = {
    "mp-arm": "geometry only",
    "mp-arm-da": "dynamics in free air, not aerodynamics",
    "mp-arm-ada": "dynamics and aerodynamics",
};

export const variants = {
    "mp-arm": "the tree knows geometry only",
    "mp-arm-da": "the tree flies, in free air",
    "mp-arm-ada": "the tree flies, near surfaces too",
};

/** Of the cost; sums of several have none. */
export const unit_of = (objective) => ({energy: "J", time: "s", length: "m", clearance: "s/m"}[objective] ?? "");
