// Plain words for the names of the planner.

export const causes = {
    arm_limits: "moves the arm beyond its limits",
    bounds: "leaves the bounds",
    closed_plane: "finds no way in this plane",
    certificate: "fails too often in worlds that the search has not seen",
    collision: "touches an obstacle",
    direct_flight: "fails when executed with direct aerodynamics",
    flyable_area: "leaves the flyable area",
    goal_missed: "misses the goal",
    over_budget: "takes more energy than it may",
    saturation: "exceeds a limit of the actuators",
    too_long: "takes too long",
    tracking: "does not follow its reference",
    unfinished_certificate: "was not flown in enough worlds in time",
    unfinished_flight: "was not executed in time",
    unstable: "becomes unstable",
};

export const cause_text = (cause) => causes[cause] ?? String(cause).replace(/_/g, " ");

export const outcomes = {
    ok: "reaches the goal and hovers there",
    collision: "ends in a collision",
    unstable: "becomes unstable",
    left_flyable_area: "leaves the flyable area",
    goal_missed: "misses the goal",
    over_budget: "takes more energy than it may",
};

/** The name of an outcome as words: "goal missed". */
export const outcome_name = (outcome) => String(outcome).replace(/_/g, " ");

/** What a flight with that outcome does. */
export const outcome_text = (outcome) => outcomes[outcome] ?? outcome_name(outcome);

/** What the search considers. */
export const knowledge = {
    "mp-arm": "geometry only",
    "mp-arm-da": "dynamics in free air, not aerodynamics",
    "mp-arm-ada": "dynamics and aerodynamics",
};

export const variants = {
    "mp-arm": "motion planner for aerial robotic manipulators, geometry only",
    "mp-arm-da": "motion planner for aerial robotic manipulators, dynamics-aware: flights in free air",
    "mp-arm-ada": "motion planner for aerial robotic manipulators, aerodynamics-aware: flights near surfaces",
};

/** What a goal is called: "goal", "goal 2" or, where the planner chose the order, "target 3". */
export const goal_name = ({goals}, index) =>
    goals[index]?.name ?? (goals.length > 1 ? `goal ${index + 1}` : "goal");

/** The same by the number from 1 that the search gives it: it counts in the order in which it visits targets. */
export function numbered_goal_name(model, number) {
    const {order} = model.solution;
    if (!order) {
        return goal_name(model, number - 1);
    }
    const visit = order.visits[number - 1];
    return visit ? `target ${visit.target}` : "the place to return to";
}
