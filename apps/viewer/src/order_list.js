// The order of targets, in the plane and in space.

import {h} from "./dom.js";
import {quantity} from "./format.js";

/** In which order targets are visited, which are left out, and why; null where the order is given. */
export function order_list({solution}) {
    const {order} = solution;
    if (!order) {
        return null;
    }
    const visited = order.visits.map(
        ({target, alternative}) => alternative ? `${target} (alternative ${alternative})` : `${target}`);
    const legs = `${order.legs} flown legs`;
    const how = !solution.plan ? "no plan in that order was found" :
        order.is_best          ? `the cheapest by ${legs} and lower bounds of the others` :
                                 `the cheapest that was found by ${legs}`;
    const why = ({energy_j}) => Number.isFinite(energy_j) ?
        `with it the flight takes about ${quantity(energy_j, ",.0f", "J")}, more than it may` :
        "no flight to it was found";
    return h(
        "ul", {class: "goal-visits order"},
        h("li", null,
          visited.length > 0 ? `order of the targets: ${visited.join(", ")}; ${how}` : "no target is visited"),
        order.left_out.map((each) => h("li", null, `target ${each.target} is left out: ${why(each)}`)));
}
